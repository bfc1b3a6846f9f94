// SPDX-License-Identifier: Apache-2.0
// Newton's method for the contact problem of one digit, where block Gauss-Seidel is slow: docs/sliding.md.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "contact/contact_problem.h"

namespace phalanx {

inline constexpr double kLeastArm =
    1e-6;  ///< below it the joints do not move a contact along its normal [m/rad]
inline constexpr double kLeastSpin = 1e-6;  ///< below it they do not turn it about its normal [rad^2/rad^2]

[[nodiscard]] inline double length_of(double x, double y) noexcept { return std::sqrt(x * x + y * y); }
[[nodiscard]] inline double dot(const DigitAngles& a, const DigitAngles& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + (a[2] * b[2] + a[3] * b[3]);
}

/// Bound at which each joint of a digit is held.
enum class Held : std::uint8_t { kNo, kLowest, kHighest };
using HeldJoints = std::array<Held, kJointsPerDigit>;

/// Returns the displacement of a joint that is held [rad].
[[nodiscard]] inline double held_displacement(const ContactProblem& problem, const HeldJoints& held,
                                              std::size_t joint) noexcept {
  return held[joint] == Held::kHighest ? problem.highest[joint] : problem.lowest[joint];
}

/// Returns a row without the joints that are held.
[[nodiscard]] inline DigitAngles free_part(const DigitAngles& row, const HeldJoints& held) noexcept {
  DigitAngles part = row;
  for (std::size_t j = 0; j < part.size(); ++j)
    if (held[j] != Held::kNo) part[j] = 0.0;
  return part;
}

/// Returns the displacement of a joint that the multipliers give without its limits [rad].
[[nodiscard]] inline double unlimited_displacement(const ContactProblem& problem,
                                                   std::size_t joint) noexcept {
  double x = problem.free[joint];
  for (std::size_t i = 0; i < static_cast<std::size_t>(problem.count); ++i) {
    const ProblemContact& contact = problem.contact[i];
    for (std::size_t r = 0; r < kContactRows; ++r) x += contact.row[r][joint] * contact.multiplier[r];
  }
  return x;
}

/// Returns the displacement of all joints that the multipliers give, of those that are held their bounds [rad].
[[nodiscard]] DigitAngles displacement_of(const ContactProblem& problem, const HeldJoints& held) noexcept;

/// Returns by how much the multipliers violate the conditions of normal, tangents and spin: the distance of each
/// multiplier from its projection on what the law allows, as a displacement. The greatest over all contacts
/// [m]: 0 for a solution, infinity if something is not a number. Real-time.
[[nodiscard]] double contact_residual(const ContactProblem& problem, const HeldJoints& held) noexcept;

/// Brings the multipliers nearer to a solution, from those of an iteration that has not converged, with the
/// joints of `held` fixed at their bounds. The law is made a function of the displacement by small compliances
/// e, whose offsets q an augmented Lagrangian moves until nothing of them is left:
///   p_n = max(0, q_n - (row_n . x + room) / e),   p_t = q_t - (row_t . x + t . spring) / e, within its disc
/// Rows with a compliance of their own (soft normals, tangents, spin) keep it, and have no offset. Newton's method
/// solves x = free + sum row^T p(x), four equations whatever the number of contacts is, and three for the spring of
/// each segment that has contacts: springs are joints without a goal, whose rows are sqrt(C) t. Not every problem is
/// solved: the multipliers with the least residual stay, those at the start included.
/// @param tolerance  ends at this residual [m]
/// @param budget     greatest number of Newton's steps, lowered by those taken
/// @returns the residual of the multipliers that stay [m]
/// Real-time: bounded, no allocation, lock, throw or I/O.
double newton_contacts(ContactProblem& problem, const HeldJoints& held, double tolerance,
                       int& budget) noexcept;

}  // namespace phalanx
