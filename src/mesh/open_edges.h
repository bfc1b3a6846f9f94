// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "mesh/edge_table.h"
#include "mesh/shells.h"
#include "mesh/spot.h"

namespace phalanx::mesh {

/// What is narrower lets no fingertip through [m].
inline constexpr double kSlit = 3e-3;

/// Connected lines of open edges of one kind.
struct OpenLines {
  std::size_t count = 0;
  double longest = 0.0;  ///< length of the longest [m]
  Spot widest;  ///< width of the widest [m] and its middle; outlines: length and middle of the longest
};

/// The edges of one triangle only, by what a finger finds there.
struct OpenEdges {
  OpenLines holes;
  OpenLines slits;
  OpenLines outlines;
  bool complete = true;  ///< false: too many lie near each other; slits may be counted as outlines or holes
};

/// An edge is of a slit if, at two of three points along it, another open edge whose surface lies on the far
/// side is nearer than kSlit; its width is the distance there. The other edges, joined where they meet and
/// across the slits that end between them, are lines. With n a line's area vector (half the sum of p x dp),
/// a line is an outline if the surface leaves it inwards by less than 60 degrees against the direction n x dp
/// in the mean over its length, or if the surface has no two sides. Else its width is the least extent of its
/// points across n, over directions 5 degrees apart: what passes through a flat hole is no wider. Below kSlit
/// it is a slit. O(n log n) for an ordinary mesh, deterministic.
[[nodiscard]] OpenEdges find_open_edges(const TriangleMesh& mesh, const EdgeTable& edges,
                                        const Shells& shells);

/// Edges of three or more triangles.
struct CrowdedEdges {
  std::size_t count = 0;
  double length = 0.0;  ///< of all of them together [m]
  Spot longest;         ///< its length and its middle
};
[[nodiscard]] CrowdedEdges find_crowded_edges(const TriangleMesh& mesh, const EdgeTable& edges);

}  // namespace phalanx::mesh
