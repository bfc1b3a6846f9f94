// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "phalanx/core/math.h"

namespace phalanx {

/// Force and torque on an object; the torque over a length, so that both have one unit.
using Wrench = Eigen::Matrix<double, 6, 1>;

/// Contact on an object: a point, and the inward unit normal along which it is pressed.
struct WrenchContact {
  Vec3 point = Vec3::Zero();
  Vec3 inward = Vec3::Zero();
};

/// Returns the extreme wrenches of unit normal force of each contact: friction along the surface in kSlideDirections
/// directions at its bound mu, and friction against rotation about the normal at its bound mu r_c, in both senses.
/// @param centre  about which torques are taken [m]
/// @param radius  over which they are divided [m], > 0
/// @param spin_radius  r_c [m]
[[nodiscard]] std::vector<Wrench> contact_wrenches(const std::vector<WrenchContact>& contacts,
                                                   double friction, double spin_radius, const Vec3& centre,
                                                   double radius);
inline constexpr int kSlideDirections = 6;

/// Returns the radius of the largest ball around zero in the convex hull of the wrenches; 0 if zero is not inside.
/// By the hull's facets (Qhull): exact to rounding. Not for the loop: seconds for some hundred wrenches.
[[nodiscard]] double wrench_ball(const std::vector<Wrench>& wrenches);

/// Returns an upper bound on that radius, by descent from fixed starts: the least support of the hull in the directions
/// that were tried; negative if one of them shows that zero is outside.
[[nodiscard]] double wrench_ball_bound(const std::vector<Wrench>& wrenches);

}  // namespace phalanx
