// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "mesh/shapes/mesh_builder.h"

namespace phalanx::mesh {

/// Closed curve of vertices with their places in a parameter plane, counter-clockwise there.
struct PlaneLoop {
  Ring ring;
  std::vector<Eigen::Vector2d> at;
};

/// Triangles that fill an annulus.
struct AnnulusFilling {
  std::vector<Triangle> triangles;
  double thinnest = 0.0;  ///< thinness of the worst triangle: 1 if equilateral, more if thinner
};

/// Fills the area between two loops with triangles, each on an edge of one loop and a vertex of the other.
/// Candidates are all fillings with triangles that are counter-clockwise in the plane, so that they partition
/// the area. Returns the one with the best shapes in space, or nullopt if there is none.
[[nodiscard]] std::optional<AnnulusFilling> fill_annulus(const MeshBuilder& builder, const PlaneLoop& outer,
                                                         const PlaneLoop& inner);

}  // namespace phalanx::mesh
