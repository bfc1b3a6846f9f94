// SPDX-License-Identifier: Apache-2.0
// Sizes and places on triangles, for a report's findings.
#pragma once

#include <cstddef>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Largest size found so far, with its place.
struct Spot {
  double size = -1.0;      ///< [m]; negative: nothing was found
  Vec3 at = Vec3::Zero();  ///< in the mesh's frame [m]

  [[nodiscard]] bool known() const noexcept { return size >= 0.0; }
  /// Keeps the larger size; of equal sizes the first.
  void take(double other, const Vec3& place) noexcept {
    if (!(other > size)) return;
    size = other;
    at = place;
  }
  void take(const Spot& other) noexcept {
    if (other.known()) take(other.size, other.at);
  }
};

inline const Vec3& corner_of(const TriangleMesh& mesh, const Triangle& t, std::size_t k) noexcept {
  return mesh.vertices[static_cast<std::size_t>(t[k])];
}

/// Returns the area of a triangle [m^2].
[[nodiscard]] inline double area_of(const TriangleMesh& mesh, const Triangle& t) noexcept {
  const Vec3& a = corner_of(mesh, t, 0);
  return 0.5 * (corner_of(mesh, t, 1) - a).cross(corner_of(mesh, t, 2) - a).norm();
}

[[nodiscard]] inline Vec3 centroid(const TriangleMesh& mesh, const Triangle& t) noexcept {
  return (corner_of(mesh, t, 0) + corner_of(mesh, t, 1) + corner_of(mesh, t, 2)) / 3.0;
}

/// Returns the length [m] and the middle of the triangle's longest edge.
[[nodiscard]] inline Spot longest_edge_of(const TriangleMesh& mesh, const Triangle& t) noexcept {
  Spot longest;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& a = corner_of(mesh, t, k);
    const Vec3& b = corner_of(mesh, t, (k + 1) % 3);
    longest.take((b - a).norm(), 0.5 * (a + b));
  }
  return longest;
}

/// Returns the point of a triangle nearest to p (Voronoi regions of corners, edges and face). The triangle
/// may be degenerate.
[[nodiscard]] Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

/// Total area and longest edge of a set of triangles.
struct MeasuredFaces {
  double area = 0.0;  ///< total area [m^2]
  Spot longest;       ///< length of the longest edge [m], and the centroid of its triangle

  void add(const TriangleMesh& mesh, const Triangle& t) noexcept {
    area += area_of(mesh, t);
    longest.take(longest_edge_of(mesh, t).size, centroid(mesh, t));
  }
};

}  // namespace phalanx::mesh
