// SPDX-License-Identifier: Apache-2.0
// Report on an imported mesh: defects found, repaired and left. See docs/meshes.md.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/core/math.h"

namespace phalanx {

/// Kind of a finding. `size` and `at` are members of MeshFinding; `at` is where the finding of that size is.
enum class FindingKind {
  kUnreferencedVertices,  ///< no triangle uses them
  kDuplicateVertices,     ///< at exactly the place of another; an .stl has three a triangle by its format
  kNearVertices,          ///< on open edges, within a sixth of the tolerance of another; size: largest gap
  kDegenerateFaces,      ///< no area, or flatter than a hundredth of the tolerance; size: longest edge of one
  kDuplicateFaces,       ///< the same three corners as another, either winding; size: longest edge of one
  kTJunctions,           ///< vertices on another triangle's open edge; size: widest gap
  kInconsistentWinding,  ///< triangles wound against their surface; size: longest edge of one
  kInsideOut,            ///< closed shells with normals pointing the wrong way; size: largest extent of one
  kNonManifoldEdges,     ///< three or more triangles at an edge; size: total length
  kPinchVertices,        ///< surfaces meeting only in a vertex; size: longest edge ending in one
  kHoles,                ///< lines of open edges around an opening; size: the longest line's length
  kSlits,                ///< open edges that face each other within 3 mm; size: length of the longest
  kOutlines,             ///< lines of open edges where a sheet ends; size: the longest line's length
  kSheets,               ///< surfaces that enclose nothing; size: largest extent of one
  kNonOrientable,        ///< sheets without two sides (Moebius strip); size: largest extent of one
  kSelfIntersections,    ///< pairs that cross deeper than the tolerance; size: longest line of crossing
  kUnits,                ///< largest extent below 3 mm or above 3 m; size: that extent
  kCoarseNumbers,        ///< single precision coarser than the tolerance here; size: its step
  kManyTriangles,        ///< more than a step searches quickly
};
inline constexpr std::size_t kFindingKinds = 19;

/// One row of the report: all findings of one kind.
struct MeshFinding {
  FindingKind kind{};
  std::size_t found = 0;
  std::size_t repaired = 0;  ///< the rest remains
  double size = 0.0;         ///< [m], see FindingKind; 0: not applicable
  /// kSlits: largest distance of the edges that face each other [m]. kHoles: width of the widest hole [m],
  /// which is the least extent of its line over directions across its area vector, 5 degrees apart. If the
  /// line is flat, nothing wider passes. 0: not applicable.
  double width = 0.0;
  double area = 0.0;  ///< total area of the faces or shells found [m^2]; 0: not applicable
  /// Place of one finding, in the file's own units and axes (its nodes' transforms applied). If some remain,
  /// it is one of those. Holes and slits: middle of the widest. Outlines, edges and lines of crossing: middle
  /// of the longest. Shells: a point on the largest.
  std::optional<Vec3> at = std::nullopt;
};

/// Measured distance of two surfaces: a lower bound of their Hausdorff distance.
struct SurfaceDeviation {
  double outward = 0.0;  ///< distance of the farthest probe of the original from the decimated surface [m]
  double inward = 0.0;   ///< distance of the farthest probe of the decimated surface from the original [m]
  std::size_t probes = 0;
};

/// Report on a decimation.
struct DecimationReport {
  int asked = 0;            ///< requested number of triangles
  std::size_t before = 0;   ///< triangles before the decimation
  std::size_t after = 0;    ///< triangles after it
  bool was_closed = false;  ///< is_closed() before it
  SurfaceDeviation deviation;
};

/// Report on an import.
struct MeshReport {
  std::size_t vertices_in_file = 0;   ///< as the reader gives them
  std::size_t triangles_in_file = 0;  ///< as the reader gives them, with polygons cut
  std::size_t vertices = 0;           ///< vertices of the returned mesh
  std::size_t triangles = 0;          ///< triangles of the returned mesh
  Vec3 extent = Vec3::Zero();         ///< extents of its bounding box [m]
  double scale = 1.0;                 ///< metres per unit of the file
  Vec3 origin = Vec3::Zero();         ///< point of the file, in its units, that becomes the mesh's origin
  double tolerance = 0.0;             ///< limit of the surface's displacement by the repair [m]
  double moved = 0.0;                 ///< bound on the surface's displacement by all steps together [m]
  bool closed = false;                ///< is_closed() of the returned mesh
  double volume = 0.0;                ///< volume of the closed shells, less cavities [m^3]
  std::size_t solids = 0;             ///< closed shells that bound a solid
  std::size_t cavities = 0;           ///< closed shells inside a solid, with normals into the hollow
  std::size_t sheets = 0;             ///< shells that are not closed: touched from both sides
  /// True if a repair step was skipped because all steps together would have exceeded the tolerance. This is
  /// rare: it takes seven steps in one place. A second import would make the step.
  bool held_back = false;
  bool complete = true;               ///< false: a search for T-junctions or crossings ended early
  std::vector<MeshFinding> findings;  ///< by kind; only kinds with findings
  std::optional<DecimationReport> decimation;

  /// Returns the finding of a kind, with zeros if there is none.
  [[nodiscard]] MeshFinding finding(FindingKind kind) const;
};

/// Returns the name of a kind in reports and JSON: "holes", "t_junctions", ...
[[nodiscard]] const char* finding_name(FindingKind kind) noexcept;

/// Returns one sentence on what the finding means for the forces. If a size should be corrected, it
/// names the remedy.
[[nodiscard]] std::string finding_meaning(const MeshFinding& finding);

/// Returns advice for a largest extent below 3 mm or above 3 m, which suits no hand and probably
/// has another unit.
/// @param largest  largest extent [m]
/// @param scale    metres per unit of the file that `largest` is based on
/// @returns an empty string if the extent is plausible. Else the file's probable unit and the remedy, such as
/// for 90 m: `it is 90 m wide; probably its numbers are mm (90 mm): give unit "mm" with size_mm 0, or the
/// size in mm`.
[[nodiscard]] std::string unit_advice(double largest, double scale);
/// Returns the unit, other than that of `scale`, in which the file's object would suit a hand: "mm", "cm",
/// "in" or "m". Returns an empty string if there is none.
[[nodiscard]] std::string_view probable_unit(double largest, double scale);

}  // namespace phalanx
