// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "contact/feature_pairs.h"
#include "phalanx/contact/triangle_distance.h"

namespace phalanx {
namespace {

struct TiedCorner {
  Vec3 on_a;
  Vec3 on_b;
  double angle = 0.0;
};

/// Corners of the tied region: at most 9 edge pairs, 6 corner-face pairs, 18 corner-edge pairs.
struct TiedCorners {
  std::array<TiedCorner, 33> corner;
  std::size_t count = 0;
};

void add_corner_edge_pairs(const Corners& points, const Corners& t, bool points_are_a, TiedCorners& out,
                           double limit_squared) noexcept {
  for (const Vec3& p : points) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 foot = nearest_on_edge(t[i], t[(i + 1) % 3] - t[i], p);
      if ((p - foot).squaredNorm() > limit_squared) continue;
      out.corner[out.count++] = points_are_a ? TiedCorner{p, foot} : TiedCorner{foot, p};
    }
  }
}

}  // namespace

TiedRegion tied_region(const Corners& a, const Corners& b, const TriangleDistance& closest, double limit,
                       double excess) noexcept {
  const Vec3 apart = closest.on_a - closest.on_b;
  const double distance = apart.norm();
  const double point_weight = std::numbers::pi * excess * excess;
  if (!(distance > 0.0)) return {point_weight, closest.on_a, closest.on_b};

  TiedCorners tied;
  const double limit_squared = limit * limit;
  for_each_feature_pair(a, b, [&](const Vec3& on_a, const Vec3& on_b) {
    if ((on_a - on_b).squaredNorm() <= limit_squared) tied.corner[tied.count++] = {on_a, on_b};
  });
  add_corner_edge_pairs(a, b, true, tied, limit_squared);
  add_corner_edge_pairs(b, a, false, tied, limit_squared);
  if (tied.count == 0) return {point_weight, closest.on_a, closest.on_b};

  // The corners of a convex, nearly plane polygon are sorted by their angle around the mean, seen along the
  // direction of closest approach.
  Vec3 mean_a = Vec3::Zero();
  Vec3 mean_b = Vec3::Zero();
  for (std::size_t i = 0; i < tied.count; ++i) {
    mean_a += tied.corner[i].on_a;
    mean_b += tied.corner[i].on_b;
  }
  mean_a /= static_cast<double>(tied.count);
  mean_b /= static_cast<double>(tied.count);
  const Vec3 n = apart / distance;
  const Vec3 u = n.unitOrthogonal();
  const Vec3 v = n.cross(u);
  for (std::size_t i = 0; i < tied.count; ++i) {
    const Vec3 r = tied.corner[i].on_a - mean_a;
    tied.corner[i].angle = std::atan2(r.dot(v), r.dot(u));
  }
  const auto end = tied.corner.begin() + static_cast<std::ptrdiff_t>(tied.count);
  std::sort(tied.corner.begin(), end,
            [](const TiedCorner& x, const TiedCorner& y) { return x.angle < y.angle; });

  // Steiner's formula: the widened polygon consists of the polygon, a band of width e along its edges, and a
  // disc of radius e shared by its corners.
  TiedRegion region{point_weight, point_weight * mean_a, point_weight * mean_b};
  for (std::size_t i = 0; i < tied.count; ++i) {
    const TiedCorner& p = tied.corner[i];
    const TiedCorner& q = tied.corner[(i + 1) % tied.count];
    const double area = 0.5 * (p.on_a - mean_a).cross(q.on_a - mean_a).norm();
    const double band = excess * (q.on_a - p.on_a).norm();
    region.weight += area + band;
    region.on_a += area / 3.0 * (mean_a + p.on_a + q.on_a) + 0.5 * band * (p.on_a + q.on_a);
    region.on_b += area / 3.0 * (mean_b + p.on_b + q.on_b) + 0.5 * band * (p.on_b + q.on_b);
  }
  region.on_a /= region.weight;
  region.on_b /= region.weight;
  return region;
}

}  // namespace phalanx
