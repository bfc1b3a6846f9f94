// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "mesh/repair/triangle_measures.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Result of a repair step.
struct Mended {
  std::size_t count = 0;
  bool complete = true;  ///< false: the search ended early, because too many elements were near each other
  Spot worst = {};       ///< widest gap; for flat triangles the longest edge; with its middle
};

/// Limit of the surface's displacement by the repair, and the displacement so far. Each point of the present
/// mesh is within the largest `spent` of its triangle's corners of its origin, and vice versa. A step is not
/// made if it would raise a corner's value above `most`.
struct Allowance {
  double reach;               ///< limit of one step [m]
  double most;                ///< limit of all steps together [m]
  std::vector<double> spent;  ///< displacement so far by vertex, at most [m]
  bool held_back = false;     ///< true if a step was not allowed

  /// @returns true if a total displacement of `moved` [m] is allowed. Otherwise sets held_back.
  [[nodiscard]] bool allows(double moved) noexcept {
    if (!(moved <= most)) held_back = true;
    return moved <= most;
  }
};

/// Closes cracks. If a vertex on an open edge is within `reach` of another such vertex that is earlier by x,
/// y, z, it moves there. Vertices inside a surface never move, so that a closed mesh stays unchanged. Every
/// vertex moves at most once. A triangle that loses its area is dropped if a remaining triangle covers it.
/// Otherwise its corners stay apart. O(n log n), deterministic.
Mended merge_near_vertices(TriangleMesh& mesh, Allowance& allowance);

}  // namespace phalanx::mesh
