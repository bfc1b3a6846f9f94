// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Box in single precision, rounded outwards, so that it contains the original.
struct FloatBox {
  std::array<float, 3> min;
  std::array<float, 3> max;
  [[nodiscard]] bool overlaps(const FloatBox& b) const noexcept {
    return min[0] <= b.max[0] && b.min[0] <= max[0] && min[1] <= b.max[1] && b.min[1] <= max[1] &&
           min[2] <= b.max[2] && b.min[2] <= max[2];
  }
};
/// Returns the box between two corners, rounded outwards.
[[nodiscard]] FloatBox outward(const Vec3& min, const Vec3& max) noexcept;
/// Returns the box of a triangle, enlarged by `wider` on all sides [m].
[[nodiscard]] FloatBox box_of(const TriangleMesh& mesh, std::size_t triangle, double wider = 0.0) noexcept;

/// Binary tree of boxes for set-up work on meshes: 32 bytes a node, at most kLeaf items a leaf. The real-time
/// search uses the trees of contact instead.
class BoxTree {
 public:
  explicit BoxTree(std::vector<FloatBox> boxes);

  [[nodiscard]] const FloatBox& box(std::uint32_t item) const noexcept { return boxes_[item]; }

  /// Calls visit(item) for all items whose box overlaps `box`, in a fixed order.
  template <typename Visit>
  void overlapping(const FloatBox& box, const Visit& visit) const {
    walk([&](const FloatBox& b) { return b.overlaps(box); }, visit);
  }

  /// Calls visit(item) for all items for which may_hit(box) is true for their box and their nodes' boxes.
  /// `may_hit` may become stricter on the way, for example as a best distance shrinks. If right_first(left,
  /// right) is true, the right child is visited first.
  template <typename MayHit, typename Visit, typename Order>
  void walk(const MayHit& may_hit, const Visit& visit, const Order& right_first) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, 128> stack;  // depth is at most log2(items) + 1
    std::size_t top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const Node& node = nodes_[stack[--top]];
      if (!may_hit(node.box)) continue;
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
          if (may_hit(boxes_[items_[i]])) visit(items_[i]);
        continue;
      }
      const std::uint32_t left = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
      const bool swap = right_first(nodes_[left].box, nodes_[node.first].box);
      stack[top++] = swap ? left : node.first;
      stack[top++] = swap ? node.first : left;
    }
  }
  template <typename MayHit, typename Visit>
  void walk(const MayHit& may_hit, const Visit& visit) const {
    walk(may_hit, visit, [](const FloatBox&, const FloatBox&) { return false; });
  }

 private:
  static constexpr std::uint32_t kLeaf = 4;
  struct Node {
    FloatBox box;
    std::uint32_t first = 0;  ///< leaf: its first item; inner node: the right child (the left one follows)
    std::uint32_t count = 0;  ///< number of items of a leaf; 0: inner node
  };
  void build(std::uint32_t first, std::uint32_t count);

  std::vector<FloatBox> boxes_;
  std::vector<std::uint32_t> items_;
  std::vector<Node> nodes_;
};

/// Returns the tree of the boxes of all triangles.
[[nodiscard]] BoxTree triangle_boxes(const TriangleMesh& mesh);

}  // namespace phalanx::mesh
