// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "mesh/repair/edge_table.h"
#include "mesh/repair/shells.h"
#include "mesh/repair/triangle_measures.h"

namespace phalanx::mesh {

/// Width below which no fingertip passes [m].
inline constexpr double kSlit = 3e-3;

/// Connected lines of open edges of one kind.
struct OpenLines {
  std::size_t count = 0;
  double longest = 0.0;  ///< length of the longest [m]
  Spot widest;           ///< width of the widest [m] and its middle; outlines: length of the longest
};

/// Edges of only one triangle, classified by what a finger meets there.
struct OpenEdges {
  OpenLines holes;
  OpenLines slits;
  OpenLines outlines;
  bool complete = true;  ///< false: too many edges are near each other; slits may count as outlines or holes
};

/// Classifies the open edges. O(n log n) for an ordinary mesh, deterministic.
/// - An edge belongs to a slit if, at two of three points along it, another open edge is nearer than kSlit.
///   The other edge's surface must lie on the far side. The slit's width is the distance there.
/// - The other edges are joined to lines, where they meet and across slits that end between them. Let n be a
///   line's area vector (half the sum of p x dp).
/// - A line is an outline if its surface has no two sides. It is also one if the surface leaves it inwards:
///   at less than 60 degrees to n x dp, in the mean over its length.
/// - Other lines are holes. The width is the least extent of the line's points across n, over directions 5
///   degrees apart: nothing wider passes through a flat hole. A hole narrower than kSlit is a slit.
[[nodiscard]] OpenEdges find_open_edges(const TriangleMesh& mesh, const EdgeTable& edges,
                                        const Shells& shells);

/// Edges of three or more triangles.
struct CrowdedEdges {
  std::size_t count = 0;
  double length = 0.0;  ///< total length [m]
  Spot longest;         ///< length and middle of the longest
};
[[nodiscard]] CrowdedEdges find_crowded_edges(const TriangleMesh& mesh, const EdgeTable& edges);

}  // namespace phalanx::mesh
