// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

#include "phalanx/core/math.h"

namespace phalanx::test {

/// Turns (1, 1, 1) to -z, so that a cube stands on a corner. Not by Eigen's Quaternion::FromTwoVectors, which
/// takes the compiler 7 s.
inline Mat3 corner_down() {
  const double angle = std::numbers::pi - std::acos(1.0 / std::numbers::sqrt3);
  return Eigen::AngleAxisd(angle, Vec3(-1, 1, 0).normalized()).toRotationMatrix();
}

}  // namespace phalanx::test
