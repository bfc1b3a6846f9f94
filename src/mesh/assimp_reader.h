// SPDX-License-Identifier: Apache-2.0
// The one file that knows Assimp.
#pragma once

#include <cstddef>
#include <string>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// All triangles of all meshes, each mesh where the file's nodes put it; polygons cut into triangles, points
/// and lines left out, nothing welded. Reads the given bytes only: whatever other file they refer to is not
/// opened.
/// @param format  "obj", "3ds", "stl", "ply" or "glb"
/// @throws std::invalid_argument, starting with `origin`, if Assimp refuses the bytes, a vertex is not finite
/// or a face names a vertex that
///         does not exist. On damaged bytes Assimp itself may also crash, abort or loop: call it through
///         run_isolated().
[[nodiscard]] TriangleMesh read_with_assimp(const void* data, std::size_t bytes, const std::string& format,
                                            const std::string& origin);

}  // namespace phalanx::mesh
