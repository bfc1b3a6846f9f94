// SPDX-License-Identifier: Apache-2.0
// Contact points of the device's digits on the object, and their press directions.
#pragma once

#include <array>
#include <optional>

#include "phalanx/device/exoskeleton.h"
#include "phalanx/device/motion.h"
#include "phalanx/simulation/patient.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// Press of one digit. With g = n'J [m] at its first contact, a force f on the contact deflects the digit's
/// joints by dq = C g f. C is the inverse of the patient's joint stiffnesses. The patient presses
/// in this direction,
///   q(x) = q_contact - x C g / (g' C g)
/// where x is the path of the contact's point into the object along -n [m].
struct DigitPress {
  int segment = 0;             ///< the segment that touches first
  Vec3 point = Vec3::Zero();   ///< p_WC [m]
  Vec3 p_S = Vec3::Zero();     ///< the same material point in the segment's frame [m]
  Vec3 normal = Vec3::Zero();  ///< n_W, from the object to the finger
  JointArray g{};              ///< n'J, torque on each of the device's joints by a unit force along n [m]
  JointArray contact{};        ///< the digit's angles at the contact [rad]
  JointArray into{};           ///< dq/dx of the press [rad/m]
  double stiffness = 0.0;      ///< the patient's stiffness at the contact, 1 / (g' C g) [N/m]
};

/// The digits that the device moves and that meet the object, and the start of all joints.
struct PressPlan {
  std::array<std::optional<DigitPress>, kDigits> digit;
  JointArray open{};  ///< the open hand [rad]
};

/// Plays `motion`, as far as the device can sense it, through the step without dynamics, and finds each
/// digit's first contact. A coupled joint's lever arm is added to that of the joint it follows.
/// @throws std::invalid_argument if no digit of the device meets the object, or if one meets it only with
/// joints that the patient holds without stiffness. Set-up only.
[[nodiscard]] PressPlan plan_press(const HapticModel& model, const HapticParameters& parameters,
                                   const Motion& motion, const Exoskeleton& exoskeleton,
                                   const PatientParameters& patient);

}  // namespace phalanx
