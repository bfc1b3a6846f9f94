// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/open_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "mesh/repair/box_tree.h"

namespace phalanx::mesh {
namespace {

constexpr std::uint32_t kNoEdge = std::numeric_limits<std::uint32_t>::max();

/// Open edge in the direction of its triangle.
struct Rim {
  std::int32_t from;
  std::int32_t to;
  std::uint32_t triangle;
  Vec3 start;
  Vec3 step;   ///< vector to the end [m]
  Vec3 along;  ///< unit
  Vec3 into;   ///< unit vector into the triangle's surface, across the edge; zero if it has no area
  double length = 0.0;
  std::uint32_t across = kNoEdge;  ///< the opposite edge of a slit
  Spot gap;                        ///< width of the slit
  [[nodiscard]] Vec3 middle() const { return start + 0.5 * step; }
};

std::vector<Rim> rims_of(const TriangleMesh& mesh, const EdgeTable& edges) {
  std::vector<Rim> rims;
  edges.for_each([&](std::span<const HalfEdge> edge) {
    if (edge.size() != 1) return;
    const Corner c = edge[0].start;
    Rim r{};
    r.from = vertex_at(mesh, c);
    r.to = vertex_at(mesh, next_corner(c));
    r.triangle = c / 3;
    r.start = mesh.vertices[idx(r.from)];
    r.step = mesh.vertices[idx(r.to)] - r.start;
    r.length = r.step.norm();
    r.along = r.length > 0.0 ? Vec3(r.step / r.length) : Vec3(Vec3::Zero());
    const Vec3 apex = mesh.vertices[idx(vertex_at(mesh, next_corner(next_corner(c))))] - r.start;
    const Vec3 up = apex - r.along * r.along.dot(apex);
    const double height = up.norm();
    r.into = height > 0.0 ? Vec3(up / height) : Vec3(Vec3::Zero());
    rims.push_back(r);
  });
  return rims;
}

BoxTree boxes_of(const std::vector<Rim>& rims) {
  std::vector<FloatBox> boxes;
  boxes.reserve(rims.size());
  for (const Rim& r : rims) {
    const Vec3 end = r.start + r.step;
    boxes.push_back(outward(r.start.cwiseMin(end), r.start.cwiseMax(end)));
  }
  return BoxTree(std::move(boxes));
}

/// Limit on the number of examined pairs.
struct Budget {
  std::size_t left = 20'000'000;
  bool spend() {
    if (left == 0) return false;
    --left;
    return true;
  }
};

/// Finds the nearest open edge that faces the point `p` of rim `i`: the gap between them is free
/// of both surfaces.
/// @param gap  set to the vector to that edge
/// @returns its number, or kNoEdge
std::uint32_t facing(const std::vector<Rim>& rims, const BoxTree& tree, std::uint32_t i, const Vec3& p,
                     Vec3& gap, Budget& budget) {
  constexpr double kHalf = 0.5;  // cosine: 60 degrees
  const Rim& own = rims[i];
  double least = kSlit;
  std::uint32_t best = kNoEdge;
  const auto may_hit = [&](const FloatBox& b) {
    if (budget.left == 0) return false;
    double squared = 0.0;
    for (int k = 0; k < 3; ++k) {
      const auto j = static_cast<std::size_t>(k);
      const double d =
          std::max({static_cast<double>(b.min[j]) - p[k], p[k] - static_cast<double>(b.max[j]), 0.0});
      squared += d * d;
    }
    return squared < least * least;
  };
  tree.walk(may_hit, [&](std::uint32_t j) {
    const Rim& other = rims[j];
    if (!budget.spend() || j == i || other.from == own.from || other.from == own.to || other.to == own.from ||
        other.to == own.to)
      return;
    const double s = std::clamp((p - other.start).dot(other.along), 0.0, other.length);
    const Vec3 g = other.start + s * other.along - p;
    const double width = g.norm();
    if (!(width < least) || own.into.dot(g) > kHalf * width || other.into.dot(-g) > kHalf * width ||
        std::abs(own.along.dot(g)) > kHalf * width || std::abs(other.along.dot(g)) > kHalf * width)
      return;
    least = width;
    best = j;
    gap = g;
  });
  return best;
}

void find_slits(std::vector<Rim>& rims, Budget& budget) {
  const BoxTree tree = boxes_of(rims);
  for (std::uint32_t i = 0; i < rims.size(); ++i) {
    int met = 0;
    std::uint32_t across = kNoEdge;
    Spot widest;
    for (const double s : {1.0 / 6.0, 0.5, 5.0 / 6.0}) {
      const Vec3 p = rims[i].start + s * rims[i].step;
      Vec3 gap = Vec3::Zero();
      const std::uint32_t j = facing(rims, tree, i, p, gap, budget);
      if (j == kNoEdge) continue;
      ++met;
      across = j;
      widest.take(gap.norm(), p + 0.5 * gap);
    }
    if (met < 2) continue;
    rims[i].across = across;
    rims[i].gap = widest;
  }
}

/// Joins the rims to lines: rims of slits, and the others.
DisjointSets join(const std::vector<Rim>& rims, Budget& budget) {
  DisjointSets lines(rims.size());
  std::map<std::int32_t, std::array<std::uint32_t, 2>> at;  // at each vertex: a free rim, a rim of a slit
  for (std::uint32_t i = 0; i < rims.size(); ++i) {
    const bool slit = rims[i].across != kNoEdge;
    for (const std::int32_t v : {rims[i].from, rims[i].to}) {
      auto& here = at.try_emplace(v, std::array<std::uint32_t, 2>{kNoEdge, kNoEdge}).first->second;
      std::uint32_t& same = here[slit ? 1 : 0];
      if (same == kNoEdge) {
        same = i;
      } else {
        lines.join(same, i);
      }
    }
    if (slit && rims[rims[i].across].across != kNoEdge) lines.join(i, rims[i].across);
  }
  // A line that a slit interrupts continues beyond it.
  std::vector<FloatBox> ends;
  std::vector<std::uint32_t> rim_at;
  std::vector<Vec3> place;
  for (const auto& [v, here] : at) {
    if (here[0] == kNoEdge || here[1] == kNoEdge) continue;
    const Rim& r = rims[here[0]];
    place.push_back(r.from == v ? r.start : Vec3(r.start + r.step));
    ends.push_back(outward(place.back(), place.back()));
    rim_at.push_back(here[0]);
  }
  const BoxTree tree(std::move(ends));
  for (std::size_t e = 0; e < place.size() && budget.left > 0; ++e) {
    const Vec3 reach = Vec3::Constant(kSlit);
    tree.overlapping(outward(place[e] - reach, place[e] + reach), [&](std::uint32_t other) {
      if (budget.spend() && (place[other] - place[e]).norm() < kSlit) lines.join(rim_at[e], rim_at[other]);
    });
  }
  return lines;
}

/// Connected line of open edges.
struct Line {
  double length = 0.0;
  Vec3 moment = Vec3::Zero();  ///< sum of middle x length
  Vec3 area = Vec3::Zero();    ///< twice its area vector
  double inwards = 0.0;        ///< sum of cosine x length
  bool two_sided = true;
  std::vector<std::uint32_t> rims;
};

/// Returns the least extent across the line's area vector.
double width_of(const Line& line, const std::vector<Rim>& rims, const Vec3& n) {
  std::uint32_t longest = line.rims.front();
  for (const std::uint32_t i : line.rims)
    if (rims[i].length > rims[longest].length) longest = i;
  Vec3 u = rims[longest].along - n * n.dot(rims[longest].along);
  if (!(u.norm() > 1e-6)) u = n.unitOrthogonal();
  u.normalize();
  const Vec3 v = n.cross(u);
  double least = std::numeric_limits<double>::infinity();
  constexpr int kDirections = 36;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = std::numbers::pi * k / kDirections;
    const Vec3 d = std::cos(angle) * u + std::sin(angle) * v;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const std::uint32_t i : line.rims) {
      const double a = d.dot(rims[i].start);
      const double b = d.dot(rims[i].start + rims[i].step);
      low = std::min({low, a, b});
      high = std::max({high, a, b});
    }
    least = std::min(least, high - low);
  }
  return least;
}

