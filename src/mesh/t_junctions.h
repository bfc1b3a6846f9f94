// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/near_vertices.h"

namespace phalanx::mesh {

/// Splits open edges at the vertices of other triangles' open edges that lie on them, within `reach`
/// and farther than it from both ends: the triangle becomes a fan over the same area. A crack between a long
/// edge and several short ones closes without a gap.
/// @returns how many vertices were taken in, and the largest distance of one from its edge
Mended split_t_junctions(TriangleMesh& mesh, Allowance& allowance);

}  // namespace phalanx::mesh
