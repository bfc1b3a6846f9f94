// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/edge_table.h"
#include "mesh/measured_faces.h"

namespace phalanx::mesh {

/// Triangles that edges of exactly two triangles hold together.
struct Patches {
  std::vector<std::uint32_t> of;  ///< each triangle's patch
  std::vector<bool> two_sided;    ///< each patch: it has two sides (false: a Moebius strip)
  std::size_t turned = 0;         ///< triangles that wound against the rest of their patch
  MeasuredFaces turned_faces;     ///< the same
};

/// Finds the patches and makes each wind one way: the way that more of its triangles do (a tie: the first
/// triangle's). A patch that has no two sides keeps the file's windings. `edges` no longer fits the mesh if
/// triangles were turned. O(n log n), deterministic.
[[nodiscard]] Patches orient_patches(TriangleMesh& mesh, const EdgeTable& edges);

/// Vertices off any edge of three or more triangles, in which several fans of triangles meet.
struct PinchVertices {
  std::size_t count = 0;
  Spot longest;  ///< the longest edge that ends in one [m], and that vertex
};
[[nodiscard]] PinchVertices find_pinch_vertices(const TriangleMesh& mesh, const EdgeTable& edges);

}  // namespace phalanx::mesh
