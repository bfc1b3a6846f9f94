// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/shells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "mesh/repair/triangle_measures.h"

namespace phalanx::mesh {
namespace {

/// Returns +1 if the triangle runs through the edge from its lower to its higher vertex, else -1.
int direction(const TriangleMesh& mesh, const HalfEdge& e) {
  return vertex_at(mesh, e.start) == e.low ? 1 : -1;
}

/// Returns for each group of triangles whether it runs through each edge as often one way as the other.
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
      if (edge.size() == 2 && sum == 0) break;  // the ordinary edge
      if (edge.size() > 64) {                   // all at once: a fan of thousands takes too long
        for (const HalfEdge& other : edge) closed[group[other.start / 3]] = false;
        break;
      }
    }
  });
  return closed;
}

/// Counts the other shells that contain a shell.
class Containment {
 public:
  Containment(const TriangleMesh& mesh, const Shells& shells, const BoxTree& tree, const ShellPairs& crossing,
              double tolerance)
      : mesh_(mesh), shells_(shells), tree_(tree), crossing_(crossing), tolerance_(tolerance) {
    std::vector<std::uint32_t> next(shells.shell.size() + 1, 0);
    for (const std::uint32_t s : shells.of) ++next[s + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    first_ = next;
    triangles_.resize(shells.of.size());
    for (std::size_t t = 0; t < shells.of.size(); ++t)
      triangles_[next[shells.of[t]]++] = static_cast<std::uint32_t>(t);
  }

  /// Returns the number of closed shells that contain the shell, or nothing if that takes too long.
  std::optional<int> depth(std::uint32_t shell) {
    if (work_ > kMostWork) return std::nullopt;
    const Start start = find_start(shell);
    // Directions oblique to the usual axes of drawings. If one grazes an edge, the next one is used.
    constexpr std::array<std::array<double, 3>, 5> kDirections = {{{0.61803, 0.37139, 0.69317},
                                                                   {-0.29413, 0.83147, 0.47129},
                                                                   {0.17321, -0.59237, 0.78683},
                                                                   {-0.71317, -0.22361, -0.66433},
                                                                   {0.44721, 0.13579, -0.88411}}};
    for (const auto& d : kDirections) {
      if (work_ > kMostWork) return std::nullopt;
      const auto hits = crossings(shell, start.at, Vec3(d[0], d[1], d[2]).normalized());
      if (!hits) continue;
      int depth = 0;
      for (std::size_t i = 0; i < hits->size();) {
        const std::uint32_t other = (*hits)[i].first;
        int sum = 0;
        for (; i < hits->size() && (*hits)[i].first == other; ++i) sum += (*hits)[i].second;
        const std::pair<std::uint32_t, std::uint32_t> pair = std::minmax(shell, other);
        if (sum != 0 && !std::binary_search(start.touched.begin(), start.touched.end(), other) &&
            !std::binary_search(crossing_.begin(), crossing_.end(), pair))
          ++depth;
      }
      return depth;
    }
    return 0;
  }

 private:
  /// Point of a shell, and the closed shells within the tolerance of it, sorted.
  struct Start {
    Vec3 at;
    std::vector<std::uint32_t> touched;
  };

  [[nodiscard]] const Vec3& corner(std::uint32_t triangle, std::size_t k) const {
    return mesh_.vertices[idx(mesh_.triangles[triangle][k])];
  }

  std::vector<std::uint32_t> touched_at(std::uint32_t own, const Vec3& p) {
    std::vector<std::uint32_t> touched;
    const Vec3 wider = Vec3::Constant(tolerance_);
    tree_.overlapping(outward(p - wider, p + wider), [&](std::uint32_t t) {
      const std::uint32_t shell = shells_.of[t];
      ++work_;
      if (shell == own || !shells_.shell[shell].closed) return;
      const Vec3 nearest = nearest_on_triangle(p, corner(t, 0), corner(t, 1), corner(t, 2));
      if ((nearest - p).norm() <= tolerance_) touched.push_back(shell);
    });
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    return touched;
  }

  /// Returns the middle, or else a corner, of a triangle that touches no other shell. If there is none among
  /// those tried, returns the one that touches the fewest.
  Start find_start(std::uint32_t shell) {
    constexpr std::uint32_t kTried = 64;
    const std::uint32_t count = first_[shell + 1] - first_[shell];
    const std::uint32_t tried = std::min(count, kTried);
    std::optional<Start> best;
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::uint32_t i = 0; i < tried; ++i) {
        // The tried triangles are spread over the shell.
        const std::uint32_t t =
            triangles_[first_[shell] + static_cast<std::uint32_t>(std::uint64_t{i} * count / tried)];
        const Vec3 at = k == 0 ? Vec3((corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0) : corner(t, k - 1);
        std::vector<std::uint32_t> touched = touched_at(shell, at);
        if (best && touched.size() >= best->touched.size()) continue;
        best = Start{at, std::move(touched)};
        if (best->touched.empty() || work_ > kMostWork) return *best;
      }
    }
    return *best;
  }

