// SPDX-License-Identifier: Apache-2.0
#include "mesh/shells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace phalanx::mesh {
namespace {

/// +1 if the triangle runs through the edge from its lower to its higher vertex, else -1.
int direction(const TriangleMesh& mesh, const HalfEdge& e) {
  return vertex_at(mesh, e.start) == e.low ? 1 : -1;
}

/// For each group of triangles, whether it runs through each edge as often one way as the other.
std::vector<bool> closed_groups(const TriangleMesh& mesh, const EdgeTable& edges,
                                const std::vector<std::uint32_t>& group, std::size_t groups) {
  std::vector<bool> closed(groups, true);
  edges.for_each([&](std::span<const HalfEdge> edge) {
    for (const HalfEdge& e : edge) {
      const std::uint32_t g = group[e.start / 3];
      int sum = 0;
      for (const HalfEdge& other : edge)
        if (group[other.start / 3] == g) sum += direction(mesh, other);
      if (sum != 0) closed[g] = false;
      if (edge.size() == 2 && sum == 0) break;  // the usual edge
      if (edge.size() > 64) {                   // all at once, or a fan of thousands takes for ever
        for (const HalfEdge& other : edge) closed[group[other.start / 3]] = false;
        break;
      }
    }
  });
  return closed;
}

/// Where a ray from `from` crosses shells: +1 a crossing outwards, -1 inwards, summed by shell. Nothing if it
/// grazes an edge.
std::optional<std::vector<std::pair<std::uint32_t, int>>> crossings(const TriangleMesh& mesh,
                                                                    const Shells& shells, const BoxTree& tree,
                                                                    std::uint32_t own, const Vec3& from,
                                                                    const Vec3& along) {
  std::vector<std::pair<std::uint32_t, int>> sums;
  bool grazed = false;
  const Vec3 inverse = along.cwiseInverse();
  const auto may_hit = [&](const FloatBox& b) {
    double enter = 0.0;
    double leave = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double s = (static_cast<double>(b.min[i]) - from[k]) * inverse[k];
      const double e = (static_cast<double>(b.max[i]) - from[k]) * inverse[k];
      enter = std::max(enter, std::min(s, e));
      leave = std::min(leave, std::max(s, e));
    }
    return enter <= leave * (1.0 + 1e-12) && !grazed;
  };
  tree.walk(may_hit, [&](std::uint32_t t) {
    const std::uint32_t shell = shells.of[t];
    if (shell == own || !shells.shell[shell].closed) return;
    const Triangle& corner = mesh.triangles[t];
    const Vec3& a = mesh.vertices[idx(corner[0])];
    const Vec3 u = mesh.vertices[idx(corner[1])] - a;
    const Vec3 v = mesh.vertices[idx(corner[2])] - a;
    const Vec3 normal = u.cross(v);
    const double area = normal.norm();
    const double slope = normal.dot(along);
    if (area == 0.0) return;
    constexpr double kGrazing = 1e-9;
    if (std::abs(slope) <= kGrazing * area) {
      // In the triangle's plane: harmless unless it runs through the triangle.
      grazed = std::abs((from - a).dot(normal)) <= kGrazing * area * std::sqrt(area);
      return;
    }
    const double distance = (a - from).dot(normal) / slope;
    if (distance < 0.0) return;
    const Vec3 at = from + distance * along - a;
    const double b1 = at.cross(v).dot(normal) / (area * area);
    const double b2 = u.cross(at).dot(normal) / (area * area);
    const double least = std::min({b1, b2, 1.0 - b1 - b2});
    if (least < -kGrazing) return;
    if (least < kGrazing) {
      grazed = true;
      return;
    }
    const int sign = slope > 0.0 ? 1 : -1;
    const auto known =
        std::find_if(sums.begin(), sums.end(), [&](const auto& s) { return s.first == shell; });
    if (known == sums.end()) {
      sums.emplace_back(shell, sign);
    } else {
      known->second += sign;
    }
  });
  if (grazed) return std::nullopt;
  return sums;
}

