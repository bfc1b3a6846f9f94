// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "phalanx/mesh/mesh_report.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

struct ImportOptions {
  double size = 0.0;  ///< if > 0, the mesh is scaled about its bounding box's centre so that its largest
                      ///< extent is this [m], and the centre moved to the origin; if 0, it stays where it is
  double unit = 1.0;  ///< metres per unit of the file's numbers, for size 0
  int triangles = 0;  ///< if > 0, the mesh is decimated to about this many
  /// If > 0, a file with more triangles is refused right after it has been read: checking and repairing run
  /// in this process, and take as long as the mesh is large.
  std::size_t most_triangles = 0;
};

struct ImportedMesh {
  TriangleMesh mesh;
  MeshReport report;
};

/// Reads a triangle mesh file (.obj .3ds .stl .ply .glb; upper or lower case) through Assimp and brings it
/// into order (docs/meshes.md): every mesh of the file with its node's transform, merged, in the file's
/// order. Polygons are cut into triangles; points, lines and vertices that no triangle uses are left out;
/// exactly equal positions become one vertex (an STL's corners). Degenerate and duplicate triangles go,
/// cracks and T-junctions are closed, windings made to agree and closed solids turned outward. No point of
/// the surface moves by more than 1 um (and 1e-5 of the largest extent). Holes stay. Axes stay as the file
/// has them (.glb: y up by its standard). Positions have Assimp's single precision. Other files that the file
/// refers to are not opened.
/// @returns the mesh: at least one triangle, finite vertices, valid indices, not necessarily closed; and what
/// was found, repaired and left
/// @throws std::invalid_argument whose message names the file, the place, the value and the remedy: missing
/// file, unreadable, damaged or unknown format, no triangle or none with an area, NaN or infinite vertex, a
/// face that names a vertex which does not exist, an option that is negative or not finite, extents of 10 km
/// or more, numbers so large that single precision is coarser than 50 um at the object, a number of triangles
/// that the mesh cannot be decimated to, more triangles than ImportOptions::most_triangles.
/// Assimp runs in a forked child process with limits on time and memory: no file makes the program crash or
/// hang. POSIX only. Set-up only: forks, allocates, throws.
[[nodiscard]] ImportedMesh import_and_check(const std::filesystem::path& file,
                                            const ImportOptions& options = {});

/// The same from memory; `format` is the extension without the dot. For fuzzing and uploads.
/// @throws std::invalid_argument as import_and_check(), the message starting with "mesh in memory". Set-up
/// only: forks, allocates, throws.
[[nodiscard]] ImportedMesh import_and_check_from_memory(const void* data, std::size_t bytes,
                                                        const std::string& format,
                                                        const ImportOptions& options = {});

/// The mesh alone, in metres, in the file's axes.
/// @param size  ImportOptions::size [m]
/// @throws std::invalid_argument as import_and_check(). Set-up only: forks, allocates, throws.
[[nodiscard]] TriangleMesh import_mesh(const std::filesystem::path& file, double size);

/// import_mesh() from memory; `format` is the extension without the dot.
/// @throws std::invalid_argument as import_and_check_from_memory(). Set-up only: forks, allocates, throws.
[[nodiscard]] TriangleMesh import_mesh_from_memory(const void* data, std::size_t bytes,
                                                   const std::string& format, double size);

/// Writes a Wavefront OBJ, metres, one object, 17 significant digits (the doubles come back bit by bit).
/// @throws std::runtime_error naming the file if it cannot be written completely. Set-up only.
void write_obj(const TriangleMesh& mesh, const std::filesystem::path& file, const std::string& object_name);

}  // namespace phalanx
