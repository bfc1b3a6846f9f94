// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/ticks_csv.h"

#include <algorithm>
#include <string_view>

namespace phalanx {
namespace {

void write_joints(OutputFile& out, const JointArray& values) {
  for (const double value : values) {
    out.text(",");
    out.number(value);
  }
}

void write_vector(OutputFile& out, const Vec3& v) {
  for (int i = 0; i < 3; ++i) {
    out.text(",");
    out.number(v[i]);
  }
}

}  // namespace

std::string segment_column(int segment) {
  std::string name(segment_name(segment));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

std::string ticks_csv_header() {
  std::string header = "tick,time_s";
  for (const std::string_view unit : {"_hcp_rad", "_gdp_rad", "_torque_nm"}) {
    for (int joint = 0; joint < kJoints; ++joint) header.append(",").append(joint_name(joint)).append(unit);
  }
  for (int segment = 0; segment < kSegments; ++segment) {
    for (const std::string_view field :
         {"_contact", "_depth_m", "_force_raw_n", "_force_n", "_px_m", "_py_m", "_pz_m", "_nx", "_ny", "_nz",
          "_slid_m", "_force_tx_n", "_force_ty_n", "_force_tz_n", "_slip", "_slip_mm_per_s", "_spin_nm"}) {
      header.append(",").append(segment_column(segment)).append(field);
    }
  }
  return header;
}

TicksCsv::TicksCsv(const std::filesystem::path& file) : out_(file) {
  out_.text(ticks_csv_header());
  out_.text("\n");
}

void TicksCsv::write(const Snapshot& snapshot) {
  out_.integer(snapshot.tick);
  out_.text(",");
  out_.number(snapshot.time_s);
  write_joints(out_, snapshot.hcp_angle);
  write_joints(out_, snapshot.gdp_angle);
  write_joints(out_, snapshot.torque);
  for (const SegmentSnapshot& segment : snapshot.segment) {
    out_.text(segment.contact ? ",1," : ",0,");
    out_.number(segment.depth);
    out_.text(",");
    out_.number(segment.force_raw);
    out_.text(",");
    out_.number(segment.force);
    write_vector(out_, segment.point);
    write_vector(out_, segment.normal);
    out_.text(",");
    out_.number(segment.slid);
    write_vector(out_, segment.friction);
    out_.text(segment.slips ? ",1," : ",0,");
    out_.number(1e3 * segment.slip_speed);
    out_.text(",");
    out_.number(segment.spin);
  }
  out_.text("\n");
}

}  // namespace phalanx
