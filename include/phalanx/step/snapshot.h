// SPDX-License-Identifier: Apache-2.0
// What one step says about itself. A plain value: copying it is all that a recorder, a cockpit or a study
// needs.
#pragma once

#include <array>
#include <cstdint>

#include "phalanx/core/math.h"
#include "phalanx/core/status.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// What the device measured at one tick.
struct Sample {
  double time_s = 0.0;  ///< strictly increasing [s]
  JointArray angle{};   ///< measured joint angles [rad]
};

/// One segment's contact at one tick; world frame W, SI.
struct SegmentSnapshot {
  bool contact = false;    ///< the segment has a contact record
  double depth = 0.0;      ///< d = (p_gdp - p_hcp) . n_c - d0, not below 0 [m]        S1 eq. (2)
  double force_raw = 0.0;  ///< magnitude that the force law gives [N]
  double force = 0.0;      ///< magnitude sent, after cap and smoothing [N]
  Vec3 point =
      Vec3::Zero();  ///< contact point on the GDP segment, p_WC [m]; the last one while a force decays
  Vec3 normal = Vec3::Zero();  ///< direction of the force on the finger, n_W [-]; zero if there is neither
                               ///< contact nor force
  double slid =
      0.0;  ///< tangential offset between the contact's material point on the HCP and on the GDP [m]
};

struct Snapshot {
  std::uint64_t tick = 0;
  double time_s = 0.0;
  Status status = Status::kOk;
  JointArray hcp_angle{};  ///< [rad]
  JointArray gdp_angle{};  ///< [rad]
  JointArray torque{};     ///< commanded: what the contacts do to the finger's joints, axis . (r x f) [Nm]
  std::array<SegmentSnapshot, kSegments> segment{};
  std::array<Pose, kSegments> hcp_pose{};  ///< X_WS
  std::array<Pose, kSegments> gdp_pose{};  ///< X_WS
};

}  // namespace phalanx
