// SPDX-License-Identifier: Apache-2.0
// The formula of each stabiliser, as a function of numbers. Depth d >= 0 into the wall, closing speed v =
// dd/dt > 0 pressing in, forces >= 0 push the finger out. All are O(1) and real-time safe; all are finite for
// finite arguments.
#pragma once

#include "phalanx/core/math.h"
#include "phalanx/force/stabiliser.h"

namespace phalanx {

/// First-order low-pass, discretised exactly:  F' + (1 - exp(-2 pi f T)) (F - F').
/// Below 0.1 mN a force that decays to nothing is 0.
[[nodiscard]] double low_passed_force(double target, double previous, double corner_hz,
                                      double period) noexcept;

/// A damper beside the law:  max(0, F + b v).     Kelvin-Voigt; for a wall F = k d it is passive on a device
/// of damping B only where B > k T / 2 + b: Colgate, Schenkel, "Passivity of a class of sampled-data
/// systems", J. Robotic Systems 14(1), 1997.
[[nodiscard]] double damped_force(double target, double damping, double speed) noexcept;

/// Virtual coupling: the finger is tied by a spring Kc and a damper Bc to a proxy without mass, and the proxy
/// presses the wall, so that both see the same force. Implicit Euler:
///   k xp = Kc (d - xp) + Bc ((d - d') - (xp - xp')) / T,     F = k xp >= 0
/// k = F_law / d is the law's chord stiffness, which is k itself for Hooke's law.
/// Colgate, Stanley, Brown, "Issues in the haptic display of tool use", IROS 1995; Adams, Hannaford, "Stable
/// haptic interaction with virtual environments", IEEE Trans. Robotics Automation 15(3), 1999.
/// @param moved  d - d', change of the depth in this step [m]
/// @param proxy  xp' on entry, xp on return [m], within 0 .. d: never deeper than d by itself, and 0 where
/// the finger leaves so fast that the damper would pull it out of the wall
[[nodiscard]] double coupled_force(double law_force, double depth, double moved, double coupling_stiffness,
                                   double coupling_damping, double period, double& proxy) noexcept;

/// Time-domain passivity control, impedance form. The observer counts the energy that the finger put into the
/// contact, with the force really sent; where it is negative the contact has made energy, and a damper takes
/// it back:
///   E += T F' v,     a = min(-E / (T v^2), a_max) where E < 0, else 0,     out = max(0, F + a v)
/// F' holds the damper's own share. T F' v is exact where F' is held over the step in which the finger moved
/// v T; of a device that answers later, with delays or behind a torque limit, the host sees only this
/// estimate. Hannaford, Ryu, "Time-domain passivity control of haptic interfaces", IEEE Trans. Robotics
/// Automation 18(1), 2002, whose E takes the law's force and the damper's apart.
/// @param energy  E on entry and on return, kept within +-1000 J
[[nodiscard]] double passive_force(double target, double previous, double speed, double damping_max,
                                   double period, double& energy) noexcept;

/// Energy bounding:  F(n) = F(n-1) + beta dx,  beta = clamp((F_law - F(n-1)) / dx, 0, 2 b / T);  F(n-1) where
/// dx = 0.     Kim, Ryu, "Robustly stable haptic interaction control using an energy-bounding algorithm",
/// Int. J. Robotics Research 29(6), 2010; the bound is that of a device with damping b and a zero-order hold.
/// The force follows the displacement, not the depth: while the finger rests it stays, above or below the
/// law's, and no step changes it by more than 2 b |dx| / T. What is shown is never stiffer than 2 b / T.
/// @param dx  displacement into the wall since the last step [m]
[[nodiscard]] double energy_bounded_force(double target, double previous, double dx, double device_damping,
                                          double period) noexcept;

/// Force-direction smoothing: `from` turned towards `to` by at most `angle` [rad], about the axis that is
/// normal to both; where they are opposite, about one that is.     Burdea, "Force and Touch Feedback for
/// Virtual Reality", Wiley 1996.
/// @param from  the last direction, unit; zero where there is none: then `to`
/// @param to    the current normal, unit
[[nodiscard]] Vec3 turned_direction(const Vec3& from, const Vec3& to, double angle) noexcept;

}  // namespace phalanx
