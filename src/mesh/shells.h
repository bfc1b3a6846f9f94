// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "mesh/box_tree.h"
#include "mesh/edge_table.h"
#include "mesh/patches.h"
#include "mesh/spot.h"

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

struct TurnedShells {
  std::size_t count = 0;
  double area = 0.0;     ///< of all of them [m^2]
  Spot largest;          ///< largest extent of one, and a place on it
  bool complete = true;  ///< false: more shells lie within each other than are looked at
};

/// Turns closed shells so that their normals point out of the solid: outwards, or, for a shell that lies
/// within an odd number of others, into the hollow that it encloses. Shells that cross (`crossing`) do not
/// lie within each other, nor does one that has no place off the other: they touch. Containment by signed
/// crossings of a ray from a place farther than `tolerance` [m] from the other shells. Shells that are not
/// looked at stay as they are.
TurnedShells turn_shells_outward(TriangleMesh& mesh, Shells& shells, const BoxTree& tree,
                                 const ShellPairs& crossing, double tolerance);

}  // namespace phalanx::mesh
