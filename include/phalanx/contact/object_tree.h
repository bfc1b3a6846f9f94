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

/// Search tree of the object: eight boxes a node, eight triangles a leaf, about 80 bytes a triangle. A
/// triangle's place in the tree is its slot. Constant. See docs/contact.md.
class ObjectTree {
 public:
  ObjectTree() = default;
  /// Builds the tree. O(n log n), deterministic; set-up only.
  /// @param mesh  valid indices, finite vertices, in W [m]; may be empty
  explicit ObjectTree(const TriangleMesh& mesh);

  [[nodiscard]] bool empty() const noexcept { return blocks_.empty(); }
  /// Returns the number of triangles; slots are 0 to size() - 1.
  [[nodiscard]] int size() const noexcept { return static_cast<int>(source_.size()); }
  /// Returns the index in the mesh of the slot's triangle. Real-time.
  [[nodiscard]] int source(int slot) const noexcept { return source_[static_cast<std::size_t>(slot)]; }
  /// Returns the corners of the slot's triangle in W [m]. Real-time.
  [[nodiscard]] Corners corners(int slot) const noexcept;
  /// Returns the memory of the tree [bytes].
  [[nodiscard]] std::size_t bytes() const noexcept;

  [[nodiscard]] const BoxNode* nodes() const noexcept { return nodes_.data(); }
  [[nodiscard]] const TriangleBlock* blocks() const noexcept { return blocks_.data(); }
  /// Returns the origin of the boxes, in W [m].
  [[nodiscard]] const Vec3& centre() const noexcept { return centre_; }
  /// Returns half the longest edge of the root's box [m].
  [[nodiscard]] double extent() const noexcept { return extent_; }

 private:
  std::vector<BoxNode> nodes_;
  std::vector<TriangleBlock> blocks_;
  std::vector<std::int32_t> source_;
  Vec3 centre_ = Vec3::Zero();
  double extent_ = 0.0;
};

}  // namespace phalanx
