// SPDX-License-Identifier: Apache-2.0
// Input and result of one step as plain values. A recorder, a cockpit or a study needs only a copy. S1 is a
// paper, listed in docs/architecture.md.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "phalanx/core/math.h"
#include "phalanx/core/status.h"
#include "phalanx/force/local_wall.h"
#include "phalanx/force/opening.h"
#include "phalanx/hand/angle_origin.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// Returns the value of a channel that the device does not have: all NaN.
template <class Array>
[[nodiscard]] constexpr Array not_measured() noexcept {
  Array values{};
  for (double& value : values) value = std::numeric_limits<double>::quiet_NaN();
  return values;
}

/// Values of all digits, in the order of digit_name().
using DigitArray = std::array<double, kDigits>;

/// Measurement of the device at one tick.
struct Sample {
  double time_s = 0.0;  ///< strictly increasing [s]
  JointArray angle{};   ///< joint angles [rad]
  /// Optional channels (S1 fig. 2), NaN where the device has no sensor. They are copied to the snapshot and
  /// do not affect the command.
  JointArray measured_torque = not_measured<JointArray>();  ///< at the joints [Nm]
  DigitArray measured_force = not_measured<DigitArray>();   ///< magnitude at each digit's tip [N]
  AngleOrigins angle_origin{};  ///< of `angle`. It is copied to the snapshot and does not affect the command.
};

/// Contact point that presses in sliding mode, with its share of the segment's force; world frame W, SI. The
/// shares `force` * normal + friction of a segment's points add up to the force sent to it. Where points oppose
/// each other, and their resultant is less than a tenth of the sum of their sizes, the shares are those for a
/// tenth. With the stabiliser `direction` the force sent may have another direction.
struct ContactPoint {
  int segment = 0;
  Vec3 point = Vec3::Zero();     ///< on the GDP segment [m]
  Vec3 normal = Vec3::Zero();    ///< unit vector from the object to the segment at closest approach
  double force = 0.0;            ///< along the normal, on the finger [N]
  Vec3 friction = Vec3::Zero();  ///< along the surface, on the finger [N]
  double spin = 0.0;             ///< friction's moment about the normal, on the finger [Nm]
  double coefficient = 0.0;      ///< of Coulomb friction, mu [-]: |friction| <= mu force
  /// Friction along the surface is at its bound, and the point moves along it by more than 0.1 mm/s.
  bool slips = false;
};

/// Contact points of all digits, in the digits' order. Empty in static mode.
struct ContactPoints {
  static constexpr int kMost = 16 * kDigits;
  int count = 0;
  std::array<ContactPoint, kMost> point;

  [[nodiscard]] const ContactPoint* begin() const noexcept { return point.data(); }
  [[nodiscard]] const ContactPoint* end() const noexcept { return point.data() + count; }
};

/// Contact of one segment at one tick; world frame W, SI.
struct SegmentSnapshot {
  bool contact = false;    ///< the segment has a contact record
  double depth = 0.0;      ///< d = (p_gdp - p_hcp) . n_c - d0, not below 0 [m]        S1 eq. (2)
  double force_raw = 0.0;  ///< magnitude that the force law gives [N]
  double force = 0.0;      ///< magnitude sent after caps and stabiliser [N]
  /// Contact point on the GDP segment, p_WC [m]; while a force decays without contact, the last one.
  Vec3 point = Vec3::Zero();
  /// Direction of the force on the finger, n_W [-]; zero without contact and force.
  Vec3 normal = Vec3::Zero();
  /// Tangential offset between the contact's material point on the HCP and on the GDP [m].
  double slid = 0.0;
  // Sliding mode; 0 in static mode, and while a force decays without contact:
  Vec3 friction = Vec3::Zero();  ///< sum of ContactPoint::friction [N]
  double spin = 0.0;             ///< sum of ContactPoint::spin about the points' mean normal [Nm]
  bool slips = false;            ///< points with more than half of the normal force slip
  /// Speed of the GDP's material point at `point` along the surface, from the last tick to this one; 0 in the
  /// tick in which contact begins [m/s].
  double slip_speed = 0.0;
  bool oscillating = false;            ///< `force` oscillates: OscillationObserver
  double oscillation_frequency = 0.0;  ///< [Hz]; 0 while not oscillating
  double oscillation_swing = 0.0;      ///< last full swing from peak to peak [N]; 0 while not oscillating
};

/// Result of one step. HCP is the hand at the sample's angles, GDP the shown hand.
struct Snapshot {
  std::uint64_t tick = 0;
  double time_s = 0.0;  ///< time of the last used sample [s]
  Status status = Status::kOk;
  JointArray hcp_angle{};  ///< [rad]; also q_ref of the walls
  /// Origin of each `hcp_angle`, from the last sample. Only measured angles may be scored.
  AngleOrigins angle_origin{};
  /// Digits with Status::kStartInside: their phase is not kNone until they have been clear.
  std::array<DigitOpening, kDigits> opening{};
  JointArray gdp_angle{};  ///< [rad]
  JointArray torque{};     ///< commanded torque of the contacts on the finger's joints, axis . (r x f) [Nm]
  std::array<SegmentSnapshot, kSegments> segment{};
  ContactPoints contact_points;
  std::array<Pose, kSegments> hcp_pose{};                   ///< X_WS
  std::array<Pose, kSegments> gdp_pose{};                   ///< X_WS
  JointArray measured_torque = not_measured<JointArray>();  ///< from the sample; NaN: not measured [Nm]
  DigitArray measured_force = not_measured<DigitArray>();   ///< from the sample; NaN: not measured [N]
  double stiffness_factor = 1.0;  ///< factor on the law's force, < 1 after OscillationReaction::kHalve
  std::array<LocalWall, kSegments> wall{};  ///< active only under Stabiliser::kLocalWall
  double wall_valid_for = 0.0;              ///< validity of the walls from time_s on [s]; 0: no walls
};

}  // namespace phalanx
