// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "mesh/repair/box_tree.h"
#include "mesh/repair/edge_table.h"
#include "mesh/repair/patches.h"
#include "mesh/repair/triangle_measures.h"

namespace phalanx::mesh {

/// Connected piece of surface. It is one patch that is closed by itself, or several patches connected through
/// edges of three or more triangles. Such patches can only be closed together.
struct Shell {
  std::uint32_t first = 0;  ///< its first triangle
  std::size_t triangles = 0;
  Bounds box;
  bool closed = false;  ///< at every edge as many of its triangles run one way as the other
  bool two_sided = true;
  bool cavity = false;  ///< closed, inside an odd number of others: its normals point into the hollow
  double volume = 0.0;  ///< signed, of a closed shell [m^3]
};

struct Shells {
  std::vector<std::uint32_t> of;  ///< each triangle's shell
  std::vector<Shell> shell;
};

[[nodiscard]] Shells find_shells(const TriangleMesh& mesh, const EdgeTable& edges, const Patches& patches);

/// Pairs of shells, lower number first, sorted.
using ShellPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Result of turn_shells_outward().
struct TurnedShells {
  std::size_t count = 0;
  double area = 0.0;     ///< total area [m^2]
  Spot largest;          ///< largest extent of one [m], and a place on it
  bool complete = true;  ///< false: more shells lie within each other than are examined
};

/// Turns closed shells so that their normals point out of the solid. These are outward normals or, for a
/// shell within an odd number of others, normals into the hollow that it encloses.
/// Shells that cross (`crossing`) do not contain each other, nor do shells that touch at every place.
/// Containment is computed from signed crossings of a ray. The ray starts at a place farther than `tolerance`
/// [m] from the other shells. Shells that are not examined stay as they are.
TurnedShells turn_shells_outward(TriangleMesh& mesh, Shells& shells, const BoxTree& tree,
                                 const ShellPairs& crossing, double tolerance);

}  // namespace phalanx::mesh
