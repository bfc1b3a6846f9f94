// SPDX-License-Identifier: Apache-2.0
// A binary tree of axis-aligned boxes over triangles: the one search structure of object and segments.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

struct Aabb {
  Vec3 min;
  Vec3 max;
};

/// Squared distance between two boxes [m^2], 0 if they overlap. Real-time.
[[nodiscard]] inline double squared_distance(const Aabb& a, const Aabb& b) noexcept {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double gap = std::max(a.min[i] - b.max[i], b.min[i] - a.max[i]);
    if (gap > 0.0) sum += gap * gap;
  }
  return sum;
}

/// The three corners of a triangle, in the tree's frame [m].
using Corners = std::array<Vec3, 3>;

/// Nodes in depth-first order: a node's left child follows it, its right child is at `right`. A leaf holds
/// triangles [first, first + count) of the tree's own order; `source(i)` is the mesh's triangle.
class TriangleTree {
 public:
  struct Node {
    Aabb box;
    std::int32_t right = 0;  ///< index of the right child; 0 for a leaf
    std::int32_t first = 0;
    std::int32_t count = 0;  ///< triangles in a leaf; 0 for an inner node
  };

  TriangleTree() = default;
  /// @param leaf_size  most triangles in a leaf, >= 1
  TriangleTree(const TriangleMesh& mesh, int leaf_size);

  [[nodiscard]] bool empty() const noexcept { return nodes_.empty(); }
  [[nodiscard]] const std::vector<Node>& nodes() const noexcept { return nodes_; }
  [[nodiscard]] const Corners& corners(int i) const noexcept { return corners_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] int source(int i) const noexcept { return source_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] int size() const noexcept { return static_cast<int>(source_.size()); }

  /// Moves the tree to where `X` puts the reference tree `at_rest`: same shape, corners transformed, boxes
  /// refitted. Real-time: O(n), no allocation once this tree has been copied from `at_rest`.
  void place(const TriangleTree& at_rest, const Pose& X) noexcept;

 private:
  void refit() noexcept;

  std::vector<Node> nodes_;
  std::vector<Corners> corners_;
  std::vector<std::int32_t> source_;
};

}  // namespace phalanx
