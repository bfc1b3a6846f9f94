// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/repair/triangle_measures.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Numbers of elements that weld() removed.
struct WeldCounts {
  std::size_t unreferenced = 0;  ///< vertices that no triangle used
  std::size_t duplicates = 0;    ///< vertices merged into another one at the same place
  std::size_t degenerate = 0;    ///< triangles with two corners on one vertex
  Spot longest_degenerate;       ///< longest edge of one and its middle, in the soup's units
};

/// Merges vertices at exactly equal positions, in the order of their first use by a triangle. Drops unused
/// vertices, and triangles with two corners on one vertex (they have no area). O(n log n), deterministic.
/// @pre no coordinate is NaN
[[nodiscard]] TriangleMesh weld(const TriangleMesh& soup, WeldCounts* counts = nullptr);

/// Renumbers every vertex v to `to[v]`. Then drops triangles with fewer than three different corners, and
/// unused vertices. Both keep their order.
/// @param values  if not null, one value per vertex; those of remaining vertices are kept
/// @returns the number of dropped triangles
std::size_t rename_vertices(TriangleMesh& mesh, const std::vector<std::int32_t>& to,
                            std::vector<double>* values = nullptr);

/// Drops triangles that have the same three corners as an earlier one, in either winding.
/// @param dropped  if not null, the dropped triangles are added to it
/// @returns the number of dropped triangles
std::size_t drop_duplicate_faces(TriangleMesh& mesh, MeasuredFaces* dropped = nullptr);

}  // namespace phalanx::mesh
