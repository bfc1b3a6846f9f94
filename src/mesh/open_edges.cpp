// SPDX-License-Identifier: Apache-2.0
#include "mesh/open_edges.h"

#include <algorithm>
#include <map>

namespace phalanx::mesh {

OpenEdges find_open_edges(const TriangleMesh& mesh, const EdgeTable& edges) {
  std::vector<HalfEdge> open;
  edges.for_each([&](std::span<const HalfEdge> edge) {
    if (edge.size() == 1) open.push_back(edge[0]);
  });
  OpenEdges result;
  result.edges = open.size();
  if (open.empty()) return result;
  DisjointSets lines(mesh.vertices.size());
  for (const HalfEdge& e : open)
    lines.join(static_cast<std::uint32_t>(e.low), static_cast<std::uint32_t>(e.high));
  struct Line {
    double length = 0.0;
    Bounds box = bounds({});
  };
  std::map<std::uint32_t, Line> line;
  for (const HalfEdge& e : open) {
    Line& l = line[lines.root(static_cast<std::uint32_t>(e.low))];
    const Vec3& a = mesh.vertices[idx(e.low)];
    const Vec3& b = mesh.vertices[idx(e.high)];
    l.length += (b - a).norm();
    l.box.min = l.box.min.cwiseMin(a).cwiseMin(b);
    l.box.max = l.box.max.cwiseMax(a).cwiseMax(b);
  }
  result.lines = line.size();
  for (const auto& [name, l] : line) {
    result.longest = std::max(result.longest, l.length);
    result.widest = std::max(result.widest, (l.box.max - l.box.min).maxCoeff());
  }
  return result;
}

std::size_t count_crowded_edges(const EdgeTable& edges) {
  std::size_t count = 0;
  edges.for_each([&](std::span<const HalfEdge> edge) { count += edge.size() > 2 ? 1U : 0U; });
  return count;
}

}  // namespace phalanx::mesh
