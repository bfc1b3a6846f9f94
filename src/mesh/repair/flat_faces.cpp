// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/flat_faces.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "mesh/repair/edge_table.h"
#include "mesh/repair/triangle_measures.h"
#include "mesh/repair/weld.h"

namespace phalanx::mesh {
namespace {

const Vec3& point(const TriangleMesh& mesh, std::int32_t v) { return mesh.vertices[idx(v)]; }

double height(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return longest > 0.0 ? (b - a).cross(c - a).norm() / longest : 0.0;
}

double height_at(const TriangleMesh& mesh, const Triangle& t) noexcept {
  return height(point(mesh, t[0]), point(mesh, t[1]), point(mesh, t[2]));
}

/// Returns the corner from which the triangle's longest edge starts.
Corner longest_edge(const TriangleMesh& mesh, Corner triangle) {
  Corner best = 3 * triangle;
  double length = -1.0;
  for (Corner c = 3 * triangle; c < 3 * triangle + 3; ++c) {
    const double l =
        (point(mesh, vertex_at(mesh, next_corner(c))) - point(mesh, vertex_at(mesh, c))).squaredNorm();
    if (l > length) {
      length = l;
      best = c;
    }
  }
  return best;
}

/// One pass over the flat triangles. A triangle touched by a change waits for the next pass.
class Round {
 public:
  Round(TriangleMesh& mesh, double flat, Allowance& allowance)
      : mesh_(mesh), flat_(flat), allowance_(allowance), edges_(mesh), first_(mesh.vertices.size() + 1, 0) {
    for (const Triangle& t : mesh.triangles)
      for (const std::int32_t v : t) ++first_[idx(v) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    around_.resize(3 * mesh.triangles.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::int32_t v : mesh.triangles[t]) around_[next[idx(v)]++] = static_cast<std::uint32_t>(t);
    touched_.assign(mesh.triangles.size(), false);
    to_.resize(mesh.vertices.size());
    std::iota(to_.begin(), to_.end(), 0);
  }

  Mended run() {
    const auto count = static_cast<Corner>(mesh_.triangles.size());
    for (Corner t = 0; t < count; ++t) {
      if (touched_[t] || height_of(mesh_, t) >= flat_) continue;
      if (!flip(t)) collapse(t);
    }
    if (renamed_) rename_vertices(mesh_, to_, &allowance_.spent);
    return mended_;
  }

 private:
  /// Flips the longest edge ab, on which c lies. The flat triangle and the one beyond ab share the area
  /// of the latter.
  bool flip(Corner t) {
    const Corner c0 = longest_edge(mesh_, t);
    const std::int32_t a = vertex_at(mesh_, c0);
    const std::int32_t b = vertex_at(mesh_, next_corner(c0));
    const std::int32_t c = vertex_at(mesh_, next_corner(next_corner(c0)));
    if ((point(mesh_, c) - point(mesh_, a)).norm() <= allowance_.reach ||
        (point(mesh_, c) - point(mesh_, b)).norm() <= allowance_.reach)
      return false;
    const auto pair = edges_.at(a, b);
    if (pair.size() != 2) return false;
    const Corner other = pair[0].start / 3 == t ? pair[1].start / 3 : pair[0].start / 3;
    const Triangle beyond = mesh_.triangles[other];
    if (other == t || touched_[other] || height_of(mesh_, other) < flat_) return false;
    const std::int32_t d = beyond[0] + beyond[1] + beyond[2] - a - b;
    const std::pair<std::int32_t, std::int32_t> across = std::minmax(c, d);
    if (d == c || !edges_.at(c, d).empty() || new_edges_.count(across) > 0) return false;
    Triangle one = beyond;
    Triangle two = beyond;
    std::replace(one.begin(), one.end(), a, c);
    std::replace(two.begin(), two.end(), b, c);
    if (height_at(mesh_, one) < flat_ || height_at(mesh_, two) < flat_) return false;
    std::vector<double>& spent = allowance_.spent;
    const double h = height_of(mesh_, t);
    const double moved = std::max(spent[idx(a)], spent[idx(b)]) + h;
    if (!allowance_.allows(moved)) return false;
    spent[idx(c)] = std::max(spent[idx(c)], moved);
    mended_.worst.take(longest_edge_of(mesh_, mesh_.triangles[t]));
    touched_[t] = touched_[other] = true;
    new_edges_.insert(across);
    mesh_.triangles[other] = one;
    mesh_.triangles[t] = two;
    ++mended_.count;
    return true;
  }

  /// Returns the vertices connected to v by an edge, sorted.
  [[nodiscard]] std::vector<std::int32_t> neighbours(std::int32_t v) const {
    std::vector<std::int32_t> ring;
    for (std::uint32_t i = first_[idx(v)]; i < first_[idx(v) + 1]; ++i)
      for (const std::int32_t w : mesh_.triangles[around_[i]])
        if (w != v) ring.push_back(w);
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    return ring;
  }

  /// @returns true if a triangle other than those at edge ab lies along the line from a (or b) to x
  [[nodiscard]] bool is_covered(std::int32_t a, std::int32_t b, std::int32_t x) const {
    for (const std::int32_t v : {a, b}) {
      for (const HalfEdge& e : edges_.at(v, x)) {
        const Triangle& t = mesh_.triangles[e.start / 3];
        if (std::find(t.begin(), t.end(), v == a ? b : a) == t.end()) return true;
      }
    }
    return false;
  }

  /// Merges two corners that are nearly one, if this pinches nothing and turns no triangle over.
  void collapse(Corner t) {
    std::int32_t a = -1;
    std::int32_t b = -1;
    double least = allowance_.reach;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t p = mesh_.triangles[t][k];
      const std::int32_t q = mesh_.triangles[t][(k + 1) % 3];
      const double gap = (point(mesh_, p) - point(mesh_, q)).norm();
      if (gap > least) continue;
      least = gap;
      const Vec3& at_p = point(mesh_, p);
      const Vec3& at_q = point(mesh_, q);
      // The order is by place, not by number, because numbers change when a mesh is read again.
      const bool p_first = std::lexicographical_compare(at_p.begin(), at_p.end(), at_q.begin(), at_q.end());
      a = p_first ? p : q;
      b = p_first ? q : p;
    }
    if (a < 0) return;
    const double moved = allowance_.spent[idx(b)] + least;
    if (!allowance_.allows(moved)) return;
    for (const std::int32_t v : {a, b}) {
      if (first_[idx(v) + 1] - first_[idx(v)] > kMostAround) {
        mended_.complete = false;
        return;
      }
      for (std::uint32_t i = first_[idx(v)]; i < first_[idx(v) + 1]; ++i)
        if (touched_[around_[i]]) return;
    }
    const auto pair = edges_.at(a, b);
    if (pair.size() != 2) return;
    const auto ring_a = neighbours(a);
    const auto ring_b = neighbours(b);
    std::vector<std::int32_t> common;
    std::set_intersection(ring_a.begin(), ring_a.end(), ring_b.begin(), ring_b.end(),
                          std::back_inserter(common));
    if (common.size() != 2 || !is_covered(a, b, common[0]) || !is_covered(a, b, common[1])) return;
    for (std::uint32_t i = first_[idx(b)]; i < first_[idx(b) + 1]; ++i) {
      const Triangle& old = mesh_.triangles[around_[i]];
      if (std::find(old.begin(), old.end(), a) != old.end()) continue;
      Triangle turned = old;
      std::replace(turned.begin(), turned.end(), b, a);
      if (normal(turned).dot(normal(old)) <= 0.0) return;
    }
    for (const std::int32_t v : {a, b})
      for (std::uint32_t i = first_[idx(v)]; i < first_[idx(v) + 1]; ++i) touched_[around_[i]] = true;
    allowance_.spent[idx(a)] = std::max(allowance_.spent[idx(a)], moved);
    to_[idx(b)] = a;
    renamed_ = true;
    mended_.worst.take(longest_edge_of(mesh_, mesh_.triangles[t]));
    ++mended_.count;
  }
  [[nodiscard]] Vec3 normal(const Triangle& t) const {
    return (point(mesh_, t[1]) - point(mesh_, t[0])).cross(point(mesh_, t[2]) - point(mesh_, t[0]));
  }

