// SPDX-License-Identifier: Apache-2.0
// The simulated patient: what moves the exoskeleton's joints from the inside.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// A patient's hand as an impedance around what the patient intends, joint by joint:
///   torque = stiffness (q_intended + tremor - q) + damping (dq_intended/dt - dq/dt).
/// The intent follows a motion until the digit meets the object, and from there goes on so far that the
/// contact's force is `press` in the end (phalanx/device/press_intent.h).
struct PatientParameters {
  std::string name;
  std::string description;
  JointArray stiffness{};     ///< [N m/rad] >= 0
  JointArray damping{};       ///< [N m s/rad] >= 0
  double press = 3.0;         ///< force that each pressing digit is meant to reach [N] >= 0
  double press_spread = 0.3;  ///< a seed draws the factor 1 +- this [-], 0 .. 1
  double approach_min =
      0.03;  ///< speed at which a fingertip comes to the object [m/s] > 0; a seed draws between
  double approach_max = 0.09;  ///< the two
  double tremor = 30e-6;       ///< amplitude at the fingertip [m] >= 0
  double tremor_min_hz = 5.0;  ///< a seed draws three frequencies between these [Hz]
  double tremor_max_hz = 12.0;
  double bump = 2.0;           ///< a push on the pressing fingertip, along the press [N]; 0: none
  double bump_start = 1.6;     ///< [s]
  double bump_duration = 0.1;  ///< [s]
};

/// @throws std::invalid_argument naming the key, the value and the remedy if a number is not finite or out of
/// range.
void check_patient(const PatientParameters& patient);

}  // namespace phalanx
