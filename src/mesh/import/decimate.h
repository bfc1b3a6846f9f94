// SPDX-License-Identifier: Apache-2.0
// Decimation based on meshoptimizer, the only file that includes its header.
#pragma once

#include <cstddef>
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

/// Simplifies a mesh for a picture, to at most twice `triangles`. Collapses edges; the remaining vertices do
/// not move. A mesh of many loose parts keeps too many triangles so. Then the vertices in each cell of a grid
/// become one, which may open a solid and drop thin parts.
/// @param mesh  repaired
/// @returns the mesh itself if it is small enough; no triangles if the grid resolves none
[[nodiscard]] TriangleMesh picture_of(const TriangleMesh& mesh, std::size_t triangles);

}  // namespace phalanx::mesh
