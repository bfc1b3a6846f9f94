// SPDX-License-Identifier: Apache-2.0
// The one file that knows Assimp.
#pragma once

#include <cstddef>
#include <string>

#include "phalanx/mesh/isolated.h"
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

/// What read_with_assimp() may use for so many bytes: 2 s of processor time and 1 s for each 10^6 bytes, 256
/// MiB and 16 times the bytes of memory, 60 s and 10 s for each 10^6 bytes of waiting. Assimp reads some 10
/// MB/s and takes up to 7 times a file's size of memory (docs/meshes.md); a file that claims a thousand
/// million vertices gets no farther than this.
[[nodiscard]] IsolationLimits reading_limits(std::size_t bytes) noexcept;

}  // namespace phalanx::mesh
