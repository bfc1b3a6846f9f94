// SPDX-License-Identifier: Apache-2.0
// What was wrong with an imported mesh, what was done about it, and what remains.          docs/meshes.md
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/core/math.h"

namespace phalanx {

/// What can be odd about a mesh. `MeshFinding::size` is the length named here.
enum class FindingKind {
  kUnreferencedVertices,  ///< no triangle uses them
  kDuplicateVertices,    ///< at exactly the same place as another; an .stl has three a triangle by its format
  kNearVertices,         ///< on open edges, within the tolerance of another; size: largest gap
  kDegenerateFaces,      ///< no area, or flatter than a hundredth of the tolerance
  kDuplicateFaces,       ///< the same three corners as another, in either winding
  kTJunctions,           ///< a vertex on another triangle's open edge; size: largest gap
  kInconsistentWinding,  ///< triangles that wind against the rest of their surface
  kInsideOut,            ///< closed shells whose normals point the wrong way
  kNonManifoldEdges,     ///< three or more triangles at an edge
  kPinchVertices,        ///< surfaces that meet in one vertex only
  kHoles,                ///< connected lines of open edges; size: the longest line's length
  kSheets,               ///< surfaces that enclose nothing; size: largest extent of one
  kNonOrientable,        ///< sheets without two sides, such as a Moebius strip
  kSelfIntersections,    ///< pairs of triangles that cross deeper than the tolerance
  kUnits,                ///< largest extent below 3 mm or above 3 m; size: that extent
  kCoarseNumbers,        ///< single precision is coarser than the tolerance here; size: its step
  kManyTriangles,        ///< more than a step's search is quick on
};
inline constexpr std::size_t kFindingKinds = 17;

/// One row of the report.
struct MeshFinding {
  FindingKind kind{};
  std::size_t found = 0;
  std::size_t repaired = 0;  ///< the others remain
  double size = 0.0;         ///< [m], see FindingKind; 0: has none
  double width = 0.0;        ///< kHoles: extent of the widest line's box [m]
};

/// How far two surfaces are apart, by measurement: a lower bound of their Hausdorff distance.
struct SurfaceDeviation {
  double outward = 0.0;  ///< farthest probe of the original from the decimated surface [m]
  double inward = 0.0;   ///< farthest probe of the decimated from the original surface [m]
  std::size_t probes = 0;
};

struct DecimationReport {
  int asked = 0;            ///< about how many triangles
  std::size_t before = 0;   ///< triangles
  std::size_t after = 0;    ///< triangles
  bool was_closed = false;  ///< before
  SurfaceDeviation deviation;
};

struct MeshReport {
  std::size_t vertices_in_file = 0;   ///< as the reader gives them
  std::size_t triangles_in_file = 0;  ///< as the reader gives them, polygons cut
  std::size_t vertices = 0;           ///< of the mesh handed back
  std::size_t triangles = 0;          ///< of the mesh handed back
  Vec3 extent = Vec3::Zero();         ///< of its bounding box [m]
  double scale = 1.0;                 ///< metres per unit of the file
  double tolerance = 0.0;             ///< no point of the surface was moved farther by the repair [m]
  double moved = 0.0;                 ///< largest movement that the repair made [m]
  bool closed = false;                ///< is_closed() of the mesh handed back
  double volume = 0.0;                ///< of its closed shells, cavities taken off [m^3]
  std::size_t solids = 0;             ///< closed shells that bound a solid from outside
  std::size_t cavities = 0;           ///< closed shells inside a solid, that face into the hollow
  std::size_t sheets = 0;             ///< shells that are not closed: met from both sides
  bool complete = true;               ///< false: a search for T-junctions or crossings was cut short
  std::vector<MeshFinding> findings;  ///< by kind; only those found
  std::optional<DecimationReport> decimation;

  /// The finding of a kind; nothing found: zeros.
  [[nodiscard]] MeshFinding finding(FindingKind kind) const;
};

/// "holes", "t_junctions", ...: the kind in reports and JSON.
[[nodiscard]] const char* finding_name(FindingKind kind) noexcept;

/// What the finding means for the forces, one sentence; where sizes are to be set right, with the remedy.
[[nodiscard]] std::string finding_meaning(const MeshFinding& finding);

/// Largest extent below 3 mm or above 3 m: no object for a hand, and probably another unit.
/// @returns empty if the extent is plausible, else what unit the file probably has and what to give, e.g.
/// "probably in mm: give unit mm, or a size". `scale`: metres per unit of the file that `largest` [m] rests
/// on.
[[nodiscard]] std::string unit_advice(double largest, double scale);

}  // namespace phalanx
