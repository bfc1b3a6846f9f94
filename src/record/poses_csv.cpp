// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/poses_csv.h"

#include <array>
#include <string_view>

namespace phalanx {
namespace {

void write_hand(OutputFile& out, std::uint64_t tick, std::string_view hand,
                const std::array<Pose, kSegments>& poses) {
  for (int segment = 0; segment < kSegments; ++segment) {
    const Pose& X_WS = poses[static_cast<std::size_t>(segment)];
    Eigen::Quaterniond q(X_WS.R);
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    out.integer(tick);
    out.text(",");
    out.text(segment_name(segment));
    out.text(",");
    out.text(hand);
    for (const double value : {X_WS.p.x(), X_WS.p.y(), X_WS.p.z(), q.w(), q.x(), q.y(), q.z()}) {
      out.text(",");
      out.number(value);
    }
    out.text("\n");
  }
}

}  // namespace

PosesCsv::PosesCsv(const std::filesystem::path& file) : out_(file) {
  out_.text("tick,segment,hand,px,py,pz,qw,qx,qy,qz\n");
}

void PosesCsv::write(const Snapshot& snapshot) {
  write_hand(out_, snapshot.tick, "hcp", snapshot.hcp_pose);
  write_hand(out_, snapshot.tick, "gdp", snapshot.gdp_pose);
}

}  // namespace phalanx
