// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/t_junctions.h"

#include <algorithm>
#include <vector>

#include "mesh/repair/box_tree.h"
#include "mesh/repair/edge_table.h"
#include "mesh/repair/flat_faces.h"

namespace phalanx::mesh {
namespace {

/// A vertex on an open edge.
struct Hit {
  Corner edge;
  double along;  ///< distance from the edge's start [m]
  double off;    ///< distance from the edge [m]
  std::int32_t vertex;
  friend bool operator<(const Hit& a, const Hit& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.along < b.along;
  }
};

std::vector<Corner> open_edges(const TriangleMesh& mesh) {
  std::vector<Corner> open;
  EdgeTable(mesh).for_each([&](std::span<const HalfEdge> edge) {
    if (edge.size() == 1) open.push_back(edge[0].start);
  });
  std::sort(open.begin(), open.end());
  return open;
}

/// Returns a bound on the displacement so far of an edge's point at this share of its length [m].
double spent_at(const Allowance& allowance, std::int32_t a, std::int32_t b, double share) {
  return (1.0 - share) * allowance.spent[idx(a)] + share * allowance.spent[idx(b)];
}

std::vector<Hit> find_hits(const TriangleMesh& mesh, Allowance& allowance, bool& complete) {
  const double tolerance = allowance.reach;
  std::vector<Corner> open = open_edges(mesh);
  const auto point = [&](std::int32_t v) -> const Vec3& { return mesh.vertices[idx(v)]; };
  std::vector<FloatBox> boxes;
  std::vector<std::int32_t> border;
  boxes.reserve(open.size());
  for (const Corner c : open) border.push_back(vertex_at(mesh, c));
  for (const Corner c : open) border.push_back(vertex_at(mesh, next_corner(c)));
  // A triangle without area has every vertex on all its edges, so that splitting is useless.
  std::erase_if(open, [&](Corner c) { return height_of(mesh, c / 3) <= tolerance; });
  for (const Corner c : open) {
    const Vec3& a = point(vertex_at(mesh, c));
    const Vec3& b = point(vertex_at(mesh, next_corner(c)));
    const Vec3 more = Vec3::Constant(tolerance);
    boxes.push_back(outward(a.cwiseMin(b) - more, a.cwiseMax(b) + more));
  }
  std::sort(border.begin(), border.end());
  border.erase(std::unique(border.begin(), border.end()), border.end());
  const BoxTree tree(std::move(boxes));
  std::vector<Hit> hits;
  // An ordinary border has a few edges near a vertex. In a heap of long triangles every box
  // contains every vertex.
  constexpr std::size_t kMostPairs = 20'000'000;
  std::size_t looked_at = 0;
  for (const std::int32_t v : border) {
    if (looked_at > kMostPairs) {
      complete = false;
      break;
    }
    const Vec3& p = point(v);
    tree.overlapping(outward(p, p), [&](std::uint32_t item) {
      ++looked_at;
      const Corner c = open[item];
      const Triangle& t = mesh.triangles[c / 3];
      if (std::find(t.begin(), t.end(), v) != t.end()) return;
      const Vec3& a = point(vertex_at(mesh, c));
      const Vec3 edge = point(vertex_at(mesh, next_corner(c))) - a;
      const double length = edge.norm();
      if (!(length > 2.0 * tolerance)) return;
      const double along = (p - a).dot(edge) / length;
      const double off = (p - a - edge * (along / length)).norm();
      if (along > tolerance && along < length - tolerance && off <= tolerance &&
          allowance.allows(
              off + spent_at(allowance, vertex_at(mesh, c), vertex_at(mesh, next_corner(c)), along / length)))
        hits.push_back({c, along, off, v});
    });
  }
  std::stable_sort(hits.begin(), hits.end());  // they are in the order of their vertices
  return hits;
}

}  // namespace

Mended split_t_junctions(TriangleMesh& mesh, Allowance& allowance) {
  Mended mended;
  // A triangle's second and third edge are split in later passes, when its corners have new numbers.
  constexpr int kPasses = 8;
  for (int pass = 0; pass < kPasses; ++pass) {
    const std::vector<Hit> hits = find_hits(mesh, allowance, mended.complete);
    if (hits.empty()) break;
    Corner done = 0;  // 1 + the triangle of the last split edge
    for (std::size_t i = 0; i < hits.size();) {
      const Corner c = hits[i].edge;
      std::size_t end = i;
      while (end < hits.size() && hits[end].edge == c) ++end;
      if (c / 3 + 1 != done) {
        done = c / 3 + 1;
        const std::int32_t last = vertex_at(mesh, next_corner(c));
        const std::int32_t apex = vertex_at(mesh, next_corner(next_corner(c)));
        const std::int32_t first = vertex_at(mesh, c);
        const double length = (mesh.vertices[idx(last)] - mesh.vertices[idx(first)]).norm();
        std::int32_t from = first;
        double at = 0.0;
        for (std::size_t h = i; h < end; ++h) {
          const double moved = hits[h].off + spent_at(allowance, first, last, hits[h].along / length);
          if (!allowance.allows(moved)) continue;               // an end has accepted others since
          if (hits[h].along - at <= allowance.reach) continue;  // no shorter pieces
          const Triangle piece = {from, hits[h].vertex, apex};
          if (from == first) {
            mesh.triangles[c / 3] = piece;
          } else {
            mesh.triangles.push_back(piece);
          }
          from = hits[h].vertex;
          at = hits[h].along;
          ++mended.count;
          mended.worst.take(hits[h].off, mesh.vertices[idx(hits[h].vertex)]);
          double& spent = allowance.spent[idx(hits[h].vertex)];
          spent = std::max(spent, moved);
        }
        if (from != first) mesh.triangles.push_back({from, last, apex});
      }
      i = end;
    }
  }
  return mended;
}

}  // namespace phalanx::mesh
