// SPDX-License-Identifier: Apache-2.0
// Reader based on Assimp, the only file that includes its headers.
#pragma once

#include <cstddef>
#include <string>

#include "phalanx/mesh/isolation/isolated.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Reads all triangles of all meshes, each mesh with the transform of the file's nodes. Polygons are cut into
/// triangles. Points and lines are dropped, and nothing is welded. Only the given bytes are read; other files
/// to which they refer are not opened.
/// @param format  "obj", "3ds", "stl", "ply" or "glb"
/// @throws std::invalid_argument, starting with `origin`, if Assimp refuses the bytes. Also if a vertex is
/// not finite, or a face names a missing vertex.
/// On damaged bytes Assimp itself may crash, abort or loop: call this function through run_isolated().
[[nodiscard]] TriangleMesh read_with_assimp(const void* data, std::size_t bytes, const std::string& format,
                                            const std::string& origin);

/// Returns the limits of read_with_assimp() for a number of bytes. Processor time: 2 s, and 1 s for each 10^6
/// bytes. Memory: 256 MiB, and 16 times the bytes. Waiting: 60 s, and 10 s for each 10^6 bytes.
/// Assimp reads some 10 MB/s and needs up to 7 times a file's size of memory (docs/meshes.md). The limits
/// also stop a file that claims a thousand million vertices.
[[nodiscard]] IsolationLimits reading_limits(std::size_t bytes) noexcept;

}  // namespace phalanx::mesh
