// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/triangle_measures.h"

#include <algorithm>

namespace phalanx::mesh {
namespace {

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) noexcept {
  const Vec3 edge = b - a;
  const double squared = edge.squaredNorm();
  const double s = squared > 0.0 ? std::clamp((p - a).dot(edge) / squared, 0.0, 1.0) : 0.0;
  return a + s * edge;
}

}  // namespace

Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  const Vec3 u = b - a;
  const Vec3 v = c - a;
  const Vec3 normal = u.cross(v);
  const double squared = normal.squaredNorm();
  if (squared > 0.0) {
    const Vec3 w = p - a;
    const double b1 = w.cross(v).dot(normal) / squared;
    const double b2 = u.cross(w).dot(normal) / squared;
    if (b1 >= 0.0 && b2 >= 0.0 && b1 + b2 <= 1.0) return a + b1 * u + b2 * v;
  }
  Vec3 best = nearest_on_segment(p, a, b);
  for (const Vec3& q : {nearest_on_segment(p, b, c), nearest_on_segment(p, c, a)})
    if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  return best;
}

}  // namespace phalanx::mesh
