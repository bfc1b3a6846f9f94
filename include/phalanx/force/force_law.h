// SPDX-License-Identifier: Apache-2.0
// Force laws of a contact. S1 and S2 are the papers listed in docs/architecture.md.
#pragma once

#include "phalanx/force/force_parameters.h"

namespace phalanx {

/// Returns the magnitude of one contact's force [N], >= 0, with which the object pushes the finger out. 0 for
/// d <= 0.
///   Hooke              k d                                        S1 eq. (1), S2 eq. (1)
///   Kelvin-Voigt       max(0, k d + b v)
///   Hunt-Crossley      max(0, K d^n (1 + a v)),  K = k (1 mm)^(1-n), so that F = k d at d = 1 mm, v = 0
///   Duffing            k d + k3 d^3                               Cui's spring, cited by S2
///   linear-then-cubic  k d for d <= d1, else k d + k3 (d - d1)^3  Stepp's two pieces, cited by S2
///   own                the caller's function, but not below 0
/// The linear-then-cubic law and its slope are continuous.
/// @param law    parameters, SI
/// @param depth  d [m]
/// @param speed  v, the low-passed closing speed of the contact's material point on the
/// HCP (contact/gdp.h) [m/s]
/// @returns finite for finite arguments, except for a law of the caller whose result is not
/// Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] double law_force(const ForceLawParameters& law, double depth, double speed) noexcept;

/// Returns the slope dF/dd of the law at this depth and at rest (v = 0) [N/m], >= 0. For d < 0 it is the
/// slope at d = 0. For the caller's law it is the difference over the next micrometre, and 0 if that is not finite.
/// Finite for finite arguments. Real-time.
[[nodiscard]] double law_slope(const ForceLawParameters& law, double depth) noexcept;

/// Returns the gain of one step of a first-order low-pass with corner `corner_hz` [Hz] at period T [s],
/// discretised exactly: 1 - exp(-2 pi f T). Set-up or real-time.
[[nodiscard]] double lowpass_gain(double corner_hz, double period) noexcept;

}  // namespace phalanx
