// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <numbers>

/// Numbers that mean the same everywhere, and what a number in the unit of a file or a table is multiplied by
/// to get one in the unit that is computed in (m, rad, N, s), or back.
namespace phalanx {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kMilli = 1e-3;
inline constexpr double kMm = 1e-3;               ///< [m/mm]
inline constexpr double kDeg = kPi / 180.0;       ///< [rad/deg]
inline constexpr double kRadToDeg = 180.0 / kPi;  ///< [deg/rad]

}  // namespace phalanx
