// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "mesh/repair/shells.h"
#include "mesh/repair/triangle_measures.h"

namespace phalanx::mesh {

/// Pairs of triangles that cross.
struct SelfIntersections {
  std::size_t pairs = 0;      ///< number of pairs
  ShellPairs between_shells;  ///< pairs of shells that cross
  Spot longest;               ///< longest line of crossing of one pair [m], and its middle
  bool complete = true;       ///< false: more pairs are near each other than are examined
};

/// Finds pairs of triangles that cross. An edge of one must pass through the other, and its ends must be
/// farther than `tolerance` [m] from the other's plane on either side. Triangles that share an edge do not
/// cross. If two share a vertex, the opposite edges count. Overlap within one plane is not searched. O(n log
/// n) for an ordinary mesh.
[[nodiscard]] SelfIntersections find_self_intersections(const TriangleMesh& mesh, const Shells& shells,
                                                        const BoxTree& tree, double tolerance);

}  // namespace phalanx::mesh
