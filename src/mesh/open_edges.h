// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "mesh/edge_table.h"

namespace phalanx::mesh {

/// The edges of one triangle only, joined to lines where they meet: the rims of holes and sheets.
struct OpenEdges {
  std::size_t edges = 0;
  std::size_t lines = 0;  ///< connected; several that touch in a vertex are one
  double longest = 0.0;   ///< length of the longest line [m]
  double widest = 0.0;    ///< largest extent of a line's box [m]
};
[[nodiscard]] OpenEdges find_open_edges(const TriangleMesh& mesh, const EdgeTable& edges);

/// How many edges have three or more triangles.
[[nodiscard]] std::size_t count_crowded_edges(const EdgeTable& edges);

}  // namespace phalanx::mesh
