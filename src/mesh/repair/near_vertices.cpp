// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/near_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "mesh/repair/edge_table.h"
#include "mesh/repair/weld.h"

namespace phalanx::mesh {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct PlacedVertex {
  Cell cell;
  std::int32_t vertex;
  friend bool operator<(const PlacedVertex& a, const PlacedVertex& b) {
    return a.cell < b.cell || (a.cell == b.cell && a.vertex < b.vertex);
  }
};

std::vector<bool> border_vertices(const TriangleMesh& mesh) {
  std::vector<bool> border(mesh.vertices.size(), false);
  EdgeTable(mesh).for_each([&](std::span<const HalfEdge> edge) {
    if (edge.size() != 1) return;
    border[idx(edge[0].low)] = true;
    border[idx(edge[0].high)] = true;
  });
  return border;
}

using Edge = std::pair<std::int32_t, std::int32_t>;

/// Undoes the renaming of the corners of a triangle that no remaining triangle covers. Renaming would make
/// such a triangle a line or a point. It may be dropped only if an edge or a corner of a remaining triangle
/// is there, because a finger can touch a free needle.
/// @returns true if a renaming was undone, which may uncover others
bool undo_what_nothing_covers(const TriangleMesh& mesh, std::vector<std::int32_t>& to) {
  std::vector<std::size_t> thin;
  const auto renamed = [&](const Triangle& t) {
    return Triangle{to[idx(t[0])], to[idx(t[1])], to[idx(t[2])]};
  };
  const auto is_thin = [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (is_thin(renamed(mesh.triangles[t]))) thin.push_back(t);
  if (thin.empty()) return false;
  std::vector<Edge> edges;  // edges of the remaining triangles
  edges.reserve(3 * (mesh.triangles.size() - thin.size()));
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Triangle& original : mesh.triangles) {
    const Triangle t = renamed(original);
    if (is_thin(t)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      used[idx(t[k])] = true;
      edges.emplace_back(std::minmax(t[k], t[(k + 1) % 3]));
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<std::int32_t> undo;
  for (const std::size_t i : thin) {
    const Triangle t = renamed(mesh.triangles[i]);
    const auto [low, high] = std::minmax_element(t.begin(), t.end());
    const bool covered =
        *low == *high ? used[idx(*low)] : std::binary_search(edges.begin(), edges.end(), Edge{*low, *high});
    if (!covered) undo.insert(undo.end(), mesh.triangles[i].begin(), mesh.triangles[i].end());
  }
  for (const std::int32_t v : undo) to[idx(v)] = v;
  return !undo.empty();
}

}  // namespace

Mended merge_near_vertices(TriangleMesh& mesh, Allowance& allowance) {
  const double tolerance = allowance.reach;
  std::vector<double>& spent = allowance.spent;
  // In a grid of cells as wide as the tolerance, all vertices near another are in 27 cells around it.
  std::vector<PlacedVertex> placed;
  {
    const std::vector<bool> border = border_vertices(mesh);
    const Vec3 origin = bounds(mesh).min;
    for (std::size_t v = 0; v < border.size(); ++v) {
      if (!border[v]) continue;
      const Vec3 at = (mesh.vertices[v] - origin) / tolerance;
      placed.push_back({{static_cast<std::int64_t>(at.x()), static_cast<std::int64_t>(at.y()),
                         static_cast<std::int64_t>(at.z())},
                        static_cast<std::int32_t>(v)});
    }
  }
  Mended mended;
  if (placed.empty()) return mended;
  std::sort(placed.begin(), placed.end());
  std::vector<std::int32_t> to(mesh.vertices.size());
  std::iota(to.begin(), to.end(), 0);
  // The order is by place, not by number, because numbers change when a mesh is read again.
  std::vector<std::uint32_t> in_order(placed.size());
  std::iota(in_order.begin(), in_order.end(), 0U);
  const auto before = [&](std::int32_t a, std::int32_t b) {
    const Vec3& p = mesh.vertices[idx(a)];
    const Vec3& q = mesh.vertices[idx(b)];
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::sort(in_order.begin(), in_order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return before(placed[a].vertex, placed[b].vertex); });
  for (const std::uint32_t p : in_order) {
    const std::int32_t v = placed[p].vertex;
    if (to[idx(v)] != v) continue;  // it has moved already
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        const Cell& c = placed[p].cell;
        const PlacedVertex first{{c[0] + dx, c[1] + dy, c[2] - 1}, -1};
        const Cell last{c[0] + dx, c[1] + dy, c[2] + 1};
        for (auto other = std::lower_bound(placed.begin(), placed.end(), first);
             other != placed.end() && other->cell <= last; ++other) {
          const std::int32_t w = other->vertex;
          if (!before(v, w) || to[idx(w)] != w) continue;
          const double gap = (mesh.vertices[idx(w)] - mesh.vertices[idx(v)]).norm();
          if (gap > tolerance || !allowance.allows(spent[idx(w)] + gap)) continue;
          to[idx(w)] = v;
          ++mended.count;
        }
      }
    }
  }
  if (mended.count == 0) return mended;
  constexpr int kRounds = 64;
  for (int round = 0; undo_what_nothing_covers(mesh, to); ++round)
    if (round == kRounds) return {.complete = false};
  mended = {};
  for (std::size_t v = 0; v < to.size(); ++v) {
    if (idx(to[v]) == v) continue;
    ++mended.count;
    const double gap = (mesh.vertices[v] - mesh.vertices[idx(to[v])]).norm();
    mended.worst.take(gap, mesh.vertices[v]);
    spent[idx(to[v])] = std::max(spent[idx(to[v])], spent[v] + gap);
  }
  if (mended.count > 0) rename_vertices(mesh, to, &spent);
  return mended;
}

}  // namespace phalanx::mesh
