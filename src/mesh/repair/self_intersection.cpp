// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/self_intersection.h"

#include <algorithm>
#include <array>

namespace phalanx::mesh {
namespace {

using Points = std::array<Vec3, 3>;

Points points_of(const TriangleMesh& mesh, std::size_t t) {
  const Triangle& c = mesh.triangles[t];
  return {mesh.vertices[idx(c[0])], mesh.vertices[idx(c[1])], mesh.vertices[idx(c[2])]};
}

bool has(const Triangle& t, std::int32_t v) { return t[0] == v || t[1] == v || t[2] == v; }

/// Returns six times the signed volume of a tetrahedron.
double orient(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).cross(c - a).dot(d - a);
}

/// Triangle with the heights of the other's corners above its plane.
struct Sided {
  Points corner;
  std::array<double, 3> height;  ///< heights of the other triangle's corners [m]
};

/// Computes the heights of the corners of `other`.
/// @returns false if the other triangle is wholly on one side
bool measure(Sided& s, const Points& other, double tolerance) {
  const Vec3 normal = (s.corner[1] - s.corner[0]).cross(s.corner[2] - s.corner[0]);
  const double length = normal.norm();
  if (!(length > 0.0)) return false;
  for (std::size_t k = 0; k < 3; ++k) s.height[k] = normal.dot(other[k] - s.corner[0]) / length;
  const auto [low, high] = std::minmax_element(s.height.begin(), s.height.end());
  return *low < -tolerance && *high > tolerance;
}

/// @returns true if edge k of `other` passes through the triangle
bool pierced(const Sided& s, const Points& other, std::size_t k, double tolerance) {
  const std::size_t n = (k + 1) % 3;
  const double from = s.height[k];
  const double to = s.height[n];
  if (!((from > tolerance && to < -tolerance) || (from < -tolerance && to > tolerance))) return false;
  const Vec3& p = other[k];
  const Vec3& q = other[n];
  const double a = orient(p, q, s.corner[0], s.corner[1]);
  const double b = orient(p, q, s.corner[1], s.corner[2]);
  const double c = orient(p, q, s.corner[2], s.corner[0]);
  return (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0);
}

bool cross(const TriangleMesh& mesh, std::size_t i, std::size_t j, double tolerance) {
  const Triangle& ti = mesh.triangles[i];
  const Triangle& tj = mesh.triangles[j];
  int shared = 0;
  for (const std::int32_t v : ti) shared += has(tj, v) ? 1 : 0;
  if (shared >= 2) return false;
  Sided a{points_of(mesh, i), {}};
  Sided b{points_of(mesh, j), {}};
  // In a crossing both triangles reach over the other's plane, unless they share a vertex. Touching
  // is no crossing.
  const bool over_a = measure(a, b.corner, tolerance);
  const bool over_b = measure(b, a.corner, tolerance);
  if (shared == 0 && !(over_a && over_b)) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t n = (k + 1) % 3;
    if (over_a && !has(ti, tj[k]) && !has(ti, tj[n]) && pierced(a, b.corner, k, tolerance)) return true;
    if (over_b && !has(tj, ti[k]) && !has(tj, ti[n]) && pierced(b, a.corner, k, tolerance)) return true;
  }
  return false;
}

/// Returns where the triangle's edges meet the plane above which its corners have these heights.
std::array<Vec3, 2> cut(const Points& corner, const std::array<double, 3>& height) {
  std::array<Vec3, 2> ends{corner[0], corner[0]};
  std::size_t found = 0;
  for (std::size_t k = 0; k < 3 && found < 2; ++k) {
    const std::size_t n = (k + 1) % 3;
    if ((height[k] < 0.0) == (height[n] < 0.0)) continue;
    ends[found++] = corner[k] + (corner[n] - corner[k]) * (height[k] / (height[k] - height[n]));
  }
  if (found == 1) ends[1] = ends[0];
  return ends;
}

/// Returns the line of crossing of two triangles: the common part of their cuts with each other's plane.
Spot line_of_crossing(const TriangleMesh& mesh, std::size_t i, std::size_t j) {
  Sided a{points_of(mesh, i), {}};
  Sided b{points_of(mesh, j), {}};
  (void)measure(a, b.corner, 0.0);
  (void)measure(b, a.corner, 0.0);
  const std::array<Vec3, 2> of_b = cut(b.corner, a.height);
  const std::array<Vec3, 2> of_a = cut(a.corner, b.height);
  const Vec3 step = of_b[1] - of_b[0];
  const double length = step.norm();
  Spot spot;
  if (!(length > 0.0)) {
    spot.take(0.0, of_b[0]);
    return spot;
  }
  const auto along = [&](const Vec3& p) { return (p - of_b[0]).dot(step) / length; };
  const double one = along(of_a[0]);
  const double two = along(of_a[1]);
  const double low = std::min(one, two);
  const double high = std::max(one, two);
  const double from = std::clamp(low, 0.0, length);
  const double to = std::clamp(high, from, length);
  spot.take(to - from, of_b[0] + step * (0.5 * (from + to) / length));
  return spot;
}

void make_unique(ShellPairs& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

}  // namespace

SelfIntersections find_self_intersections(const TriangleMesh& mesh, const Shells& shells, const BoxTree& tree,
                                          double tolerance) {
  SelfIntersections found;
  std::size_t room = 1024;
  // An ordinary mesh has some 7 pairs a triangle; a heap of long triangles has all pairs.
  const std::size_t most_pairs = 3'000'000 + 20 * mesh.triangles.size();
  std::size_t looked_at = 0;
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    if (looked_at > most_pairs) {
      found.complete = false;
      break;
    }
    tree.overlapping(tree.box(i), [&](std::uint32_t j) {
      if (j <= i || looked_at > most_pairs) return;
      ++looked_at;
      if (!cross(mesh, i, j, tolerance)) return;
      ++found.pairs;
      found.longest.take(line_of_crossing(mesh, i, j));
      if (shells.of[i] == shells.of[j]) return;
      found.between_shells.emplace_back(std::minmax(shells.of[i], shells.of[j]));
      if (found.between_shells.size() < room) return;
      make_unique(found.between_shells);
      room = std::max(room, 2 * found.between_shells.size());
    });
  }
  make_unique(found.between_shells);
  return found;
}

}  // namespace phalanx::mesh
