// SPDX-License-Identifier: Apache-2.0
// What one step says about itself. A plain value: copying it is all that a recorder, a cockpit or a study
// needs.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "phalanx/core/math.h"
#include "phalanx/core/status.h"
#include "phalanx/force/local_wall.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// The value of a channel that the device does not have: NaN, everywhere.
template <class Array>
[[nodiscard]] constexpr Array not_measured() noexcept {
  Array values{};
  for (double& value : values) value = std::numeric_limits<double>::quiet_NaN();
  return values;
}

/// One number per digit, in the order of digit_name().
using DigitArray = std::array<double, kDigits>;

/// What the device measured at one tick.
struct Sample {
  double time_s = 0.0;  ///< strictly increasing [s]
  JointArray angle{};   ///< measured joint angles [rad]
  /// Optional channels (S1 fig. 2), NaN where the device has no sensor. They are passed on to the snapshot
  /// and change no command.
  JointArray measured_torque = not_measured<JointArray>();  ///< at the joints [Nm]
  DigitArray measured_force = not_measured<DigitArray>();   ///< magnitude at each digit's tip [N]
};

/// One segment's contact at one tick; world frame W, SI.
struct SegmentSnapshot {
  bool contact = false;    ///< the segment has a contact record
  double depth = 0.0;      ///< d = (p_gdp - p_hcp) . n_c - d0, not below 0 [m]        S1 eq. (2)
  double force_raw = 0.0;  ///< magnitude that the force law gives [N]
  double force = 0.0;      ///< magnitude sent, after caps and stabiliser [N]
  Vec3 point =
      Vec3::Zero();  ///< contact point on the GDP segment, p_WC [m]; the last one while a force decays
  Vec3 normal = Vec3::Zero();  ///< direction of the force on the finger, n_W [-]; zero if there is neither
                               ///< contact nor force
  double slid =
      0.0;  ///< tangential offset between the contact's material point on the HCP and on the GDP [m]
  bool oscillating = false;            ///< `force` oscillates: OscillationObserver
  double oscillation_frequency = 0.0;  ///< [Hz]; 0 while it does not
  double oscillation_swing = 0.0;      ///< the last full swing, from peak to peak [N]; 0 while it does not
};

struct Snapshot {
  std::uint64_t tick = 0;
  double time_s = 0.0;
  Status status = Status::kOk;
  JointArray hcp_angle{};  ///< [rad]; also the q_ref of the walls
  std::array<bool, kDigits>
      started_inside{};    ///< Status::kStartInside: the digits that give no force until clear
  JointArray gdp_angle{};  ///< [rad]
  JointArray torque{};     ///< commanded: what the contacts do to the finger's joints, axis . (r x f) [Nm]
  std::array<SegmentSnapshot, kSegments> segment{};
  std::array<Pose, kSegments> hcp_pose{};                   ///< X_WS
  std::array<Pose, kSegments> gdp_pose{};                   ///< X_WS
  JointArray measured_torque = not_measured<JointArray>();  ///< the sample's; NaN: not measured [Nm]
  DigitArray measured_force = not_measured<DigitArray>();   ///< the sample's; NaN: not measured [N]
  double stiffness_factor = 1.0;            ///< on the law's force, below 1 after OscillationReaction::kHalve
  std::array<LocalWall, kSegments> wall{};  ///< Stabiliser::kLocalWall: for the controller; else not active
  double wall_valid_for = 0.0;              ///< how long it may use them, from time_s [s]; 0: there are none
};

}  // namespace phalanx
