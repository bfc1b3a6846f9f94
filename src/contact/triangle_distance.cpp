// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/triangle_distance.h"

#include <algorithm>

#include "contact/feature_pairs.h"
#include "contact/search/search_functions.h"

namespace phalanx {

TriangleDistance triangle_distance(const Corners& a, const Corners& b) noexcept {
  double corner_a[3][3];
  double corner_b[3][3];
  for (std::size_t c = 0; c < 3; ++c) {
    for (int i = 0; i < 3; ++i) {
      corner_a[c][i] = a[c][i];
      corner_b[c][i] = b[c][i];
    }
  }
  search::PairDistance found;
  search::functions().closest(corner_a, corner_b, found);
  return {found.squared, Vec3(found.on_segment[0], found.on_segment[1], found.on_segment[2]),
          Vec3(found.on_object[0], found.on_object[1], found.on_object[2])};
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
