// SPDX-License-Identifier: Apache-2.0
#include "phalanx/force/stabiliser_methods.h"

#include <algorithm>
#include <cmath>

#include "phalanx/force/force_law.h"

namespace phalanx {

double low_passed_force(double target, double previous, double corner_hz, double period) noexcept {
  constexpr double kNothing = 1e-4;
  const double force = previous + lowpass_gain(corner_hz, period) * (target - previous);
  return target == 0.0 && force < kNothing ? 0.0 : force;
}

double damped_force(double target, double damping, double speed) noexcept {
  return std::max(0.0, target + damping * speed);
}

double coupled_force(double law_force, double depth, double moved, double coupling_stiffness,
                     double coupling_damping, double period, double& proxy) noexcept {
  if (!(depth > 0.0)) {
    proxy = 0.0;
    return 0.0;
  }
  const double wall = law_force / depth;
  const double damper = coupling_damping / period;
  const double sum = wall + coupling_stiffness + damper;
  const double solved = (coupling_stiffness * depth + damper * (moved + proxy)) / sum;
  // xp' <= d' gives xp <= d. The clamp covers a contact that hops, where `moved` is not the difference
  // of two depths.
  proxy = std::clamp(solved, 0.0, depth);
  return wall * proxy;
}

double passive_force(double target, double previous, double speed, double damping_max, double period,
                     double& energy) noexcept {
  constexpr double kMost = 1e3;
  energy = std::clamp(energy + period * previous * speed, -kMost, kMost);
  if (!(energy < 0.0) || speed == 0.0) return target;
  const double damping = std::min(-energy / (period * speed * speed), damping_max);
  return std::max(0.0, target + damping * speed);
}

double energy_bounded_force(double target, double previous, double dx, double device_damping,
                            double period) noexcept {
  if (dx == 0.0) return previous;
  const double beta = std::clamp((target - previous) / dx, 0.0, 2.0 * device_damping / period);
  return std::max(0.0, previous + beta * dx);
}

Vec3 turned_direction(const Vec3& from, const Vec3& to, double angle) noexcept {
  if (from.isZero(0.0)) return to;
  const double apart = std::atan2(from.cross(to).norm(), from.dot(to));
  if (!(apart > angle)) return to;
  Vec3 sideways = to - from.dot(to) * from;  // in the plane of both, normal to `from`
  if (sideways.norm() < 1e-9) {
    const Vec3 other = std::abs(from.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    sideways = other - from.dot(other) * from;
  }
  return (std::cos(angle) * from + std::sin(angle) * sideways.normalized()).normalized();
}

}  // namespace phalanx
