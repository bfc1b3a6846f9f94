// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/measured_faces.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// What weld() left out.
struct WeldCounts {
  std::size_t unreferenced = 0;  ///< vertices that no triangle used
  std::size_t duplicates = 0;    ///< vertices that another one at the same place now stands for
  std::size_t degenerate = 0;    ///< triangles two of whose corners fell on one vertex
  Spot longest_degenerate;       ///< longest edge of one and its middle, in the soup's numbers
};

/// Makes vertices at exactly equal positions one, in the order of their first use by a triangle; drops
/// vertices that no triangle uses and triangles two of whose corners fall on one vertex (they have no area).
/// Coordinates must not be NaN. O(n log n), deterministic.
[[nodiscard]] TriangleMesh weld(const TriangleMesh& soup, WeldCounts* counts = nullptr);

/// Renames every vertex v to `to[v]`, drops triangles that this leaves without three corners, and then
/// vertices that no triangle uses, keeping both in order.
/// @param values  one for each vertex, if not null: those of the vertices that stay are kept
/// @returns how many triangles were dropped
std::size_t rename_vertices(TriangleMesh& mesh, const std::vector<std::int32_t>& to,
                            std::vector<double>* values = nullptr);

/// Drops triangles that have the same three corners as an earlier one, in either winding.
/// @param dropped  if not null: those are added to it
/// @returns how many
std::size_t drop_duplicate_faces(TriangleMesh& mesh, MeasuredFaces* dropped = nullptr);

}  // namespace phalanx::mesh
