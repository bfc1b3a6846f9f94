// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "phalanx/core/index.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Corner of a triangle, and the edge that runs from it to the triangle's next corner: 3 * triangle + k.
using Corner = std::uint32_t;
[[nodiscard]] constexpr Corner next_corner(Corner c) noexcept { return c % 3 == 2 ? c - 2 : c + 1; }
[[nodiscard]] inline std::int32_t vertex_at(const TriangleMesh& mesh, Corner c) noexcept {
  return mesh.triangles[c / 3][c % 3];
}

/// Half edge: one triangle's share in an undirected edge.
struct HalfEdge {
  std::int32_t low;
  std::int32_t high;
  Corner start;
  friend bool operator<(const HalfEdge& a, const HalfEdge& b) noexcept {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.start < b.start;
  }
};

/// Table of every triangle's three edges, sorted so that the triangles at an edge are adjacent.
/// 12 bytes each.
class EdgeTable {
 public:
  explicit EdgeTable(const TriangleMesh& mesh);

  /// Calls visit(std::span<const HalfEdge>) for each undirected edge, in a fixed order.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t i = 0; i < edges_.size();) {
      std::size_t end = i + 1;
      while (end < edges_.size() && edges_[end].low == edges_[i].low && edges_[end].high == edges_[i].high)
        ++end;
      visit(std::span<const HalfEdge>(edges_.data() + i, end - i));
      i = end;
    }
  }
  /// Returns the half edges between two vertices; empty if there are none. O(log n).
  [[nodiscard]] std::span<const HalfEdge> at(std::int32_t a, std::int32_t b) const;

 private:
  std::vector<HalfEdge> edges_;
};

/// Disjoint sets of the numbers 0 .. n-1 (union-find). The least member names a set.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) {
    for (std::size_t i = 0; i < n; ++i) parent_[i] = static_cast<std::uint32_t>(i);
  }
  std::uint32_t root(std::uint32_t i) noexcept {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) noexcept {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace phalanx::mesh
