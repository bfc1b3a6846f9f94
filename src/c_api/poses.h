// SPDX-License-Identifier: Apache-2.0
// Vectors and poses between the C interface and the library. Real-time.
#pragma once

#include "phalanx/core/math.h"
#include "phalanx/phalanx.h"

namespace phalanx::c_api {

inline void copy_vector(const Vec3& from, double into[3]) noexcept {
  for (int i = 0; i < 3; ++i) into[i] = from[i];
}

inline phalanx_pose pose_to(const Pose& X) noexcept {
  phalanx_pose out{};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) out.rotation[3 * row + column] = X.R(row, column);
  copy_vector(X.p, out.position);
  return out;
}

inline Pose pose_from(const phalanx_pose& X) noexcept {
  Pose out;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) out.R(row, column) = X.rotation[3 * row + column];
  for (int i = 0; i < 3; ++i) out.p[i] = X.position[i];
  return out;
}

/// @returns true if the rotation is orthonormal to 1e-6 and right-handed; false for a number that is not
/// finite.
inline bool is_rotation(const phalanx_pose& X) noexcept {
  constexpr double kTolerance = 1e-6;
  const Mat3 R = pose_from(X).R;
  return (R * R.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() <= kTolerance && R.determinant() > 0.0;
}

}  // namespace phalanx::c_api
