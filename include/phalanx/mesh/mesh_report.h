// SPDX-License-Identifier: Apache-2.0
// What was wrong with an imported mesh, what was done about it, and what remains.          docs/meshes.md
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/core/math.h"

namespace phalanx {

/// What can be odd about a mesh, with what `MeshFinding::size` is; `at` is where that one is.
enum class FindingKind {
  kUnreferencedVertices,  ///< no triangle uses them
  kDuplicateVertices,    ///< at exactly the same place as another; an .stl has three a triangle by its format
  kNearVertices,         ///< on open edges, within a sixth of the tolerance of another; size: largest gap
  kDegenerateFaces,      ///< no area, or flatter than a hundredth of the tolerance; size: longest edge of one
  kDuplicateFaces,       ///< the same three corners as another, either winding; size: longest edge of one
  kTJunctions,           ///< a vertex on another triangle's open edge; size: widest gap
  kInconsistentWinding,  ///< triangles that wind against their surface; size: longest edge of one
  kInsideOut,            ///< closed shells whose normals point the wrong way; size: largest extent of one
  kNonManifoldEdges,     ///< three or more triangles at an edge; size: length of all together
  kPinchVertices,        ///< surfaces that meet in one vertex only; size: longest edge that ends in one
  kHoles,                ///< lines of open edges around an opening; size: the longest line's length
  kSlits,                ///< open edges that face each other nearer than 3 mm; size: length of the longest
  kOutlines,             ///< lines of open edges where a sheet ends; size: the longest line's length
  kSheets,               ///< surfaces that enclose nothing; size: largest extent of one
  kNonOrientable,        ///< sheets without two sides (Moebius strip); size: largest extent of one
  kSelfIntersections,    ///< pairs that cross deeper than the tolerance; size: longest line of crossing
  kUnits,                ///< largest extent below 3 mm or above 3 m; size: that extent
  kCoarseNumbers,        ///< single precision is coarser than the tolerance here; size: its step
  kManyTriangles,        ///< more than a step's search is quick on
};
inline constexpr std::size_t kFindingKinds = 19;

/// One row of the report.
struct MeshFinding {
  FindingKind kind{};
  std::size_t found = 0;
  std::size_t repaired = 0;  ///< the others remain
  double size = 0.0;         ///< [m], see FindingKind; 0: has none
  /// kSlits: the largest distance of the edges that face each other [m]. kHoles: of the widest hole, the
  /// least extent of its line over directions across its area vector, 5 degrees apart [m]: what passes is no
  /// wider if the line is flat. 0: has none.
  double width = 0.0;
  double area = 0.0;  ///< of all the faces or shells found, where the finding is of those [m^2]; 0: has none
  /// A place, in the file's own units and axes (its nodes' transforms applied): the middle of the widest hole
  /// or slit, of the longest outline, edge or line of crossing, a point on the largest shell; of what
  /// remains, if any does.
  std::optional<Vec3> at = std::nullopt;
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
  Vec3 origin = Vec3::Zero();         ///< point of the file, in its units, that is the mesh's origin
  double tolerance = 0.0;             ///< no point of the surface was moved farther by the repair [m]
  double moved = 0.0;                 ///< the surface moved at most so far, all steps together [m]
  bool closed = false;                ///< is_closed() of the mesh handed back
  double volume = 0.0;                ///< of its closed shells, cavities taken off [m^3]
  std::size_t solids = 0;             ///< closed shells that bound a solid from outside
  std::size_t cavities = 0;           ///< closed shells inside a solid, that face into the hollow
  std::size_t sheets = 0;             ///< shells that are not closed: met from both sides
  /// A step of the repair was left out because all steps together would have moved the surface farther than
  /// the tolerance. Rare: it takes seven steps in one place. A second import would do it.
  bool held_back = false;
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
/// @returns empty if the extent is plausible, else what unit the file probably has and what to give, e.g. for
/// 90 m: `it is 90 m wide; probably its numbers are mm (90 mm): give unit "mm" with size_mm 0, or the size in
/// mm`. `scale`: metres per unit of the file that `largest` [m] rests on.
[[nodiscard]] std::string unit_advice(double largest, double scale);
/// The unit, other than the one that `scale` stands for, in which the file would be an object for a hand:
/// "mm", "cm", "in" or "m"; empty: none.
[[nodiscard]] std::string_view probable_unit(double largest, double scale);

}  // namespace phalanx
