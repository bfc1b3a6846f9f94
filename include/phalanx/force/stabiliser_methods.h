// SPDX-License-Identifier: Apache-2.0
// Formulas of the stabilisers as functions of numbers. Depth d >= 0 into the wall [m], closing speed v =
// dd/dt > 0 pressing in [m/s], forces >= 0 pushing the finger out [N], period T [s]. All are O(1) and
// real-time safe. All are finite for finite arguments.
#pragma once

#include <algorithm>

#include "phalanx/core/math.h"
#include "phalanx/force/stabiliser.h"

namespace phalanx {

/// Returns the force of a bounded change:  F' + clamp(F - F', dF_min, dF_max),  dF = rate x T.   S2 eq. (3)-(4)
/// @param min_rate  fastest fall [N/s] < 0; -infinity: only the rise is bounded
/// @param max_rate  fastest rise [N/s] > 0
[[nodiscard]] inline double smoothed_force(double target, double previous, double min_rate, double max_rate,
                                           double period) noexcept {
  return previous + std::clamp(target - previous, min_rate * period, max_rate * period);
}

/// Returns the force of a first-order low-pass, discretised exactly:  F' + (1 - exp(-2 pi f T)) (F - F'). A
/// force that decays to zero becomes 0 below 0.1 mN.
[[nodiscard]] double low_passed_force(double target, double previous, double corner_hz,
                                      double period) noexcept;

/// Returns the force with a damper beside the law:  max(0, F + b v), Kelvin-Voigt.
/// For a wall F = k d it is passive on a device of damping B only if B > k T / 2 + b. Colgate, Schenkel,
/// "Passivity of a class of sampled-data systems", J. Robotic Systems 14(1), 1997.
[[nodiscard]] double damped_force(double target, double damping, double speed) noexcept;

/// Returns the force of a virtual coupling. A spring Kc and a damper Bc tie the finger to a massless proxy,
/// which presses the wall: both see the same force. Implicit Euler:
///   k xp = Kc (d - xp) + Bc ((d - d') - (xp - xp')) / T,     F = k xp >= 0
/// Here k = F_law / d is the law's chord stiffness, which is k itself for Hooke's law.
/// Colgate, Stanley, Brown, "Issues in the haptic display of tool use", IROS 1995; Adams, Hannaford, "Stable
/// haptic interaction with virtual environments", IEEE Trans. Robotics Automation 15(3), 1999.
/// @param moved  d - d', change of the depth in this step [m]
/// @param proxy  xp' on entry, xp on return [m], within 0 .. d. It is never deeper than d. It is 0 if the
/// finger leaves so fast that the damper would pull the proxy out of the wall.
[[nodiscard]] double coupled_force(double law_force, double depth, double moved, double coupling_stiffness,
                                   double coupling_damping, double period, double& proxy) noexcept;

/// Returns the force of time-domain passivity control in impedance form. The observer sums the energy E that
/// the finger put into the contact, from the force really sent. If E is negative, the contact has generated
/// energy, and a damper dissipates it:
///   E += T F' v,     a = min(-E / (T v^2), a_max) where E < 0, else 0,     out = max(0, F + a v)
/// F' contains the damper's own share. The term T F' v is exact if F' is held over the step in which the
/// finger moved v T. For a device with delays or a torque limit it is an estimate.
/// Hannaford, Ryu, "Time-domain passivity control of haptic interfaces", IEEE Trans. Robotics Automation
/// 18(1), 2002. Their E separates the law's force and the damper's.
/// @param energy  E on entry and on return [J], kept within +-1000 J
[[nodiscard]] double passive_force(double target, double previous, double speed, double damping_max,
                                   double period, double& energy) noexcept;

/// Returns the force of energy bounding:
///   F(n) = F(n-1) + beta dx,  beta = clamp((F_law - F(n-1)) / dx, 0, 2 b / T);  F(n-1) if dx = 0
/// The bound is that of a device with damping b and a zero-order hold. Kim, Ryu, "Robustly stable haptic
/// interaction control using an energy-bounding algorithm", Int. J. Robotics Research 29(6), 2010.
/// The force follows the displacement, not the depth. While the finger rests it stays constant, above or
/// below the law's. No step changes it by more than 2 b |dx| / T, so that the displayed stiffness never
/// exceeds 2 b / T.
[[nodiscard]] double energy_bounded_force(double target, double previous, double dx, double device_damping,
                                          double period) noexcept;

/// Returns the direction `from`, rotated towards `to` by at most `angle` [rad] about the axis normal to both.
/// If they are opposite, any axis normal to `from` serves. Burdea, "Force and Touch Feedback for Virtual
/// Reality", Wiley 1996.
/// @param from  last direction, unit; if it is zero, the result is `to`
/// @param to    current normal, unit
[[nodiscard]] Vec3 turned_direction(const Vec3& from, const Vec3& to, double angle) noexcept;

}  // namespace phalanx
