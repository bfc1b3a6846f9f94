// SPDX-License-Identifier: Apache-2.0
// Transmissions whose moment arm depends on the joint's angle: tables, polynomials and four-bar linkages.
// docs/device-file.md has the equations.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace phalanx {

/// A point of a moment-arm table.
struct ArmPoint {
  double angle = 0.0;  ///< of the joint [rad]
  double arm = 0.0;    ///< [m]
};

/// Planar four-bar linkage. The motor turns the crank about O2, the joint turns the rocker about O4. The
/// coupler connects their ends A and B. All angles are counted in the direction of flexion, from the line O2
/// to O4. With the joint at q the rocker is at  rocker_angle + q.
struct FourBar {
  double ground = 0.0;        ///< O2 to O4 [m] > 0
  double crank = 0.0;         ///< O2 to A [m] > 0
  double coupler = 0.0;       ///< A to B [m] > 0
  double rocker = 0.0;        ///< O4 to B [m] > 0
  double rocker_angle = 0.0;  ///< [rad]
  bool crossed = false;       ///< the other of the two ways to assemble it
  /// Length that the motor winds up per radian of the crank [m]. Its sign is the direction.
  double drum = 0.0;
};

/// Transmission between a motor and one joint. A joint at q has unwound  e(q) = integral of r  from 0 to q,
/// and a tension T does the torque  r(q) T  on it, with  r = de/dq. So the power is the same on both sides:
/// T e' = (r T) q'.  Beyond min_angle and max_angle, r keeps its value at the end.
/// Exactly one of polynomial, table and four_bar is stated.
struct JointLinkage {
  int joint = 0;                        ///< joint_index() of the hand
  double min_angle = 0.0;               ///< [rad]
  double max_angle = 0.0;               ///< [rad] > min_angle
  std::vector<double> polynomial = {};  ///< c_k:  r = sum_k c_k q^k  [m/rad^k]
  std::vector<ArmPoint> table = {};     ///< r is linear between the points; at least two, of increasing angle
  std::optional<FourBar> four_bar = {};  ///< e = drum times the crank's angle
};

/// Least magnitude of a moment arm [m]. A smaller one is a singularity: the motor cannot hold the joint.
inline constexpr double kLeastArm = 0.2e-3;
/// Largest magnitude of a moment arm [m].
inline constexpr double kLargestArm = 0.1;

/// @returns the moment arm r(q) [m]. @pre check_linkage() has passed. Real-time: no allocation, lock or
/// throw.
[[nodiscard]] double moment_arm(const JointLinkage& linkage, double angle) noexcept;
/// @returns the length that the joint has unwound, e(q) [m]; e(0) = 0. Real-time.
[[nodiscard]] double excursion(const JointLinkage& linkage, double angle) noexcept;
/// @returns the joint's angle for a length, the inverse of excursion() [rad], to 1e-9 rad. Real-time.
[[nodiscard]] double angle_of_excursion(const JointLinkage& linkage, double length) noexcept;
/// @returns the moment arm of the largest magnitude between min_angle and max_angle [m].
[[nodiscard]] double largest_arm(const JointLinkage& linkage) noexcept;
/// @returns the moment arm of the least magnitude there [m].
[[nodiscard]] double least_arm(const JointLinkage& linkage) noexcept;

/// Checks a linkage.
/// @param place  names it in messages: "motor index_pip, linkage of index_pip_flexion"
/// @throws std::invalid_argument naming place, angle, value and remedy: a number is not finite or outside the
/// ranges above; a four-bar linkage cannot be assembled at an angle of the range; or the moment arm becomes
/// less than kLeastArm or changes its sign there. Set-up only.
void check_linkage(const JointLinkage& linkage, const std::string& place);

}  // namespace phalanx
