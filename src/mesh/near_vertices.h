// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "mesh/spot.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

struct Mended {
  std::size_t count = 0;
  bool complete = true;  ///< false: more was in each other's way than is looked at
  Spot worst = {};       ///< the widest gap; for flat triangles the longest edge, and its middle
};

/// How far the repair may move the surface, and how far it has. Every point of the mesh as it is now is
/// within the largest `spent` of its triangle's corners of where it came from, and the other way round; no
/// step is made that would take a corner's above `most`.
struct Allowance {
  double reach;               ///< what one step may move [m]
  double most;                ///< what all together may [m]
  std::vector<double> spent;  ///< by vertex [m]
  bool held_back = false;     ///< a step was not allowed

  [[nodiscard]] bool allows(double moved) noexcept {
    if (!(moved <= most)) held_back = true;
    return moved <= most;
  }
};

/// Closes cracks: a vertex on an open edge that is within `reach` of another such vertex that comes first by
/// x, y, z moves there. Vertices inside a surface are never touched, so that a closed mesh stays as it is.
/// Every vertex moves at most once. Triangles that lose their area are dropped if one that stays covers them;
/// else their corners stay apart. O(n log n), deterministic.
Mended merge_near_vertices(TriangleMesh& mesh, Allowance& allowance);

}  // namespace phalanx::mesh
