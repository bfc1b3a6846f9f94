// SPDX-License-Identifier: Apache-2.0
// Import of a mesh file: reading in an isolated process, repair, report and decimation. See docs/meshes.md.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "phalanx/mesh/mesh_report.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// Scale and size of an imported mesh.
struct ImportOptions {
  /// If > 0, the largest extent [m]: the mesh is scaled about its bounding box's centre, and the centre moves
  /// to the origin. If 0, the mesh stays where it is.
  double size = 0.0;
  double unit = 1.0;  ///< metres per unit of the file's numbers, used if size is 0
  int triangles = 0;  ///< if > 0, the mesh is decimated to about this number of triangles
  /// If > 0, a file with more triangles is refused right after reading. Its check and repair would run in
  /// this process, for a time that grows with the mesh.
  std::size_t most_triangles = 0;
};

/// Mesh with the report on its import.
struct ImportedMesh {
  TriangleMesh mesh;
  MeshReport report;
};

/// Reads a triangle mesh file (.obj .3ds .stl .ply .glb; upper or lower case) through Assimp and
/// repairs it (docs/meshes.md).
/// - All meshes of the file are merged in the file's order, each with its node's transform.
/// - Polygons are cut into triangles. Points, lines and unused vertices are dropped. Exactly equal positions
///   become one vertex (an STL's corners).
/// - Degenerate and duplicate triangles are dropped, cracks and T-junctions closed. Windings are made
///   consistent, and closed solids turned outward.
/// - No point of the surface moves by more than 1 um, or 1e-5 of the largest extent if that is
///   less. Holes stay.
/// - Axes stay as in the file (.glb: y up by its standard). Positions have Assimp's single precision. Other
///   files to which the file refers are not opened.
/// @returns the mesh, with at least one triangle, finite vertices and valid indices, not necessarily closed;
/// and what was found, repaired and left
/// @throws std::invalid_argument naming the file, the place, the value and the remedy, if
/// - the file is missing, unreadable, damaged or of an unknown format;
/// - it has no triangle, or none with an area;
/// - a vertex is NaN or infinite, or a face names a missing vertex;
/// - an option is negative or not finite;
/// - the extents are 10 km or more, or single precision is coarser than 50 um at the object;
/// - there are more triangles than ImportOptions::most_triangles, or the mesh cannot be decimated to
///   the requested number.
/// Assimp runs in a forked child process with limits on time and memory, so that no file makes the program
/// crash or hang. POSIX only. Set-up only: forks, allocates, throws.
[[nodiscard]] ImportedMesh import_and_check(const std::filesystem::path& file,
                                            const ImportOptions& options = {});

/// Imports a mesh from memory, for fuzzing and uploads; `format` is the extension without the dot.
/// @throws std::invalid_argument as import_and_check(); the message starts with "mesh in memory"
/// Set-up only: forks, allocates, throws.
[[nodiscard]] ImportedMesh import_and_check_from_memory(const void* data, std::size_t bytes,
                                                        const std::string& format,
                                                        const ImportOptions& options = {});

/// Writes a Wavefront OBJ with one object, in metres, with 17 significant digits (the doubles are restored
/// bit by bit). Set-up only.
/// @throws std::runtime_error naming the file if it cannot be written completely
void write_obj(const TriangleMesh& mesh, const std::filesystem::path& file, const std::string& object_name);

}  // namespace phalanx
