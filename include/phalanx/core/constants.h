// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <numbers>

/// Mathematical constants and unit factors. A unit factor converts a number from a file's or table's unit to
/// the SI unit used inside (m, rad, N, s), or back.
namespace phalanx {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kMilli = 1e-3;
inline constexpr double kMm = 1e-3;               ///< [m/mm]
inline constexpr double kDeg = kPi / 180.0;       ///< [rad/deg]
inline constexpr double kRadToDeg = 180.0 / kPi;  ///< [deg/rad]
inline constexpr double kCos30Deg = 0.86602540378443865;

}  // namespace phalanx
