// SPDX-License-Identifier: Apache-2.0
#include "c_api/samples.h"

#include <algorithm>
#include <limits>

#include "c_api/poses.h"
#include "phalanx/core/index.h"
#include "phalanx/hand/pad.h"

namespace phalanx::c_api {
namespace {

static_assert(kSmallestSample == 176 && kSmallestSnapshot == 184, "phalanx.h states these sizes");

void fill_segment(const SegmentSnapshot& from, phalanx_segment& into) noexcept {
  into.contact = from.contact ? 1 : 0;
  into.slips = from.slips ? 1 : 0;
  into.oscillating = from.oscillating ? 1 : 0;
  into.reserved = 0;
  into.depth = from.depth;
  into.force_raw = from.force_raw;
  into.force = from.force;
  copy_vector(from.point, into.point);
  copy_vector(from.normal, into.normal);
  into.slid = from.slid;
  copy_vector(from.friction, into.friction);
  into.spin = from.spin;
  into.slip_speed = from.slip_speed;
  into.oscillation_frequency = from.oscillation_frequency;
  into.oscillation_swing = from.oscillation_swing;
}

void fill_wall(const LocalWall& from, phalanx_wall& into) noexcept {
  into.active = from.active ? 1 : 0;
  into.reserved = 0;
  std::copy(from.g.begin(), from.g.end(), into.g);
  into.d_ref = from.d_ref;
  into.stiffness = from.stiffness;
  into.force_max = from.force_max;
  into.host_force = from.host_force;
}

}  // namespace

phalanx_sample empty_sample() noexcept {
  phalanx_sample sample{};
  std::fill(std::begin(sample.measured_torque), std::end(sample.measured_torque),
            std::numeric_limits<double>::quiet_NaN());
  std::fill(std::begin(sample.measured_force), std::end(sample.measured_force),
            std::numeric_limits<double>::quiet_NaN());
  return sample;
}

void take_sample(const phalanx_sample& from, Sample& into) noexcept {
  into = Sample{};
  into.time_s = from.time_s;
  std::copy(std::begin(from.angle), std::end(from.angle), into.angle.begin());
  if (from.has_channels == 0) return;
  std::copy(std::begin(from.measured_torque), std::end(from.measured_torque), into.measured_torque.begin());
  std::copy(std::begin(from.measured_force), std::end(from.measured_force), into.measured_force.begin());
  for (std::size_t j = 0; j < into.angle_origin.size(); ++j)
    if (from.angle_origin[j] <= PHALANX_ORIGIN_SCRIPTED)
      into.angle_origin[j] = static_cast<AngleOrigin>(from.angle_origin[j]);
}

void fill_snapshot(const HapticModel& model, const Snapshot& from, double stiffness,
                   phalanx_snapshot& into) noexcept {
  into = phalanx_snapshot{};
  into.status = static_cast<std::uint32_t>(from.status);
  into.tick = from.tick;
  into.time_s = from.time_s;
  std::copy(from.torque.begin(), from.torque.end(), into.torque);
  std::copy(from.hcp_angle.begin(), from.hcp_angle.end(), into.hcp_angle);
  std::copy(from.gdp_angle.begin(), from.gdp_angle.end(), into.gdp_angle);
  for (int digit = 0; digit < kDigits; ++digit) {
    Vec3 force = Vec3::Zero();
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const SegmentSnapshot& segment = from.segment[idx(segment_index(digit, k))];
      force += segment.force * segment.normal + segment.friction;
    }
    copy_vector(force, into.digit_force[digit]);
    const Pose& tip = from.gdp_pose[idx(segment_index(digit, kSegmentsPerDigit - 1))];
    copy_vector(pad_in_world(model.hand.parameters(), digit, tip), into.fingertip[digit]);
    const DigitOpening& opening = from.opening[idx(digit)];
    into.opening[digit] = {.phase = static_cast<std::uint32_t>(opening.phase),
                           .reserved = 0,
                           .way = opening.way,
                           .force = opening.force};
  }
  for (std::size_t s = 0; s < kSegments; ++s) {
    fill_segment(from.segment[s], into.segment[s]);
    into.hcp_pose[s] = pose_to(from.hcp_pose[s]);
    into.gdp_pose[s] = pose_to(from.gdp_pose[s]);
    fill_wall(from.wall[s], into.wall[s]);
  }
  std::copy(from.measured_torque.begin(), from.measured_torque.end(), into.measured_torque);
  std::copy(from.measured_force.begin(), from.measured_force.end(), into.measured_force);
  for (std::size_t j = 0; j < from.angle_origin.size(); ++j)
    into.angle_origin[j] = static_cast<std::uint8_t>(from.angle_origin[j]);
  into.stiffness = stiffness;
  into.stiffness_factor = from.stiffness_factor;
  into.wall_valid_for = from.wall_valid_for;
  into.contact_points = static_cast<std::uint64_t>(from.contact_points.count);
}

}  // namespace phalanx::c_api