  /// Returns the closed shells that a ray crosses, with +1 for each crossing outwards and -1 inwards, sorted
  /// by shell. Returns nothing if it grazes an edge.
  std::optional<std::vector<std::pair<std::uint32_t, int>>> crossings(std::uint32_t own, const Vec3& from,
                                                                      const Vec3& along) {
    std::vector<std::pair<std::uint32_t, int>> hits;
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
    tree_.walk(may_hit, [&](std::uint32_t t) {
      const std::uint32_t shell = shells_.of[t];
      ++work_;
      if (shell == own || !shells_.shell[shell].closed) return;
      const Vec3& a = corner(t, 0);
      const Vec3 u = corner(t, 1) - a;
      const Vec3 v = corner(t, 2) - a;
      const Vec3 normal = u.cross(v);
      const double area = normal.norm();
      const double slope = normal.dot(along);
      if (area == 0.0) return;
      constexpr double kGrazing = 1e-9;
      if (std::abs(slope) <= kGrazing * area) {
        // A ray in the triangle's plane is harmless unless it runs through the triangle.
        grazed = grazed || std::abs((from - a).dot(normal)) <= kGrazing * area * std::sqrt(area);
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
      hits.emplace_back(shell, slope > 0.0 ? 1 : -1);
    });
    if (grazed) return std::nullopt;
    std::sort(hits.begin(), hits.end());
    return hits;
  }

  /// Limit on the number of examined triangles of all shells together: some seconds.
  static constexpr std::size_t kMostWork = 30'000'000;

  const TriangleMesh& mesh_;
  const Shells& shells_;
  const BoxTree& tree_;
  const ShellPairs& crossing_;
  double tolerance_;
  std::vector<std::uint32_t> first_;      ///< start of each shell in triangles_
  std::vector<std::uint32_t> triangles_;  ///< by shell
  std::size_t work_ = 0;
};

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

TurnedShells turn_shells_outward(TriangleMesh& mesh, Shells& shells, const BoxTree& tree,
                                 const ShellPairs& crossing, double tolerance) {
  TurnedShells turned;
  std::vector<bool> turn(shells.shell.size(), false);
  const auto closed =
      std::count_if(shells.shell.begin(), shells.shell.end(), [](const Shell& s) { return s.closed; });
  std::optional<Containment> containment;
  if (closed > 1) containment.emplace(mesh, shells, tree, crossing, tolerance);
  for (std::uint32_t s = 0; s < turn.size(); ++s) {
    Shell& shell = shells.shell[s];
    if (!shell.closed) continue;
    const std::optional<int> depth = containment ? containment->depth(s) : 0;
    if (!depth) {
      shell.cavity = shell.volume < 0.0;  // as the winding states
      turned.complete = false;
      continue;
    }
    shell.cavity = *depth % 2 == 1;
    turn[s] = shell.cavity ? shell.volume > 0.0 : shell.volume < 0.0;
  }
  for (std::size_t s = 0; s < turn.size(); ++s) {
    if (!turn[s]) continue;
    shells.shell[s].volume = -shells.shell[s].volume;
    ++turned.count;
    const Shell& shell = shells.shell[s];
    turned.largest.take((shell.box.max - shell.box.min).maxCoeff(),
                        centroid(mesh, mesh.triangles[shell.first]));
  }
  if (turned.count == 0) return turned;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!turn[shells.of[t]]) continue;
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    turned.area += area_of(mesh, mesh.triangles[t]);
  }
  return turned;
}

}  // namespace phalanx::mesh
