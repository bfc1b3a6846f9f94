// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/triangle_distance.h"

#include <algorithm>

#include "contact/feature_pairs.h"

namespace phalanx {

TriangleDistance triangle_distance(const Corners& a, const Corners& b) noexcept {
  TriangleDistance best{(a[0] - b[0]).squaredNorm(), a[0], b[0]};
  for_each_feature_pair(a, b, [&](const Vec3& on_a, const Vec3& on_b) {
    const double squared = (on_a - on_b).squaredNorm();
    if (squared < best.squared) best = {squared, on_a, on_b};
  });
  return best;
}

Vec3 barycentric(const Corners& t, const Vec3& p) noexcept {
  const Vec3 u = t[1] - t[0];
  const Vec3 v = t[2] - t[0];
  const Vec3 normal = u.cross(v);
  const double area_squared = normal.squaredNorm();
  if (!(area_squared > 0.0)) return Vec3::Constant(1.0 / 3.0);
  const Vec3 w = p - t[0];
  double b1 = w.cross(v).dot(normal) / area_squared;
  double b2 = u.cross(w).dot(normal) / area_squared;
  b1 = clamp01(b1);
  b2 = clamp01(b2);
  const double b0 = std::max(0.0, 1.0 - b1 - b2);
  const double sum = b0 + b1 + b2;
  return Vec3(b0, b1, b2) / sum;
}

}  // namespace phalanx
