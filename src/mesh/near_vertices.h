// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

struct Mended {
  std::size_t count = 0;
  double moved = 0.0;    ///< largest distance by which the surface moved [m]
  bool complete = true;  ///< false: more was in each other's way than is looked at
};

/// Closes cracks: a vertex on an open edge that is within `tolerance` [m] of another such vertex that
/// comes first by x, y, z moves there. Vertices inside a surface are never touched, so that a closed mesh
/// stays as it is. Every vertex moves at most once and at most `tolerance`. Triangles that lose their area
/// are dropped if one that stays covers them; else their corners stay apart. O(n log n), deterministic.
Mended merge_near_vertices(TriangleMesh& mesh, double tolerance);

}  // namespace phalanx::mesh
