// SPDX-License-Identifier: Apache-2.0
// Where the device's digits meet the object, and along which direction they press.
#pragma once

#include <array>
#include <optional>

#include "phalanx/device/exoskeleton.h"
#include "phalanx/device/motion.h"
#include "phalanx/device/patient.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// How one digit presses. With g = n'J [m] at its first contact, the digit's joints give way to a force f on
/// the contact by dq = C g f, C the inverse of the patient's joint stiffnesses: that is the direction in
/// which the patient presses,
///   q(x) = q_contact - x C g / (g' C g)
/// with x the way of the contact's point into the object along n [m].
struct DigitPress {
  int segment = 0;             ///< that touches first
  Vec3 point = Vec3::Zero();   ///< p_WC [m]
  Vec3 p_S = Vec3::Zero();     ///< the same material point in the segment's frame [m]
  Vec3 normal = Vec3::Zero();  ///< n_W, from the object to the finger
  JointArray g{};              ///< n'J, torque of a unit force along n on each of the device's joints [m]
  JointArray contact{};        ///< the digit's angles at the contact [rad]
  JointArray into{};           ///< dq/dx of the press [rad/m]
  double stiffness = 0.0;      ///< the patient's as felt at the contact, 1 / (g' C g) [N/m]
};

/// The digits that the device moves and that meet the object, and where all joints start.
struct PressPlan {
  std::array<std::optional<DigitPress>, kDigits> digit;
  JointArray open{};  ///< the open hand [rad]
};

/// Plays `motion`, as far as the device can sense it, through the step without any dynamics, and writes down
/// each digit's first contact. A coupled joint's lever arm is added to that of the joint it follows.
/// @throws std::invalid_argument if no digit of the device meets the object, or one meets it only with joints
/// that the patient holds with no stiffness. Set-up only.
[[nodiscard]] PressPlan plan_press(const HapticModel& model, const Motion& motion,
                                   const Exoskeleton& exoskeleton, const PatientParameters& patient);

}  // namespace phalanx
