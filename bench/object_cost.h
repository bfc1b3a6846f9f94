// SPDX-License-Identifier: Apache-2.0
// What an object costs before the first step: memory and time.
#pragma once

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::bench {

struct ObjectCost {
  int triangles = 0;
  double bytes_a_triangle = 0.0;       ///< of heap that the finished ObjectModel holds, its mesh included
  double mesh_bytes_a_triangle = 0.0;  ///< of them, the indexed arrays
  double build_s = 0.0;                ///< from indexed arrays to the finished model, the least of three [s]
};

/// Builds an ObjectModel of the mesh three times. Set-up only.
[[nodiscard]] ObjectCost object_cost(const TriangleMesh& mesh);

}  // namespace phalanx::bench
