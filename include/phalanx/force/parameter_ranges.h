// SPDX-License-Identifier: Apache-2.0
// Ranges of the numbers in HapticParameters, in their SI units. check_parameters() refuses a number outside
// its range, and so does the key of a scene file (scene/scene_keys.h) that sets the number.
#pragma once

#include "phalanx/core/constants.h"
#include "phalanx/core/number_range.h"

namespace phalanx::ranges {

inline constexpr NumberRange kRate = between(1, 4000);  ///< HapticParameters::rate_hz [Hz]

// ContactParameters
inline constexpr NumberRange kMargin = between(1e-6, 1e-3);                 ///< [m]
inline constexpr NumberRange kSlidDistance = above(0, 0.1);                 ///< [m]
inline constexpr NumberRange kFriction = between(0, 2);                     ///< mu [-]
inline constexpr NumberRange kTangentialStiffnessRatio = between(0.05, 1);  ///< [-]
inline constexpr NumberRange kSpinRadius = between(0, 0.02);                ///< [m]
inline constexpr NumberRange kMaxContacts = between(1, 4);                  ///< of a segment [-]

// ForceLawParameters
inline constexpr NumberRange kStiffness = between(0, 1e5);            ///< [N/m]
inline constexpr NumberRange kDamping = between(0, 1000);             ///< of all laws and stabilisers [N s/m]
inline constexpr NumberRange kLowpass = between(1e-3, 2000);          ///< of speed and force [Hz]
inline constexpr NumberRange kHuntCrossleyExponent = between(1, 5);   ///< [-]
inline constexpr NumberRange kHuntCrossleyDamping = between(0, 100);  ///< [s/m]
inline constexpr NumberRange kCubic = between(0, 1e11);               ///< [N/m^3]
inline constexpr NumberRange kLinearDepth = between(0, 0.05);         ///< [m]

// StabiliserParameters
inline constexpr NumberRange kMinRate = {
    .min = -1e6, .max = 0, .max_open = true, .allows_minus_infinity = true};  ///< [N/s]
inline constexpr NumberRange kMaxRate = above(0, 1e6);                        ///< [N/s]
inline constexpr NumberRange kTurnRate = above(0, 1e6 * kDeg);                ///< [rad/s]
inline constexpr NumberRange kCouplingStiffness = between(1, 1e6);            ///< [N/m]
inline constexpr NumberRange kWallValid = between(1e-4, 1);                   ///< [s]

// OscillationParameters
inline constexpr NumberRange kSwing = between(0.01, 15);  ///< [N]

// LimitParameters, while the limit is on
inline constexpr NumberRange kFingertipForce = above(0, 15);  ///< [N]
inline constexpr NumberRange kJointTorque = above(0, 5);      ///< [Nm]
inline constexpr NumberRange kTorqueRate = above(0, 1e4);     ///< [Nm/s]
inline constexpr NumberRange kJointSpeed = above(0, 1000);    ///< [rad/s]

}  // namespace phalanx::ranges
