// SPDX-License-Identifier: Apache-2.0
// Repair of a triangle soup, as a file's reader returns it. repair() runs the steps in this order:
//   1. weld: equal positions become one vertex; unused vertices and collapsed triangles go.
//   2. Scale: the numbers become metres.
//   3. Cracks, up to eight rounds, until nothing changes: duplicate faces go (weld), vertices of open edges
//      that nearly coincide are merged (near_vertices), open edges are split at vertices on them
//      (t_junctions), and triangles without height are removed (flat_faces). All rounds share an Allowance of
//      displacement.
//   4. Orientation: every patch gets one winding (patches), patches form shells (shells), and closed shells
//      are turned outward.
//   5. Findings that are reported only: crowded edges, holes, slits and outlines (open_edges), pinched
//      vertices (patches), triangles that cross (self_intersection).
// edge_table, box_tree and triangle_measures serve all steps. See docs/meshes.md for the findings.
#pragma once

#include <string>

#include "phalanx/mesh/mesh_report.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Limit of the displacement of any point of the surface: a fiftieth of the default contact margin [m].
inline constexpr double kMostMoved = 1e-6;
/// Coarsest step of single precision with correct forces: the default contact margin [m].
inline constexpr double kCoarsest = 50e-6;
/// Number of triangles from which a report states their cost.
inline constexpr std::size_t kManyTriangles = 200'000;

/// Scale and size of a repair.
struct RepairOptions {
  double size = 0.0;  ///< wanted largest extent [m]; the box's centre moves to the origin. 0: `unit` applies
  double unit = 1.0;  ///< metres per unit of the soup's numbers
  /// Number of vertices of the file, if every corner in the soup has its own vertex; 0: as in the soup.
  std::size_t positions = 0;
};

/// Repairs the triangles of a reader (the soup) and reports the findings. Holes stay holes, and no
/// surface is invented: input and output cover the same points to within the report's `tolerance`.
/// Triangles keep their order, except those that are cut. Repairing the result again (size 0, unit 1)
/// repairs nothing. Deterministic.
/// @throws std::invalid_argument starting with `origin` if no triangle has three corners, or the extents are
/// zero or not below 10 km. Also if single precision is coarser than 50 um at the object's place.
[[nodiscard]] TriangleMesh repair(TriangleMesh soup, const RepairOptions& options, const std::string& origin,
                                  MeshReport& report);

}  // namespace phalanx::mesh
