// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/corner_normals.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <string>

namespace phalanx {
namespace {

/// Corner of a triangle: 3 * triangle + k.
using Corner = std::size_t;

/// Half edge, stored at the lower of its two vertices.
struct HalfEdge {
  std::int32_t high;  // the higher vertex
  Corner start;       // the edge runs from this corner to the next one of its triangle
  friend bool operator<(const HalfEdge& a, const HalfEdge& b) {
    return a.high != b.high ? a.high < b.high : a.start < b.start;
  }
};

Corner next(Corner c) { return c % 3 == 2 ? c - 2 : c + 1; }

class Groups {
 public:
  explicit Groups(std::size_t n) : parent_(n), alone_(n, true) {
    for (std::size_t i = 0; i < n; ++i) parent_[i] = i;
  }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// @returns true if the member was never joined with another
  [[nodiscard]] bool alone(std::size_t i) const { return alone_[i]; }
  void join(std::size_t a, std::size_t b) {
    alone_[a] = alone_[b] = false;
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
  std::vector<bool> alone_;
};

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Returns the unit normals of the faces, or zero for a face so low that rounding would turn its normal.
std::vector<Vec3> face_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> face(mesh.triangles.size(), Vec3::Zero());
  const Bounds box = bounds(mesh);
  const double noise = 0x1p-22 * (box.max - box.min).maxCoeff();  // files have single precision
  for (std::size_t t = 0; t < face.size(); ++t) {
    const auto point = [&](std::size_t k) -> const Vec3& {
      return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
    };
    Vec3 e1 = point(1) - point(0);
    Vec3 e2 = point(2) - point(0);
    const double longest = std::max(e1.cwiseAbs().maxCoeff(), e2.cwiseAbs().maxCoeff());
    if (!(longest > 0.0)) continue;
    e1 /= longest;  // scaling keeps the product of a small triangle's edges above 0
    e2 /= longest;
    const Vec3 normal = e1.cross(e2);
    const double twice_area = normal.norm();
    if (twice_area > std::max(1e-6, noise / longest)) face[t] = normal / twice_area;
  }
  return face;
}

/// Pairs of half edges in a fixed order.
struct SharedEdges {
  /// Edges that two triangles with an area share.
  std::vector<std::pair<Corner, Corner>> two;
  /// A triangle without area in such an edge, and one of the two triangles.
  std::vector<std::pair<Corner, Corner>> hanging;
};

/// Half edges in the order of their lower vertex, higher vertex and corner. Those of the lower vertex v are
/// [first[v], first[v + 1]).
struct SortedHalfEdges {
  std::vector<std::size_t> first;
  std::vector<HalfEdge> edge;
};

/// Sorts the half edges by counting, then vertex by vertex, which is faster than one large sort.
SortedHalfEdges sorted_half_edges(const TriangleMesh& mesh) {
  const auto for_each = [&](const auto& visit) {
    for (Corner c = 0; c < 3 * mesh.triangles.size(); ++c) {
      const std::int32_t a = mesh.triangles[c / 3][c % 3];
      const std::int32_t b = mesh.triangles[c / 3][next(c) % 3];
      if (a != b) visit(static_cast<std::size_t>(std::min(a, b)), HalfEdge{std::max(a, b), c});
    }
  };
  SortedHalfEdges out;
  // Counts are stored two places higher, so that filling moves first[v + 1] from the start to the end of v.
  out.first.assign(mesh.vertices.size() + 2, 0);
  for_each([&](std::size_t low, const HalfEdge&) { ++out.first[low + 2]; });
  for (std::size_t v = 2; v < out.first.size(); ++v) out.first[v] += out.first[v - 1];
  out.edge.resize(out.first.back());
  for_each([&](std::size_t low, const HalfEdge& e) { out.edge[out.first[low + 1]++] = e; });
  out.first.pop_back();
  const auto edge = [&](std::size_t i) { return out.edge.begin() + static_cast<std::ptrdiff_t>(i); };
  for (std::size_t v = 0; v + 1 < out.first.size(); ++v)
    std::sort(edge(out.first[v]), edge(out.first[v + 1]));
  return out;
}

SharedEdges shared_edges(const TriangleMesh& mesh, const std::vector<Vec3>& face) {
  const auto [first, edges] = sorted_half_edges(mesh);
  SharedEdges out;
  std::vector<Corner> solid;
  std::vector<Corner> flat;
  for (std::size_t v = 0; v + 1 < first.size(); ++v) {
    for (std::size_t i = first[v]; i < first[v + 1];) {
      solid.clear();
      flat.clear();
      std::size_t end = i;
      for (; end < first[v + 1] && edges[end].high == edges[i].high; ++end)
        (face[edges[end].start / 3].isZero(0.0) ? flat : solid).push_back(edges[end].start);
      if (end - i == 2) {
        out.two.emplace_back(edges[i].start, edges[i + 1].start);
      } else if (solid.size() == 2) {
        out.two.emplace_back(solid[0], solid[1]);
        for (const Corner c : flat) out.hanging.emplace_back(c, solid[0]);
      }
      i = end;
    }
  }
  return out;
}

/// Gives triangles without a normal that of a neighbour. Normals spread front by front, each front in the
/// edges' order. O(n log n).
void spread_normals(const SharedEdges& edges, std::vector<Vec3>& face) {
  for (const auto& [hanging, solid] : edges.hanging) face[hanging / 3] = face[solid / 3];
  const auto has_normal = [&](Corner c) { return !face[c / 3].isZero(0.0); };
  std::vector<std::size_t> front;                            // edges with a normal on one side only
  std::vector<std::pair<std::size_t, std::size_t>> waiting;  // triangles without a normal, and their edges
  for (std::size_t e = 0; e < edges.two.size(); ++e) {
    const auto& [a, b] = edges.two[e];
    if (!has_normal(a)) waiting.emplace_back(a / 3, e);
    if (!has_normal(b)) waiting.emplace_back(b / 3, e);
    if (has_normal(a) != has_normal(b)) front.push_back(e);
  }
  std::sort(waiting.begin(), waiting.end());
  std::vector<std::pair<std::size_t, Vec3>> found;
  while (!front.empty()) {
    found.clear();
    for (const std::size_t e : front) {
      const auto& [a, b] = edges.two[e];
      if (has_normal(a) && !has_normal(b)) found.emplace_back(b / 3, face[a / 3]);
      if (has_normal(b) && !has_normal(a)) found.emplace_back(a / 3, face[b / 3]);
    }
    front.clear();
    for (const auto& [t, normal] : found) {
      if (!face[t].isZero(0.0)) continue;
      face[t] = normal;
      const auto first = std::lower_bound(waiting.begin(), waiting.end(), std::pair{t, std::size_t{0}});
      for (auto own = first; own != waiting.end() && own->first == t; ++own) front.push_back(own->second);
    }
    std::sort(front.begin(), front.end());
    front.erase(std::unique(front.begin(), front.end()), front.end());
  }
}

}  // namespace

SurfaceNormals surface_normals(const TriangleMesh& mesh, double crease_angle) {
  check_mesh(mesh, "surface_normals");
  if (!(crease_angle >= 0.0 && crease_angle <= std::numbers::pi))
    throw std::invalid_argument("surface_normals: crease_angle is " + std::to_string(crease_angle) +
                                " rad; give 0 to pi");
  // A tube of twelve sides is folded by 30 degrees to rounding. The tolerance keeps noise from
  // choosing its creases.
  const double smooth_below = crease_angle > 0.0 ? crease_angle + 1e-6 : 0.0;
  constexpr double kFoldedBack = 91.0 * std::numbers::pi / 180.0;
  const std::size_t count = mesh.triangles.size();
  const auto vertex_of = [&](Corner c) { return mesh.triangles[c / 3][c % 3]; };
  const auto point = [&](Corner c) -> const Vec3& {
    return mesh.vertices[static_cast<std::size_t>(vertex_of(c))];
  };
  const std::vector<Vec3> own = face_normals(mesh);
  const SharedEdges edges = shared_edges(mesh, own);
  std::vector<Vec3> face = own;
  spread_normals(edges, face);

  // Corners of one vertex that a smooth edge connects form a group.
  SurfaceNormals out{.corner = std::vector<std::array<Vec3, 3>>(count),
                     .open_edges = std::vector<std::uint8_t>(count, 7)};
  Groups groups(3 * count);
  for (const auto& [a, b] : edges.two) {
    if (vertex_of(a) != vertex_of(next(b))) continue;  // not as on an oriented surface
    const double angle = angle_between(face[a / 3], face[b / 3]);
    if (!(angle > kFoldedBack)) {
      for (const Corner c : {a, b}) out.open_edges[c / 3] &= static_cast<std::uint8_t>(~(1U << c % 3));
    }
    if (!(angle < smooth_below)) continue;
    groups.join(a, next(b));
    groups.join(next(a), b);
  }
  for (const auto& [a, b] : edges.hanging) {
    const bool alike = vertex_of(a) == vertex_of(b);
    groups.join(a, alike ? b : next(b));
    groups.join(next(a), alike ? next(b) : b);
  }
  for (std::size_t t = 0; t < count; ++t) {
    if (own[t].isZero(0.0)) out.open_edges[t] = 0;  // a triangle without area has no rim
  }
  std::vector<Vec3> sum(3 * count, Vec3::Zero());
  for (Corner c = 0; c < 3 * count; ++c) {
    if (own[c / 3].isZero(0.0)) continue;  // no area, no weight
    const double angle = angle_between(point(next(c)) - point(c), point(next(next(c))) - point(c));
    sum[groups.root(c)] += angle * face[c / 3];
  }
  for (Corner c = 0; c < 3 * count; ++c) {
    const Vec3& s = sum[groups.root(c)];
    const double length = s.norm();
    const Vec3& fallback = face[c / 3];
    if (length > 1e-12 && !groups.alone(c)) {  // alone: exactly the face's own normal
      out.corner[c / 3][c % 3] = s / length;
    } else {
      out.corner[c / 3][c % 3] = fallback.isZero(0.0) ? Vec3(Vec3::UnitZ()) : fallback;
    }
  }
  return out;
}

std::vector<std::array<Vec3, 3>> corner_normals(const TriangleMesh& mesh, double crease_angle) {
  return surface_normals(mesh, crease_angle).corner;
}

}  // namespace phalanx
