// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "phalanx/contact/tree_layout.h"
#include "phalanx/contact/triangle_distance.h"
#include "phalanx/hand/joints.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// A segment's search tree, in the segment's frame: eight lenses a node, one triangle a leaf. A lens looks
/// the same from everywhere, so that a new pose costs no refit. Constant. docs/contact.md
class SegmentTree {
 public:
  SegmentTree() = default;
  /// @param mesh  valid indices, finite vertices, in the segment's frame [m]; may be empty. Set-up.
  explicit SegmentTree(const TriangleMesh& mesh);

  [[nodiscard]] bool empty() const noexcept { return triangles_.empty(); }
  [[nodiscard]] int size() const noexcept { return static_cast<int>(triangles_.size()); }
  [[nodiscard]] int node_count() const noexcept { return static_cast<int>(nodes_.size()); }
  /// Corners of triangle i (the mesh's order) in the segment's frame [m]. Real-time.
  [[nodiscard]] Corners corners(int i) const noexcept;
  [[nodiscard]] const LensNode* nodes() const noexcept { return nodes_.data(); }
  [[nodiscard]] const SegmentTriangle* triangles() const noexcept { return triangles_.data(); }
  /// The farthest vertex from the segment's origin [m].
  [[nodiscard]] double extent() const noexcept { return extent_; }

 private:
  std::vector<LensNode> nodes_;
  std::vector<SegmentTriangle> triangles_;
  double extent_ = 0.0;
};

/// One for every segment.
using SegmentTrees = std::array<SegmentTree, kSegments>;

/// What a search writes on: a segment's placed lenses and triangles, filled where a query looks, and the
/// pairs that it found near. Sized once.
class SearchScratch {
 public:
  SearchScratch() = default;
  /// Large enough for any of `trees`.
  explicit SearchScratch(const SegmentTrees& trees);
  explicit SearchScratch(const SegmentTree& tree) { grow(tree); }

  /// Whether it is large enough for the tree.
  [[nodiscard]] bool fits(const SegmentTree& tree) const noexcept {
    return lenses_.size() >= static_cast<std::size_t>(tree.node_count()) &&
           triangles_.size() >= static_cast<std::size_t>(tree.size());
  }
  [[nodiscard]] PlacedLenses* lenses() noexcept { return lenses_.data(); }
  [[nodiscard]] PlacedTriangle* triangles() noexcept { return triangles_.data(); }
  struct NearPair {
    std::int32_t triangle;  ///< of the segment
    std::int32_t slot;      ///< of the object
    TriangleDistance closest;
  };
  static constexpr std::size_t kNearPairs = 512;
  [[nodiscard]] NearPair* near() noexcept { return near_.data(); }
  /// A number that no query had before: what older ones have placed is out of date.
  [[nodiscard]] std::uint64_t next_query() noexcept { return ++query_; }

 private:
  void grow(const SegmentTree& tree);

  std::vector<PlacedLenses> lenses_;
  std::vector<PlacedTriangle> triangles_;
  std::vector<NearPair> near_ = std::vector<NearPair>(kNearPairs);
  std::uint64_t query_ = 0;
};

}  // namespace phalanx
