// SPDX-License-Identifier: Apache-2.0
// A contact in a form that the device's own controller can evaluate between two host steps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// One contact, linearised at the angles q_ref of the step that computed it:
///   f = clamp(k (d_ref - g . (q - q_ref)), 0, f_max)     torque of the digit's joint i: g_i f
/// It replaces the torque g_i host_force, which the host's command contains for this contact. The controller
/// adds sum g (f - host_force) to the host's torques, and then applies all its own limits. After
/// Snapshot::wall_valid_for it adds nothing.
/// For any angles the f_max keep the host's fingertip cap and joint torque limit. If the host has limited a
/// digit's torque at a step, it sends no walls for that digit.
struct LocalWall {
  bool active = false;
  /// n'J: the force's direction times the digit's Jacobian, at the contact on the shown hand [m]. In sliding mode
  /// with the couple of several contact points.
  std::array<double, kJointsPerDigit> g{};
  double d_ref = 0.0;       ///< depth for which k d_ref is the law's force at q_ref [m]; may be < 0
  double stiffness = 0.0;   ///< k, slope of the law at the contact's depth [N/m]
  double force_max = 0.0;   ///< f_max [N]; the sum over a digit's walls stays within the cap
  double host_force = 0.0;  ///< magnitude contained in the host's command [N]
};

/// Returns the wall's force at the angles q [N], 0 .. force_max; 0 if it is not active or the result is not a
/// number. Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] inline double local_wall_force(const LocalWall& wall, const DigitAngles& q,
                                             const DigitAngles& q_ref) noexcept {
  if (!wall.active) return 0.0;
  double depth = wall.d_ref;
  for (std::size_t i = 0; i < wall.g.size(); ++i) depth -= wall.g[i] * (q[i] - q_ref[i]);
  const double force = wall.stiffness * depth;
  return std::isnan(force) ? 0.0 : std::clamp(force, 0.0, wall.force_max);
}

}  // namespace phalanx
