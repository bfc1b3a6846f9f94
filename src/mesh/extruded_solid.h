// SPDX-License-Identifier: Apache-2.0
// A flat area, given as triangles in the plane, drawn out to a plate. Internal to src/mesh.
#pragma once

#include <vector>

#include "mesh/mesh_builder.h"

namespace phalanx::mesh {

struct PlaneArea {
  std::vector<Eigen::Vector2d> points;
  std::vector<Triangle> triangles;  ///< counter-clockwise
  std::vector<Ring> edges;          ///< indices of points: the outer edge counter-clockwise, holes clockwise
};

/// The plate from z = -thickness/2 to thickness/2, its walls cut into `bands`.
[[nodiscard]] TriangleMesh extrude(const PlaneArea& area, double thickness, int bands);

}  // namespace phalanx::mesh
