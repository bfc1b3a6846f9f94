// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// For every triangle, the unit normal at its three corners [-]: the angle-weighted mean over those triangles
/// around the vertex that can be reached from it through smooth edges (shared by two triangles that run
/// through it in opposite directions, angle between their normals below `crease_angle`). Across a crease the
/// normals stay apart. A degenerate triangle takes its neighbours' normal, or unit z if it has none.
/// @param mesh          valid indices, finite vertices; need not be closed
/// @param crease_angle  [rad], 0 (all flat) to pi
/// @throws std::invalid_argument for an invalid mesh or angle. O(n log n), deterministic; set-up only.
[[nodiscard]] std::vector<std::array<Vec3, 3>> corner_normals(const TriangleMesh& mesh, double crease_angle);

}  // namespace phalanx
