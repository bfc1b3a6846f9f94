// SPDX-License-Identifier: Apache-2.0
// The simulated patient, who moves the exoskeleton's joints from the inside.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// A patient's hand as an impedance around the intended angles, joint by joint:
///   torque = stiffness (q_intended + tremor - q) + damping (dq_intended/dt - dq/dt).
/// The intent follows a motion until the digit meets the object. From there it goes deeper, until the
/// contact's force at rest is `press` (phalanx/simulation/press_intent.h).
struct PatientParameters {
  std::string name;
  std::string description;
  JointArray stiffness{};       ///< [N m/rad] >= 0
  JointArray damping{};         ///< [N m s/rad] >= 0
  double press = 3.0;           ///< intended force of each pressing digit [N] >= 0
  double press_spread = 0.3;    ///< a seed draws the force's factor from 1 - this to 1 + this [-], 0 .. 1
  double approach_min = 0.03;   ///< least speed of a fingertip towards the object [m/s] > 0
  double approach_max = 0.09;   ///< largest speed; a seed draws between the two
  double tremor = 30e-6;        ///< amplitude at the fingertip [m] >= 0
  double tremor_min_hz = 5.0;   ///< lower bound of the three frequencies that a seed draws [Hz]
  double tremor_max_hz = 12.0;  ///< upper bound [Hz]
  double bump = 2.0;            ///< push on the pressing fingertip, along the press [N]; 0: none
  double bump_start = 1.6;      ///< [s]
  double bump_duration = 0.1;   ///< [s]
};

/// Checks a patient's parameters.
/// @throws std::invalid_argument naming the key, the value and the remedy if a number is not finite or
/// out of range.
void check_patient(const PatientParameters& patient);

}  // namespace phalanx
