// SPDX-License-Identifier: Apache-2.0
// The one file that knows meshoptimizer.
#pragma once

#include <string>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Collapses edges, those that matter least first, until about `triangles` are left; the vertices that stay
/// do not move. Open edges keep their place, so that holes and sheets keep their outline, unless that leaves
/// more than a tenth too many.
/// @param mesh  repaired
/// @throws std::invalid_argument starting with `origin` if the target destroys the mesh: fewer than 4
/// triangles, a closed solid that would open, an extent that would shrink by more than a tenth, or more
/// triangles than twice the target left
[[nodiscard]] TriangleMesh decimate(const TriangleMesh& mesh, int triangles, const std::string& origin);

}  // namespace phalanx::mesh