  /// Greatest number of triangles at a vertex. They are gathered once for every flat triangle there.
  static constexpr std::uint32_t kMostAround = 256;

  TriangleMesh& mesh_;
  double flat_;
  Allowance& allowance_;
  EdgeTable edges_;
  std::vector<std::uint32_t> first_;   ///< start of each vertex in around_
  std::vector<std::uint32_t> around_;  ///< triangles at each vertex, before the pass
  std::vector<bool> touched_;          ///< per triangle
  std::set<std::pair<std::int32_t, std::int32_t>> new_edges_;
  std::vector<std::int32_t> to_;
  bool renamed_ = false;
  Mended mended_;
};

}  // namespace

double height_of(const TriangleMesh& mesh, std::size_t triangle) noexcept {
  return height_at(mesh, mesh.triangles[triangle]);
}

std::size_t count_flat_faces(const TriangleMesh& mesh, double flat) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (height_of(mesh, t) < flat) ++count;
  return count;
}

Spot longest_flat_face(const TriangleMesh& mesh, double flat) {
  Spot longest;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (height_of(mesh, t) < flat) longest.take(longest_edge_of(mesh, mesh.triangles[t]));
  return longest;
}

Mended remove_flat_faces(TriangleMesh& mesh, double flat, Allowance& allowance) {
  Mended mended;
  constexpr std::size_t kMostLookedAt = 20'000'000;  // triangles over all passes but the first
  std::size_t looked_at = 0;
  std::size_t left = count_flat_faces(mesh, flat);
  const std::size_t before = left;
  while (left > 0) {
    if (looked_at > kMostLookedAt) {
      mended.complete = false;
      break;
    }
    const Mended now = Round(mesh, flat, allowance).run();
    mended.complete = mended.complete && now.complete;
    if (now.count == 0) break;
    mended.worst.take(now.worst);
    left = count_flat_faces(mesh, flat);
    looked_at += mesh.triangles.size();
  }
  mended.count = before - std::min(before, left);
  return mended;
}

}  // namespace phalanx::mesh
