// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "phalanx/contact/tree_layout.h"
#include "phalanx/contact/triangle_distance.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// The object's search tree: eight boxes a node, eight triangles a leaf, about 80 bytes a triangle. Constant.
/// A triangle's place in it is its slot.                                                    docs/contact.md
class ObjectTree {
 public:
  ObjectTree() = default;
  /// @param mesh  valid indices, finite vertices, in W [m]; may be empty. O(n log n), deterministic; set-up.
  explicit ObjectTree(const TriangleMesh& mesh);

  [[nodiscard]] bool empty() const noexcept { return blocks_.empty(); }
  /// Triangles; slots are 0 to size() - 1.
  [[nodiscard]] int size() const noexcept { return static_cast<int>(source_.size()); }
  /// The slot's triangle in the mesh. Real-time.
  [[nodiscard]] int source(int slot) const noexcept { return source_[static_cast<std::size_t>(slot)]; }
  /// The slot's corners in W [m]. Real-time.
  [[nodiscard]] Corners corners(int slot) const noexcept;
  /// Memory of the tree.
  [[nodiscard]] std::size_t bytes() const noexcept;

  [[nodiscard]] const BoxNode* nodes() const noexcept { return nodes_.data(); }
  [[nodiscard]] const TriangleBlock* blocks() const noexcept { return blocks_.data(); }
  /// Origin of the boxes, in W [m].
  [[nodiscard]] const Vec3& centre() const noexcept { return centre_; }
  /// Half the longest edge of the root's box [m].
  [[nodiscard]] double extent() const noexcept { return extent_; }

 private:
  std::vector<BoxNode> nodes_;
  std::vector<TriangleBlock> blocks_;
  std::vector<std::int32_t> source_;
  Vec3 centre_ = Vec3::Zero();
  double extent_ = 0.0;
};

}  // namespace phalanx
