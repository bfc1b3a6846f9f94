// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "phalanx/core/math.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// Contact point of a segment in sliding mode, with the state of its friction. See docs/sliding.md.
struct SlidingContact {
  int k = 0;                    ///< segment of the digit: 0 nearest the palm, 2 distal
  std::int32_t triangle = -1;   ///< of the segment's mesh
  std::int32_t slot = -1;       ///< of the object's tree
  Vec3 p_S = Vec3::Zero();      ///< point on the segment, in the segment's frame [m]
  Vec3 p_W = Vec3::Zero();      ///< the same in W, at the pose of the last solution [m]
  Vec3 normal = Vec3::UnitZ();  ///< unit vector from the object to the segment at closest approach, in W
  /// Direction of the normal force, in W: as ContactParameters::normal says. Friction acts across it.
  Vec3 force_normal = Vec3::UnitZ();
  std::array<Vec3, 2> tangent{};  ///< unit vectors that complete the normal to a right-handed frame, in W
  double friction = 0.0;          ///< Coulomb coefficient mu [-]
  double gap = 0.0;               ///< distance of segment and object at that pose [m]
  /// Depths whose forces the law gives: along the normal (>= 0), and friction's along both tangents [m].
  /// Friction is within the cone |depth_t| <= mu depth_n.
  std::array<double, 3> depth{};
  double spin_depth = 0.0;  ///< the same about the normal: moment per stiffness [m^2]
  /// Multipliers of the contact problem: normal, tangents [1/m], spin [-].
  std::array<double, 4> multiplier{};
  double turned = 0.0;  ///< rotation about the normal while spin is held [rad]
  bool slips = false;   ///< friction along the surface is at its bound
  bool spins = true;    ///< friction about the normal is at its bound

  [[nodiscard]] bool presses() const noexcept { return depth[0] > 0.0; }
  /// Returns the vector, turned with the rotation that takes `normal` to `force_normal` by the shortest way.
  [[nodiscard]] Vec3 with_force_normal(const Vec3& v) const noexcept {
    const Vec3 across = normal.cross(force_normal);
    if (across.isZero(0.0)) return v;
    const double cosine = normal.dot(force_normal);
    return cosine * v + across.cross(v) + across.dot(v) / (1.0 + cosine) * across;
  }
  /// Returns friction's depths along the tangents, turned, in W [m].
  [[nodiscard]] Vec3 friction_depth() const noexcept {
    return with_force_normal(depth[1] * tangent[0] + depth[2] * tangent[1]);
  }
  /// Returns the depths of normal force and friction, added, in W [m].
  [[nodiscard]] Vec3 resultant() const noexcept { return depth[0] * force_normal + friction_depth(); }
  /// Returns the sum of the multipliers along the tangents, in W [1/m].
  [[nodiscard]] Vec3 tangential_multiplier() const noexcept {
    return multiplier[1] * tangent[0] + multiplier[2] * tangent[1];
  }
};

/// Contact points of one digit in sliding mode.
struct DigitContacts {
  static constexpr int kMost = 16;
  int count = 0;
  std::array<SlidingContact, kMost> contact;
  /// Elongation of the springs through which friction acts on each segment, in W [m]: the motion of its contact points
  /// along the surface while friction holds.
  std::array<Vec3, kSegmentsPerDigit> elongation{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  std::array<double, 4> limit{};      ///< multipliers of the joints' limits [rad]
  double depth_per_multiplier = 0.0;  ///< kappa over stiffness: turns multipliers into depths [m^2]
  double residual = 0.0;       ///< greatest of the substeps' contact problems [m]; 0 if there were none
  double unchecked_for = 0.0;  ///< time since the HCP was last looked for beyond the object [s]
  bool beyond = false;         ///< it was clear of the object then
  double beyond_for =
      0.0;  ///< time for which it has been, less that since it no longer is, 0 to kFadeTime [s]
  static constexpr double kFadeTime = 30e-3;
  /// Returns the share of the forces that is left.
  [[nodiscard]] double force_share() const noexcept { return 1.0 - beyond_for / kFadeTime; }

  /// Way of the shown digit round the object, to where it is measured. It touches nothing on it.
  struct Detour {
    enum Phase {
      kNone,
      kLooking,  ///< for a way that is free; the digit stays
      kOut,      ///< to the posture `out`
      kAcross,   ///< from there to beside the measured posture
      kBack,     ///< to the measured posture
    };
    Phase phase = kNone;
    int way = 0;             ///< the way that is looked at or gone
    int free_legs = 0;       ///< of it
    DigitAngles out{};       ///< [rad]
    DigitAngles measured{};  ///< the posture for which the ways are looked at [rad]
    double lasts = 0.0;      ///< time since the search began [s]
  };
  Detour detour;
};

}  // namespace phalanx