void add(OpenLines& lines, double length, double width, const Vec3& at) {
  ++lines.count;
  lines.longest = std::max(lines.longest, length);
  lines.widest.take(width, at);
}

}  // namespace

OpenEdges find_open_edges(const TriangleMesh& mesh, const EdgeTable& edges, const Shells& shells) {
  std::vector<Rim> rims = rims_of(mesh, edges);
  OpenEdges result;
  if (rims.empty()) return result;
  Budget budget;
  find_slits(rims, budget);
  DisjointSets sets = join(rims, budget);
  result.complete = budget.left > 0;
  std::map<std::uint32_t, Line> lines;
  for (std::uint32_t i = 0; i < rims.size(); ++i) {
    const Rim& r = rims[i];
    Line& line = lines[sets.root(i)];
    line.length += r.length;
    line.moment += r.length * r.middle();
    line.two_sided = line.two_sided && shells.shell[shells.of[r.triangle]].two_sided;
    line.rims.push_back(i);
  }
  for (auto& [name, line] : lines) {
    const Vec3 centre = line.moment / line.length;
    if (rims[name].across != kNoEdge) {
      Spot widest;
      for (const std::uint32_t i : line.rims) widest.take(rims[i].gap);
      add(result.slits, line.length, widest.size, widest.at);
      continue;
    }
    for (const std::uint32_t i : line.rims) line.area += (rims[i].start - centre).cross(rims[i].step);
    const bool flat = line.area.norm() > 1e-9 * line.length * line.length;
    const Vec3 n = flat ? Vec3(line.area.normalized()) : Vec3(rims[line.rims.front()].along.unitOrthogonal());
    for (const std::uint32_t i : line.rims)
      line.inwards += rims[i].length * n.cross(rims[i].along).dot(rims[i].into);
    constexpr double kInwards = 0.5;  // cosine: 60 degrees
    if (!line.two_sided || (flat && line.inwards > kInwards * line.length)) {
      const auto longest = *std::max_element(
          line.rims.begin(), line.rims.end(),
          [&](std::uint32_t a, std::uint32_t b) { return rims[a].length < rims[b].length; });
      add(result.outlines, line.length, line.length, rims[longest].middle());
      continue;
    }
    const double width = width_of(line, rims, n);
    add(width < kSlit ? result.slits : result.holes, line.length, width, centre);
  }
  return result;
}

CrowdedEdges find_crowded_edges(const TriangleMesh& mesh, const EdgeTable& edges) {
  CrowdedEdges crowded;
  edges.for_each([&](std::span<const HalfEdge> edge) {
    if (edge.size() < 3) return;
    const Vec3& a = mesh.vertices[idx(edge[0].low)];
    const Vec3& b = mesh.vertices[idx(edge[0].high)];
    ++crowded.count;
    crowded.length += (b - a).norm();
    crowded.longest.take((b - a).norm(), 0.5 * (a + b));
  });
  return crowded;
}

}  // namespace phalanx::mesh
