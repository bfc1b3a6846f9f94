// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "mesh/shells.h"
#include "mesh/spot.h"

namespace phalanx::mesh {

struct SelfIntersections {
  std::size_t pairs = 0;      ///< of triangles that cross
  ShellPairs between_shells;  ///< different shells that cross
  Spot longest;               ///< the longest line of crossing of one pair [m], and its middle
  bool complete = true;       ///< false: more pairs lie near each other than are looked at
};

/// Pairs of triangles of which an edge of one goes through the other, its ends farther than `tolerance` [m]
/// from the other's plane on either side. Triangles that share an edge do not cross; of two that share a
/// vertex, the opposite edges count. Overlap within one plane is not looked for. O(n log n) for an ordinary
/// mesh.
[[nodiscard]] SelfIntersections find_self_intersections(const TriangleMesh& mesh, const Shells& shells,
                                                        const BoxTree& tree, double tolerance);

}  // namespace phalanx::mesh
