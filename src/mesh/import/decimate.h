// SPDX-License-Identifier: Apache-2.0
// Decimation based on meshoptimizer, the only file that includes its header.
#pragma once

#include <string>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Collapses edges, in order of increasing error, until about `triangles` are left. The remaining vertices do
/// not move. Open edges keep their place, so that holes and sheets keep their outline, unless more than a
/// tenth too many triangles would remain.
/// @param mesh  repaired
/// @throws std::invalid_argument starting with `origin` if the target destroys the mesh: it is below 4,
/// would open a closed solid, or would shrink an extent by more than a tenth. Also if more than twice
/// the target remains.
[[nodiscard]] TriangleMesh decimate(const TriangleMesh& mesh, int triangles, const std::string& origin);

}  // namespace phalanx::mesh
