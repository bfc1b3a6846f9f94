// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

/// What a number in the unit of a file or a table is multiplied by to get one in the unit that is computed in
/// (m, rad, N, s), or back.
namespace phalanx {

inline constexpr double kMilli = 1e-3;
inline constexpr double kMm = 1e-3;                            ///< [m/mm]
inline constexpr double kDeg = std::numbers::pi / 180.0;       ///< [rad/deg]
inline constexpr double kRadToDeg = 180.0 / std::numbers::pi;  ///< [deg/rad]

}  // namespace phalanx
