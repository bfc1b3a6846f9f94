// SPDX-License-Identifier: Apache-2.0
// Contact problem of one digit: how far its joints move in one tick towards the measured angles while contacts
// with friction stop them. See docs/sliding.md.
#pragma once

#include <array>
#include <limits>

#include "phalanx/core/math.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// Rows of a contact: motion along its normal, along two tangents, and about its normal.
enum ContactRow { kNormalRow, kTangentRow, kSecondTangentRow, kSpinRow };
inline constexpr std::size_t kContactRows = 4;
using ContactRows = std::array<double, kContactRows>;

/// A vector in W for each segment of a digit.
using SegmentVectors = std::array<Vec3, kSegmentsPerDigit>;

/// One contact of the problem, and its solution.
struct ProblemContact {
  /// Jacobian rows: displacement of the segment's point along each direction per joint displacement [m/rad],
  /// and for the spin row the rotation about the normal [rad/rad].
  std::array<DigitAngles, kContactRows> row{};
  /// Distance that the contact may close before it pushes [m]; < 0: it must open by so much.
  double room = 0.0;
  /// Of a contact without friction: the normal row gives way by softness |row_n|^2 p_n [-].
  double softness = 0.0;
  int segment = 0;                                          ///< of the digit, whose spring friction pulls at
  std::array<Vec3, 2> tangent{Vec3::Zero(), Vec3::Zero()};  ///< directions of the tangents, in W
  /// Compliance of this contact's friction alone: its tangents give way by it times their multipliers [m^2]. It has no
  /// elongation that is kept: it damps what the contacts of a segment do against each other.
  double tangent_compliance = 0.0;
  double spin_anchor = 0.0;  ///< rotation about the normal that friction turns back [rad]
  double friction = 0.0;     ///< Coulomb coefficient mu [-], >= 0
  /// r_c: friction resists a rotation up to mu r_c times the normal multiplier [m].
  double spin_radius = 0.0;
  /// Normal multiplier above which friction grows no further [1/m].
  double most_friction_normal = std::numeric_limits<double>::infinity();
  /// Solution, and the start of the iteration: multipliers of the rows [1/m], of the spin row [-].
  ContactRows multiplier{};
  bool slips = false;  ///< the tangential multiplier is on its bound
  bool spins = false;  ///< the spin multiplier is on its bound
};

/// Contact problem of one digit. With the joints' displacement x and each contact's multipliers p:
///   x = free + sum row^T p                                          (quasi-static, massless, unit stiffness)
///   normal    0 <= row_n . x + room   complementary to   p_n >= 0
///   tangent   s = row_t . x + t . (e + C P) + c p_t = 0  if |p_t| <= mu min(p_n, most_friction_normal), else p_t is
///             on that bound and opposes s. P is the sum of t p_t over the contacts of the segment, e the
///             spring's elongation, C its compliance, c the contact's own.
///   spin      row_s . x + anchor_s = -0.02 |row_s|^2 p_s  if |p_s| <= mu r_c min(p_n, most_friction_normal), else
///             p_s is on that bound and opposes it. The anchor takes the small rotation back.
///   limits    lowest <= x <= highest
struct ContactProblem {
  static constexpr int kMostContacts = 16;
  /// Relative softness of the spin row. Where one joint alone both turns a contact and moves it sideways, the
  /// tangents then hold it.
  static constexpr double kSpinSoftness = 0.02;

  DigitAngles free{};  ///< displacement without contact [rad]
  DigitAngles lowest{};
  DigitAngles highest{};  ///< bounds of x, of both signs or zero [rad]
  /// Elongation of each segment's spring, in W [m], and their compliance [m^2].
  SegmentVectors elongation{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  double spring_compliance = 0.0;
  int count = 0;
  std::array<ProblemContact, kMostContacts> contact;

  DigitAngles limit{};         ///< solution: multipliers of the limits [rad]
  DigitAngles displacement{};  ///< solution: x [rad]
};

/// Returns the sum of the tangents' multipliers, in W [1/m]: of a contact, and of the contacts of each segment.
[[nodiscard]] inline Vec3 tangential_multiplier(const ProblemContact& contact) noexcept {
  return contact.multiplier[kTangentRow] * contact.tangent[0] +
         contact.multiplier[kSecondTangentRow] * contact.tangent[1];
}
[[nodiscard]] SegmentVectors tangential_multipliers(const ContactProblem& problem) noexcept;

/// Solves the problem by block Gauss-Seidel, a block for each contact. Where that has not converged for several
/// contacts, Newton's method goes on (contact_newton.h). Contacts are in the order of `contact`.
/// @param sweeps     greatest number of sweeps over the blocks
/// @param tolerance  ends when no row changes by more in one sweep, or the residual of Newton's method is this [m]
/// @returns the residual of the solution [m], contact_residual() of contact_newton.h; for one that the sweeps found, a
/// bound on the changes of the last of them, at most `tolerance`
/// The result is finite for finite input. Normal multipliers are >= 0, friction is within its
/// bound and joints are within their limits, whether the iteration has converged or not.
/// Real-time: bounded, no allocation, lock, throw or I/O.
double solve_contacts(ContactProblem& problem, int sweeps, double tolerance) noexcept;

}  // namespace phalanx
