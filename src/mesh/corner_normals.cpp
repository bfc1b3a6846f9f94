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

/// A triangle's corner: 3 * triangle + k.
using Corner = std::size_t;

struct HalfEdge {
  std::int32_t low;
  std::int32_t high;
  Corner start;  // runs from this corner to the next one of its triangle
  friend bool operator<(const HalfEdge& a, const HalfEdge& b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.start < b.start;
  }
};

Corner next(Corner c) { return c % 3 == 2 ? c - 2 : c + 1; }

class Groups {
 public:
  explicit Groups(std::size_t n) : parent_(n) {
    for (std::size_t i = 0; i < n; ++i) parent_[i] = i;
  }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Edges between exactly two triangles, as pairs of half edges in a fixed order.
std::vector<std::pair<Corner, Corner>> shared_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = mesh.triangles[t][k];
      const std::int32_t b = mesh.triangles[t][(k + 1) % 3];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b), 3 * t + k});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<std::pair<Corner, Corner>> pairs;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    if (end - i == 2) pairs.emplace_back(edges[i].start, edges[i + 1].start);
    i = end;
  }
  return pairs;
}

}  // namespace

std::vector<std::array<Vec3, 3>> corner_normals(const TriangleMesh& mesh, double crease_angle) {
  check_mesh(mesh, "corner_normals");
  if (!(crease_angle >= 0.0 && crease_angle <= std::numbers::pi))
    throw std::invalid_argument("corner_normals: crease_angle is " + std::to_string(crease_angle) +
                                " rad; give 0 to pi");
  const std::size_t count = mesh.triangles.size();
  const auto vertex_of = [&](Corner c) { return mesh.triangles[c / 3][c % 3]; };
  const auto point = [&](Corner c) -> const Vec3& {
    return mesh.vertices[static_cast<std::size_t>(vertex_of(c))];
  };

  std::vector<Vec3> face(count, Vec3::Zero());
  for (std::size_t t = 0; t < count; ++t) {
    Vec3 e1 = point(3 * t + 1) - point(3 * t);
    Vec3 e2 = point(3 * t + 2) - point(3 * t);
    const double longest = std::max(e1.cwiseAbs().maxCoeff(), e2.cwiseAbs().maxCoeff());
    if (!(longest > 0.0)) continue;
    e1 /= longest;  // scaled, so that the product of a small triangle's edges does not vanish
    e2 /= longest;
    const Vec3 normal = e1.cross(e2);
    const double twice_area = normal.norm();
    if (twice_area > 1e-14) face[t] = normal / twice_area;
  }

  // A degenerate triangle has no normal of its own: spread the neighbours' into it, front by front.
  const auto edges = shared_edges(mesh);
  const std::vector<Vec3> own = face;
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<std::pair<std::size_t, Vec3>> found;
    for (const auto& [a, b] : edges) {
      const bool has_a = !face[a / 3].isZero(0.0);
      const bool has_b = !face[b / 3].isZero(0.0);
      if (has_a && !has_b) found.emplace_back(b / 3, face[a / 3]);
      if (has_b && !has_a) found.emplace_back(a / 3, face[b / 3]);
    }
    for (const auto& [t, normal] : found) {
      if (!face[t].isZero(0.0)) continue;
      face[t] = normal;
      changed = true;
    }
  }

  // Corners of one vertex that a smooth edge connects belong together.
  Groups groups(3 * count);
  for (const auto& [a, b] : edges) {
    const bool opposite = vertex_of(a) == vertex_of(next(b));  // as on an oriented surface
    if (!opposite || !(angle_between(face[a / 3], face[b / 3]) < crease_angle)) continue;
    groups.join(a, next(b));
    groups.join(next(a), b);
  }
  std::vector<Vec3> sum(3 * count, Vec3::Zero());
  for (Corner c = 0; c < 3 * count; ++c) {
    if (own[c / 3].isZero(0.0)) continue;  // no area, no weight
    const double angle = angle_between(point(next(c)) - point(c), point(next(next(c))) - point(c));
    sum[groups.root(c)] += angle * face[c / 3];
  }
  std::vector<std::array<Vec3, 3>> normals(count);
  for (Corner c = 0; c < 3 * count; ++c) {
    const Vec3& s = sum[groups.root(c)];
    const double length = s.norm();
    const Vec3& fallback = face[c / 3];
    if (length > 1e-12) {
      normals[c / 3][c % 3] = s / length;
    } else {
      normals[c / 3][c % 3] = fallback.isZero(0.0) ? Vec3(Vec3::UnitZ()) : fallback;
    }
  }
  return normals;
}

}  // namespace phalanx
