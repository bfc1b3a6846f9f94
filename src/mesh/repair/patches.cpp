// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/patches.h"

#include <limits>
#include <utility>

namespace phalanx::mesh {
namespace {

constexpr Corner kNoMate = std::numeric_limits<Corner>::max();

/// Returns for each corner the one from which the same edge starts in the only other triangle at
/// it, or kNoMate.
std::vector<Corner> mates(const TriangleMesh& mesh, const EdgeTable& edges) {
  std::vector<Corner> mate(3 * mesh.triangles.size(), kNoMate);
  edges.for_each([&](std::span<const HalfEdge> edge) {
    if (edge.size() != 2) return;
    mate[edge[0].start] = edge[1].start;
    mate[edge[1].start] = edge[0].start;
  });
  return mate;
}

/// Triangles of one patch in the order of their discovery, and which of them run against the first.
struct Walk {
  std::vector<std::uint32_t> triangles;
  std::vector<bool> against;  ///< for all triangles of the mesh
  bool two_sided = true;
};

}  // namespace

Patches orient_patches(TriangleMesh& mesh, const EdgeTable& edges) {
  const std::vector<Corner> mate = mates(mesh, edges);
  constexpr std::uint32_t kUnseen = std::numeric_limits<std::uint32_t>::max();
  Patches patches;
  patches.of.assign(mesh.triangles.size(), kUnseen);
  Walk walk;
  walk.against.assign(mesh.triangles.size(), false);
  const auto same_way = [&](Corner a, Corner b) { return vertex_at(mesh, a) == vertex_at(mesh, b); };
  for (std::size_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (patches.of[seed] != kUnseen) continue;
    const auto name = static_cast<std::uint32_t>(patches.two_sided.size());
    walk.triangles.assign(1, static_cast<std::uint32_t>(seed));
    walk.two_sided = true;
    patches.of[seed] = name;
    std::size_t against = 0;
    for (std::size_t i = 0; i < walk.triangles.size(); ++i) {
      const std::uint32_t t = walk.triangles[i];
      against += walk.against[t] ? 1U : 0U;
      for (Corner c = 3 * t; c < 3 * t + 3; ++c) {
        if (mate[c] == kNoMate) continue;
        const std::uint32_t n = mate[c] / 3;
        const bool n_against = walk.against[t] != same_way(c, mate[c]);
        if (patches.of[n] == kUnseen) {
          patches.of[n] = name;
          walk.against[n] = n_against;
          walk.triangles.push_back(n);
        } else if (walk.against[n] != n_against) {
          walk.two_sided = false;
        }
      }
    }
    patches.two_sided.push_back(walk.two_sided);
    if (!walk.two_sided || against == 0) continue;
    const bool turn = 2 * against <= walk.triangles.size();
    for (const std::uint32_t t : walk.triangles) {
      if (walk.against[t] != turn) continue;
      walk.against[t] = false;  // the flag is free again: each triangle belongs to one patch
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
      ++patches.turned;
      patches.turned_faces.add(mesh, mesh.triangles[t]);
    }
  }
  return patches;
}

PinchVertices find_pinch_vertices(const TriangleMesh& mesh, const EdgeTable& edges) {
  const std::size_t corners = 3 * mesh.triangles.size();
  DisjointSets fans(corners);
  std::vector<bool> on_crowded_edge(mesh.vertices.size(), false);
  edges.for_each([&](std::span<const HalfEdge> edge) {
    if (edge.size() > 2) on_crowded_edge[idx(edge[0].low)] = on_crowded_edge[idx(edge[0].high)] = true;
    if (edge.size() != 2) return;
    const Corner a = edge[0].start;
    const Corner b = edge[1].start;
    const bool same_way = vertex_at(mesh, a) == vertex_at(mesh, b);
    fans.join(a, same_way ? b : next_corner(b));
    fans.join(next_corner(a), same_way ? next_corner(b) : b);
  });
  std::vector<std::uint8_t> seen(mesh.vertices.size(), 0);
  for (Corner c = 0; c < static_cast<Corner>(corners); ++c) {
    std::uint8_t& fans_here = seen[idx(vertex_at(mesh, c))];
    if (fans.root(c) == c && fans_here < 2) ++fans_here;
  }
  PinchVertices pinch;
  const auto is_pinch = [&](std::int32_t v) { return seen[idx(v)] > 1 && !on_crowded_edge[idx(v)]; };
  for (std::size_t v = 0; v < seen.size(); ++v)
    if (is_pinch(static_cast<std::int32_t>(v))) ++pinch.count;
  if (pinch.count == 0) return pinch;
  edges.for_each([&](std::span<const HalfEdge> edge) {
    const Vec3& low = mesh.vertices[idx(edge[0].low)];
    const Vec3& high = mesh.vertices[idx(edge[0].high)];
    if (is_pinch(edge[0].low)) pinch.longest.take((high - low).norm(), low);
    if (is_pinch(edge[0].high)) pinch.longest.take((high - low).norm(), high);
  });
  return pinch;
}

}  // namespace phalanx::mesh
