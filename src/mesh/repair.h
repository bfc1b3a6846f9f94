// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "phalanx/mesh/mesh_report.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// No point of the surface moves farther than this: a fiftieth of the default contact margin [m].
inline constexpr double kMostMoved = 1e-6;
/// Where single precision is coarser than the default contact margin, forces cannot be right [m].
inline constexpr double kCoarsest = 50e-6;
/// From here on a report says what many triangles cost.
inline constexpr std::size_t kManyTriangles = 200'000;

struct RepairOptions {
  double size = 0.0;  ///< largest extent wanted [m]; the box's centre goes to the origin. 0: `unit` counts
  double unit = 1.0;  ///< metres per unit of the soup's numbers
  std::size_t positions =
      0;  ///< vertices that the file has, if the soup has every corner apart; 0: as the soup
};

/// Brings the reader's triangles into order, and says what was found. Holes stay holes, and no surface is
/// made up: what is handed back covers the same points as what came in, to within the report's `tolerance`.
/// Triangles keep their order but for those that are cut. Repairing what this hands back (size 0, unit 1)
/// repairs nothing. Deterministic.
/// @throws std::invalid_argument starting with `origin`: no triangle with three corners, extents that are
/// zero or not below 10 km, single precision coarser than 50 um at the object's place
[[nodiscard]] TriangleMesh repair(TriangleMesh soup, const RepairOptions& options, const std::string& origin,
                                  MeshReport& report);

}  // namespace phalanx::mesh
