// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "phalanx/core/math.h"
#include "phalanx/core/random.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// A direction, and the object's half extent along it.
struct ShapeAxis {
  Vec3 axis = Vec3::UnitX();  ///< unit vector
  double half = 0.0;          ///< [m]
};

/// Centre and axes of an object's surface.
struct ObjectShape {
  Vec3 centre = Vec3::Zero();  ///< of the box along the axes [m]
  /// Orthonormal principal axes of the surface, of equal density; right-handed, by descending half extent.
  std::array<Vec3, 3> axis = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  std::array<double, 3> half{};  ///< half extents along them [m]
  /// Along normals of the surface, drawn with equal density: the principal axes of a cube are any.
  std::vector<ShapeAxis> normal;
  double radius = 0.0;  ///< greatest distance of a vertex from the centre [m]
};
/// @pre at least one triangle
[[nodiscard]] ObjectShape shape_of(const TriangleMesh& mesh);

/// Point of a surface with its outward unit normal.
struct SurfacePoint {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
};
/// Draws points of equal density on the surface. @pre at least one triangle
[[nodiscard]] std::vector<SurfacePoint> surface_points(const TriangleMesh& mesh, int count, Random& random);

}  // namespace phalanx
