// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// Reads a triangle mesh file (.obj .3ds .stl .ply .glb; upper or lower case) through Assimp: every mesh of
/// the file with its node's transform, merged, in the file's order. Polygons are cut into triangles; points,
/// lines and vertices that no triangle uses are left out; exactly equal positions become one vertex (an STL's
/// corners), and triangles of which that leaves two corners are dropped. Axes stay as the file has them
/// (.glb: y up by its standard). Positions have Assimp's single precision. Other files that the file refers
/// to are not opened.
/// @param file    path of the file
/// @param size    if > 0, the mesh is scaled about its bounding box's centre so that its largest extent is
/// `size` [m], and the
///                centre moved to the origin; if 0, the file's numbers are metres and stay where they are
/// @returns at least one triangle, finite vertices, valid indices; not necessarily closed
/// @throws std::invalid_argument whose message names the file, the place, the value and the remedy: missing
/// file, unreadable, damaged or unknown
///         format, no triangle, NaN or infinite vertex, a face that names a vertex which does not exist, size
///         negative or not finite.
/// Assimp runs in a forked child process with limits on time and memory: no file makes the program crash or
/// hang. POSIX only. Set-up only: forks, allocates, throws.
[[nodiscard]] TriangleMesh import_mesh(const std::filesystem::path& file, double size);

/// The same from memory; `format` is the extension without the dot. For fuzzing and uploads.
[[nodiscard]] TriangleMesh import_mesh_from_memory(const void* data, std::size_t bytes,
                                                   const std::string& format, double size);

/// Writes a Wavefront OBJ, metres, one object, 17 significant digits (the doubles come back bit by bit).
/// @throws std::runtime_error naming the file if it cannot be written completely. Set-up only.
void write_obj(const TriangleMesh& mesh, const std::filesystem::path& file, const std::string& object_name);

}  // namespace phalanx