/// How many closed shells the shell lies within.
int depth_of(const TriangleMesh& mesh, const Shells& shells, const BoxTree& tree, std::uint32_t shell,
             const ShellPairs& crossing) {
  const Triangle& t = mesh.triangles[shells.shell[shell].first];
  const Vec3 from = (mesh.vertices[idx(t[0])] + mesh.vertices[idx(t[1])] + mesh.vertices[idx(t[2])]) / 3.0;
  // Directions askew to everything that people draw; the next one if one grazes an edge.
  constexpr std::array<std::array<double, 3>, 5> kDirections = {{{0.61803, 0.37139, 0.69317},
                                                                 {-0.29413, 0.83147, 0.47129},
                                                                 {0.17321, -0.59237, 0.78683},
                                                                 {-0.71317, -0.22361, -0.66433},
                                                                 {0.44721, 0.13579, -0.88411}}};
  for (const auto& d : kDirections) {
    const auto sums = crossings(mesh, shells, tree, shell, from, Vec3(d[0], d[1], d[2]).normalized());
    if (!sums) continue;
    int depth = 0;
    for (const auto& [other, sum] : *sums) {
      const std::pair<std::uint32_t, std::uint32_t> pair = std::minmax(shell, other);
      if (sum != 0 && !std::binary_search(crossing.begin(), crossing.end(), pair)) ++depth;
    }
    return depth;
  }
  return 0;
}

}  // namespace

Shells find_shells(const TriangleMesh& mesh, const EdgeTable& edges, const Patches& patches) {
  const std::size_t count = patches.two_sided.size();
  const std::vector<bool> alone = closed_groups(mesh, edges, patches.of, count);
  DisjointSets sets(count);
  edges.for_each([&](std::span<const HalfEdge> edge) {
    if (edge.size() < 3) return;
    std::optional<std::uint32_t> first;
    for (const HalfEdge& e : edge) {
      const std::uint32_t p = patches.of[e.start / 3];
      if (alone[p]) continue;
      if (first) sets.join(*first, p);
      first = p;
    }
  });
  Shells shells;
  std::vector<std::uint32_t> number(count);
  for (std::uint32_t p = 0; p < count; ++p) {
    const std::uint32_t root = sets.root(p);
    if (root == p) {
      number[p] = static_cast<std::uint32_t>(shells.shell.size());
      shells.shell.emplace_back();
      shells.shell.back().box = bounds({});
    }
    number[p] = number[root];
    if (!patches.two_sided[p]) shells.shell[number[p]].two_sided = false;
  }
  shells.of.resize(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    shells.of[t] = number[patches.of[t]];
    Shell& shell = shells.shell[shells.of[t]];
    if (shell.triangles++ == 0) shell.first = static_cast<std::uint32_t>(t);
    for (const std::int32_t v : mesh.triangles[t]) {
      shell.box.min = shell.box.min.cwiseMin(mesh.vertices[idx(v)]);
      shell.box.max = shell.box.max.cwiseMax(mesh.vertices[idx(v)]);
    }
  }
  const std::vector<bool> closed = closed_groups(mesh, edges, shells.of, shells.shell.size());
  for (std::size_t s = 0; s < closed.size(); ++s)
    shells.shell[s].closed = closed[s] && shells.shell[s].two_sided;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Shell& shell = shells.shell[shells.of[t]];
    if (!shell.closed) continue;
    const Vec3& o = mesh.vertices[idx(mesh.triangles[shell.first][0])];
    const Triangle& c = mesh.triangles[t];
    const Vec3 a = mesh.vertices[idx(c[0])] - o;
    shell.volume += a.dot((mesh.vertices[idx(c[1])] - o).cross(mesh.vertices[idx(c[2])] - o)) / 6.0;
  }
  return shells;
}

std::size_t turn_shells_outward(TriangleMesh& mesh, Shells& shells, const BoxTree& tree,
                                const ShellPairs& crossing) {
  std::vector<bool> turn(shells.shell.size(), false);
  const auto closed =
      std::count_if(shells.shell.begin(), shells.shell.end(), [](const Shell& s) { return s.closed; });
  for (std::uint32_t s = 0; s < turn.size(); ++s) {
    Shell& shell = shells.shell[s];
    if (!shell.closed) continue;
    if (closed > 1) shell.cavity = depth_of(mesh, shells, tree, s, crossing) % 2 == 1;
    turn[s] = shell.cavity ? shell.volume > 0.0 : shell.volume < 0.0;
  }
  std::size_t turned = 0;
  for (std::size_t s = 0; s < turn.size(); ++s) {
    if (!turn[s]) continue;
    shells.shell[s].volume = -shells.shell[s].volume;
    ++turned;
  }
  if (turned == 0) return 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (turn[shells.of[t]]) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  return turned;
}

}  // namespace phalanx::mesh
