// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "phalanx/contact/near_pairs.h"
#include "phalanx/contact/tree_layout.h"
#include "phalanx/contact/triangle_distance.h"
#include "phalanx/hand/joints.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// Search tree of a segment, in the segment's frame: eight lenses a node, one triangle a leaf. A
/// lens is symmetric about its axis, so that a new pose only moves it and refits nothing.
/// Constant. See docs/contact.md.
class SegmentTree {
 public:
  SegmentTree() = default;
  /// Builds the tree. O(n log n); set-up only.
  /// @param mesh  valid indices, finite vertices, in the segment's frame [m]; may be empty
  explicit SegmentTree(const TriangleMesh& mesh);

  [[nodiscard]] bool empty() const noexcept { return triangles_.empty(); }
  [[nodiscard]] int size() const noexcept { return static_cast<int>(triangles_.size()); }
  [[nodiscard]] int node_count() const noexcept { return static_cast<int>(nodes_.size()); }
  /// Returns the corners of triangle i (in the mesh's order) in the segment's frame [m]. Real-time.
  [[nodiscard]] Corners corners(int i) const noexcept;
  [[nodiscard]] const LensNode* nodes() const noexcept { return nodes_.data(); }
  [[nodiscard]] const SegmentTriangle* triangles() const noexcept { return triangles_.data(); }
  /// Returns the centre of a sphere that holds the segment, in its frame [m]. @pre !empty(). Real-time.
  [[nodiscard]] Vec3 centre() const noexcept {
    const auto axis = [&](int k) { return static_cast<double>(nodes_[0].centre[k][0]); };
    return {axis(0), axis(1), axis(2)};
  }
  /// Returns that sphere's radius [m]. @pre !empty(). Real-time.
  [[nodiscard]] double radius() const noexcept { return static_cast<double>(nodes_[0].radius[0]); }
  /// Returns the distance of the farthest vertex from the segment's origin [m].
  [[nodiscard]] double extent() const noexcept { return extent_; }

 private:
  std::vector<LensNode> nodes_;
  std::vector<SegmentTriangle> triangles_;
  double extent_ = 0.0;
};

/// Search trees of all segments.
struct SegmentTrees : std::array<SegmentTree, kSegments> {};

/// Memory of a search: lenses and triangles of a segment at the query's pose, placed on first use, and the
/// pairs found near. Allocated once; one search at a time.
class SearchScratch {
 public:
  SearchScratch() = default;
  /// Allocates enough memory for any of `trees`. Set-up only.
  explicit SearchScratch(const SegmentTrees& trees);
  explicit SearchScratch(const SegmentTree& tree) { grow(tree); }

  /// @returns true if the memory is large enough for the tree
  [[nodiscard]] bool fits(const SegmentTree& tree) const noexcept {
    return lenses_.size() >= static_cast<std::size_t>(tree.node_count()) &&
           triangles_.size() >= static_cast<std::size_t>(tree.size());
  }
  /// Returns the memory of the placed lenses, or of the placed triangles.
  [[nodiscard]] PlacedLenses* lenses() noexcept { return lenses_.data(); }
  [[nodiscard]] PlacedTriangle* triangles() noexcept { return triangles_.data(); }
  /// Returns the memory of near pairs for queries whose caller has none.
  [[nodiscard]] NearPairs& near() noexcept { return near_; }
  /// Returns a number that no earlier query had, which invalidates what earlier queries have placed.
  [[nodiscard]] std::uint64_t next_query() noexcept { return ++query_; }

 private:
  void grow(const SegmentTree& tree);

  std::vector<PlacedLenses> lenses_;
  std::vector<PlacedTriangle> triangles_;
  NearPairs near_;
  std::uint64_t query_ = 0;
};

}  // namespace phalanx
