// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/repair/edge_table.h"
#include "mesh/repair/triangle_measures.h"

namespace phalanx::mesh {

/// Patches: triangles connected by edges of exactly two triangles.
struct Patches {
  std::vector<std::uint32_t> of;  ///< each triangle's patch
  std::vector<bool> two_sided;    ///< per patch: true if it has two sides (false: a Moebius strip)
  std::size_t turned = 0;         ///< number of triangles wound against the rest of their patch
  MeasuredFaces turned_faces;     ///< measures of these triangles
};

/// Finds the patches and gives each a consistent winding: that of the majority of its triangles or, in a tie,
/// of its first. A patch without two sides keeps the file's windings. If triangles were turned, `edges` no
/// longer fits the mesh. O(n log n), deterministic.
[[nodiscard]] Patches orient_patches(TriangleMesh& mesh, const EdgeTable& edges);

/// Vertices in which several fans of triangles meet, but no edge of three or more triangles.
struct PinchVertices {
  std::size_t count = 0;
  Spot longest;  ///< longest edge ending in one [m], and that vertex
};
[[nodiscard]] PinchVertices find_pinch_vertices(const TriangleMesh& mesh, const EdgeTable& edges);

}  // namespace phalanx::mesh
