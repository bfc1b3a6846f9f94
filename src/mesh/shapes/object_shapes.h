// SPDX-License-Identifier: Apache-2.0
// Exact surfaces of the objects of daily life and therapy. Lengths that are no parameters of their makers are
// defined here, in proportion to the parameters. Internal to src/mesh and its tests.
#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "mesh/shapes/spun_solid.h"

namespace phalanx::mesh {

// Solids around z, from -length/2 to length/2. Fractions are of the diameter unless stated.

inline constexpr double kBottleFoot = 0.08;      ///< fillet of the bottom's edge
inline constexpr double kBottleShoulder = 0.40;  ///< height
inline constexpr double kBottleNeck = 0.42;      ///< diameter
inline constexpr double kBottleNeckSeen = 0.05;  ///< height between shoulder and cap
inline constexpr double kBottleCap = 0.48;       ///< diameter
inline constexpr double kBottleCapHeight = 0.22;
inline constexpr double kBottleCapChamfer = 0.03;
[[nodiscard]] SpunShape bottle_shape(double diameter, double length);

inline constexpr double kCupFoot = 0.7;     ///< diameter of the bottom's edge
inline constexpr double kCupWall = 0.04;    ///< thickness, of the smaller of diameter and length
inline constexpr double kCupFloor = 0.06;   ///< thickness, likewise
inline constexpr double kCupFillet = 0.05;  ///< outer bottom edge, likewise; the inner one is twice it
[[nodiscard]] SpunShape cup_shape(double diameter, double length);

inline constexpr double kPenTip = 0.10;  ///< diameter of the round tip
inline constexpr double kPenCone = 1.5;  ///< length of the cone
inline constexpr double kPenEnd = 0.25;  ///< fillet of the upper end
[[nodiscard]] SpunShape pen_shape(double diameter, double length);

inline constexpr double kPegChamfer = 0.12;    ///< at 45 degrees
inline constexpr double kPegHeadLength = 0.4;  ///< of the length
[[nodiscard]] SpunShape peg_shape(double diameter, double length, double head_diameter);

inline constexpr double kJarFoot = 0.08;      ///< fillet of the bottom's edge
inline constexpr double kJarShoulder = 0.12;  ///< height
inline constexpr double kJarNeck = 0.90;      ///< diameter, relative to the lid's
inline constexpr double kJarNeckSeen = 0.04;  ///< height between shoulder and lid
inline constexpr double kJarLidHeight = 0.22;
inline constexpr double kJarLidFillet = 0.03;
[[nodiscard]] SpunShape jar_shape(double diameter, double length, double lid_diameter);

inline constexpr double kTapStem = 0.40;        ///< diameter of the stem below the head
inline constexpr double kTapStemLength = 0.40;  ///< of the length
inline constexpr double kTapFillet = 0.12;      ///< the head's edges: of the length, at most kTapFilletMost
inline constexpr double kTapFilletMost = 0.2;   ///< of the radius
inline constexpr double kTapDome = 0.08;        ///< of the length: height of the top's bulge
inline constexpr double kTapLobes = 0.30;       ///< depth of the hollows between the lobes, of the radius
[[nodiscard]] SpunShape tap_handle_shape(double diameter, double length);

// The key, lying flat. Fractions of the bow's diameter unless stated.

inline constexpr double kKeyHole = 0.42;   ///< diameter of the hole in the bow
inline constexpr double kKeyBlade = 0.38;  ///< breadth of the blade
/// Point of the blade's lower or upper edge: position as a share of its length from bow to tip, and depth of
/// the cut as a share of its breadth.
struct KeyCut {
  double along;
  double depth;
};
[[nodiscard]] std::span<const KeyCut> key_lower_edge();
[[nodiscard]] std::span<const KeyCut> key_upper_edge();

// Bumps of the spiky ball: at the poles, 12 around the equator and each latitude of 30 degrees, 6 around each
// of 60 degrees.

inline constexpr int kBallBumps = 50;
inline constexpr double kBallBumpAngle = 11.0 * std::numbers::pi / 180.0;  ///< from a bump's top to its foot
/// Returns the distance of the surface from the centre in the direction `u` (unit vector). It is diameter/2
/// at a bump's top, and less by `bump` outside the bumps. With s the angle to the nearest top, the bump's
/// height is scaled by (1 - (s / kBallBumpAngle)^2)^2.
[[nodiscard]] double ball_radius(double diameter, double bump, const Vec3& u);

// The putty bar.

inline constexpr double kBarFillet = 0.3;  ///< radius of edges and corners, of the smallest length

}  // namespace phalanx::mesh
