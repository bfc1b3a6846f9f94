// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "phalanx/core/math.h"

namespace phalanx {

/// Corners of a triangle [m].
using Corners = std::array<Vec3, 3>;

/// Closest points of two triangles.
struct TriangleDistance {
  double squared = 0.0;      ///< [m^2]; 0 if the triangles touch or cross
  Vec3 on_a = Vec3::Zero();  ///< [m]
  Vec3 on_b = Vec3::Zero();  ///< [m]
};

/// Returns the exact distance of two triangles: the least over 9 pairs of edges and 6 pairs of corner and
/// face, or 0 if an edge of one pierces the other. Triangles may be degenerate (a segment, a point). Finite
/// corners give a finite result. Where the minimum is not unique, the first pair in a fixed order gives the
/// points. Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] TriangleDistance triangle_distance(const Corners& a, const Corners& b) noexcept;

/// Region where two triangles are at nearly their least distance: a point, a line or, for parallel
/// faces, an area.
struct TiedRegion {
  /// Area of the region widened by the excess e: A + e L + pi e^2 [m^2], with area A and perimeter L.
  double weight = 0.0;
  Vec3 on_a = Vec3::Zero();  ///< mean over the widened region, on a [m]
  Vec3 on_b = Vec3::Zero();  ///< the same on b [m]
};

/// Returns the region of the points of `a` that are within `least + excess` of `b`. Its corners are all pairs
/// of features at such a distance.
/// @param closest  triangle_distance(a, b)
/// @param limit    greatest distance that counts [m], >= closest distance
/// @param excess   e > 0, the width that gives lines and points a weight beside areas [m]
/// Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] TiedRegion tied_region(const Corners& a, const Corners& b, const TriangleDistance& closest,
                                     double limit, double excess) noexcept;

/// Returns the barycentric coordinates of p's foot on the plane of triangle `t`, limited to t. The
/// second and third are clamped to 0 .. 1, the first to >= 0, and all are divided by their sum. They
/// denote a point of t, which is the nearest to p only if the foot lies in t. A triangle without area
/// gives 1/3 each. Real-time.
[[nodiscard]] Vec3 barycentric(const Corners& t, const Vec3& p) noexcept;

}  // namespace phalanx
