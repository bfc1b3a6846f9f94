// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/contact/tree_layout.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// Shape of a tree with up to eight children a node, without bounds.
struct WideRanges {
  struct Lane {
    std::int32_t first = 0;
    std::int32_t count = 0;  ///< triangles [first, first + count) of `order`; 0: the lane is empty
    std::int32_t child = 0;  ///< >= 0: a node; < 0: ~leaf
  };
  using Node = std::array<Lane, kWide>;

  std::vector<Node> nodes;          ///< children after their parent; lane 0 of node 0 is the root
  std::vector<std::int32_t> order;  ///< the mesh's triangles, leaf by leaf
};

/// Splits the triangles at medians of their boxes' centres along the widest axis. Every leaf but the last
/// holds `leaf_size` triangles, and all but a few nodes have eight children. Ties keep the mesh's order, so
/// that the tree is reproducible. Without triangles there are no nodes. O(n log n); set-up only.
[[nodiscard]] WideRanges wide_ranges(const TriangleMesh& mesh, int leaf_size);

}  // namespace phalanx
