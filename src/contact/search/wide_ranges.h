// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/contact/tree_layout.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// The shape of a tree with up to eight children a node, before it has any bounds.
struct WideRanges {
  struct Lane {
    std::int32_t first = 0;
    std::int32_t count = 0;  ///< triangles [first, first + count) of `order`; 0: the lane is empty
    std::int32_t child = 0;  ///< >= 0: a node; < 0: ~leaf
  };
  using Node = std::array<Lane, kWide>;

  std::vector<Node> nodes;          ///< children stand behind their parent; lane 0 of node 0 is the root
  std::vector<std::int32_t> order;  ///< the mesh's triangles, leaf by leaf
};

/// Splits the triangles at medians of their boxes' middles along the widest axis, so that every leaf but the
/// last holds `leaf_size` and every node but a few has eight children. Ties keep the mesh's order, so that
/// the tree is reproducible. No triangles: no nodes. O(n log n); set-up only.
[[nodiscard]] WideRanges wide_ranges(const TriangleMesh& mesh, int leaf_size);

}  // namespace phalanx
