// SPDX-License-Identifier: Apache-2.0
// A contact in a form that the device's own controller can evaluate between two steps of the host.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// One contact, linearised at the angles q_ref of the step that made it:
///   f = clamp(k (d_ref - g . (q - q_ref)), 0, f_max)     torque of the digit's joint i: g_i f
/// in place of the torque g_i host_force that the host's command holds for this contact. A controller that
/// knows it adds sum g (f - host_force) to the host's torques and then applies all its own limits; after
/// Snapshot::wall_valid_for it adds nothing. The f_max keep the host's fingertip cap and joint torque limit
/// whatever the angles do; a digit whose torque the host has limited at this step sends no walls.
struct LocalWall {
  bool active = false;
  std::array<double, kJointsPerDigit> g{};  ///< n'J: the force's direction through the digit's joints, at the
                                            ///< contact on the GDP [m]
  double d_ref = 0.0;       ///< depth at q_ref such that k d_ref is the law's force there [m]; may be < 0
  double stiffness = 0.0;   ///< k, slope of the law at d_ref [N/m]
  double force_max = 0.0;   ///< f_max [N]; the sum over a digit's walls stays within the cap whatever they do
  double host_force = 0.0;  ///< magnitude in the host's command [N]
};

/// Angles of one digit [rad], in the order of the joints.
using DigitJoints = std::array<double, kJointsPerDigit>;

/// Force of the wall at the angles q [N], 0 .. force_max; 0 where it is not active or the result is not a
/// number. Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] inline double local_wall_force(const LocalWall& wall, const DigitJoints& q,
                                             const DigitJoints& q_ref) noexcept {
  if (!wall.active) return 0.0;
  double depth = wall.d_ref;
  for (std::size_t i = 0; i < wall.g.size(); ++i) depth -= wall.g[i] * (q[i] - q_ref[i]);
  const double force = wall.stiffness * depth;
  return std::isnan(force) ? 0.0 : std::clamp(force, 0.0, wall.force_max);
}

}  // namespace phalanx
