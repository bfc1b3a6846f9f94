// SPDX-License-Identifier: Apache-2.0
// Linear algebra of the whole program: SI units, radians, double precision. The folder `core` holds what
// every other folder uses: vectors and poses (math.h), the status bits of a step (status.h), the newest value
// for another thread (latest.h), unit factors, seeded random numbers, suggestions for misspelt names, and
// threads of lowered priority. It includes no other folder.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace phalanx {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// Rigid pose X_AB of frame B in frame A:  p_A = R p_B + p.  R is orthonormal, p is in metres.
/// Real-time: plain values, no allocation.
struct Pose {
  Mat3 R = Mat3::Identity();
  Vec3 p = Vec3::Zero();

  /// The point x given in frame B, expressed in frame A [m].
  [[nodiscard]] Vec3 operator*(const Vec3& x) const noexcept { return R * x + p; }

  /// X_AC = X_AB X_BC.
  [[nodiscard]] Pose operator*(const Pose& other) const noexcept {
    return Pose{R * other.R, R * other.p + p};
  }

  /// X_BA.
  [[nodiscard]] Pose inverse() const noexcept { return Pose{R.transpose(), -(R.transpose() * p)}; }
};
// Eigen aligns other fixed-size types by the compiler's instruction sets (-mavx2). These must be laid out alike in a
// library and in a program with other options.
static_assert(sizeof(Pose) == 12 * sizeof(double) && alignof(Pose) == alignof(double));

/// Rotation by `angle` [rad] about the unit vector `axis` (right-handed).
[[nodiscard]] inline Mat3 rotation_about(const Vec3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

}  // namespace phalanx
