// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "mesh/box_tree.h"
#include "mesh/edge_table.h"
#include "mesh/patches.h"

namespace phalanx::mesh {

/// A piece of surface: one patch that is closed by itself, or patches that hang together through edges of
/// three or more triangles and are closed, if at all, together.
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

/// Turns closed shells so that their normals point out of the solid: outwards, or, for a shell that lies
/// within an odd number of others, into the hollow that it encloses. Shells that cross (`crossing`) do not
/// lie within each other. Containment by signed crossings of a ray.
/// @returns how many shells were turned
std::size_t turn_shells_outward(TriangleMesh& mesh, Shells& shells, const BoxTree& tree,
                                const ShellPairs& crossing);

}  // namespace phalanx::mesh
