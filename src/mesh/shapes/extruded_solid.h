// SPDX-License-Identifier: Apache-2.0
// Extrusion of a triangulated flat area to a plate. Internal to src/mesh.
#pragma once

#include <vector>

#include "mesh/shapes/mesh_builder.h"

namespace phalanx::mesh {

/// Triangulated flat area.
struct PlaneArea {
  std::vector<Eigen::Vector2d> points;
  std::vector<Triangle> triangles;  ///< counter-clockwise
  std::vector<Ring> edges;          ///< indices of points: outer edge counter-clockwise, holes clockwise
};

/// Makes the plate from z = -thickness/2 to thickness/2, its walls cut into `bands`.
[[nodiscard]] TriangleMesh extrude(const PlaneArea& area, double thickness, int bands);

}  // namespace phalanx::mesh
