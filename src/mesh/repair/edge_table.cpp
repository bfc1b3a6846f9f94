// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/edge_table.h"

namespace phalanx::mesh {

EdgeTable::EdgeTable(const TriangleMesh& mesh) {
  edges_.reserve(3 * mesh.triangles.size());
  const auto corners = static_cast<Corner>(3 * mesh.triangles.size());
  for (Corner c = 0; c < corners; ++c) {
    const std::int32_t a = vertex_at(mesh, c);
    const std::int32_t b = vertex_at(mesh, next_corner(c));
    edges_.push_back({std::min(a, b), std::max(a, b), c});
  }
  std::sort(edges_.begin(), edges_.end());
}

std::span<const HalfEdge> EdgeTable::at(std::int32_t a, std::int32_t b) const {
  const HalfEdge first{std::min(a, b), std::max(a, b), 0};
  const auto begin = std::lower_bound(edges_.begin(), edges_.end(), first);
  auto end = begin;
  while (end != edges_.end() && end->low == first.low && end->high == first.high) ++end;
  return {begin, end};
}

}  // namespace phalanx::mesh
