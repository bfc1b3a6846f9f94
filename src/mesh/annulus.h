// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "mesh/mesh_builder.h"

namespace phalanx::mesh {

/// A closed curve of vertices with their places in a parameter plane, counter-clockwise there.
struct PlaneLoop {
  Ring ring;
  std::vector<Eigen::Vector2d> at;
};

struct AnnulusFilling {
  std::vector<Triangle> triangles;
  double thinnest = 0.0;  ///< 1 if all are equilateral, more the thinner the worst is
};

/// Fills the area between two loops with triangles, each on an edge of one loop and a vertex of the other.
/// Among all such fillings whose triangles are counter-clockwise in the plane (which makes them a partition
/// of the area) the one with the best shapes in space; nullopt if there is none.
[[nodiscard]] std::optional<AnnulusFilling> fill_annulus(const MeshBuilder& builder, const PlaneLoop& outer,
                                                         const PlaneLoop& inner);

}  // namespace phalanx::mesh
