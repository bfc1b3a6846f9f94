// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "phalanx/core/math.h"

namespace phalanx {

/// The three corners of a triangle [m].
using Corners = std::array<Vec3, 3>;

/// The closest points of two triangles.
struct TriangleDistance {
  double squared = 0.0;      ///< [m^2]; 0 if the triangles touch or cross
  Vec3 on_a = Vec3::Zero();  ///< [m]
  Vec3 on_b = Vec3::Zero();  ///< [m]
};

/// Exact distance of two triangles: the least over 9 pairs of edges and 6 pairs of corner and face, or 0 if
/// an edge of one pierces the other. Triangles may be degenerate (a segment, a point). Any corners that are
/// finite give a finite result. Where the minimum is not unique, the first pair in a fixed order gives the
/// points. Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] TriangleDistance triangle_distance(const Corners& a, const Corners& b) noexcept;

/// Where two triangles are at nearly their least distance: a point, a line or, for parallel faces, an area.
struct TiedRegion {
  double weight =
      0.0;  ///< area of the region widened by `limit`'s excess e:  A + e L + pi e^2 [m^2] (L: perimeter)
  Vec3 on_a = Vec3::Zero();  ///< mean over the widened region, on a [m]
  Vec3 on_b = Vec3::Zero();  ///< the same on b [m]
};

/// The region of the points of `a` that are within `least + excess` of `b`, by its corners: all pairs of
/// features at such a distance.
/// @param closest  triangle_distance(a, b)
/// @param limit    greatest distance that counts [m], >= closest distance
/// @param excess   e > 0, the width that makes lines and points count beside areas [m]
/// Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] TiedRegion tied_region(const Corners& a, const Corners& b, const TriangleDistance& closest,
                                     double limit, double excess) noexcept;

/// Barycentric coordinates of p's foot on the plane of triangle `t`, those of its second and third corner
/// clamped to 0 .. 1, that of the first to >= 0, and all divided by their sum: of a point of t, the nearest
/// to p only if the foot lies in t. A triangle without area: 1/3 each. Real-time.
[[nodiscard]] Vec3 barycentric(const Corners& t, const Vec3& p) noexcept;

}  // namespace phalanx
