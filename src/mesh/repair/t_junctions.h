// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/repair/near_vertices.h"

namespace phalanx::mesh {

/// Splits open edges at vertices of other triangles' open edges. Such a vertex is within `reach` of the edge,
/// and farther than `reach` from both its ends. The triangle becomes a fan over the same area. So a crack
/// between a long edge and several short ones closes without a gap.
/// @returns the number of vertices inserted, and the largest distance of one from its edge
Mended split_t_junctions(TriangleMesh& mesh, Allowance& allowance);

}  // namespace phalanx::mesh
