// SPDX-License-Identifier: Apache-2.0
#include "mesh/shapes/annulus.h"

#include <algorithm>
#include <cmath>

#include "phalanx/core/constants.h"

namespace phalanx::mesh {
namespace {

double twice_area(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Returns 1 for an equilateral triangle, and more for a thinner one.
double thinness(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double area = 0.5 * (b - a).cross(c - a).norm();
  const double squares = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return area > 1e-9 * squares ? squares / (4.0 * std::sqrt(3.0) * area) : kInfinity;
}

}  // namespace

std::optional<AnnulusFilling> fill_annulus(const MeshBuilder& builder, const PlaneLoop& outer,
                                           const PlaneLoop& inner) {
  const std::size_t n = outer.ring.size();
  const std::size_t m = inner.ring.size();
  // The annulus is cut open along the shortest bridge, and both loops are walked at once. cost[i][j] is that
  // of the best filling that has used i edges of the outer and j edges of the inner loop.
  std::size_t i0 = 0;
  std::size_t j0 = 0;
  double shortest = kInfinity;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < m; ++j) {
      const double d = (outer.at[i] - inner.at[j]).squaredNorm();
      if (d < shortest) {
        shortest = d;
        i0 = i;
        j0 = j;
      }
    }
  }
  const auto o = [&](std::size_t i) { return (i0 + i) % n; };
  const auto in = [&](std::size_t j) { return (j0 + j) % m; };
  const auto space = [&](const PlaneLoop& loop, std::size_t k) -> const Vec3& {
    return builder.at(loop.ring[k]);
  };
  // A triangle's cost grows steeply with its thinness, so that one sliver costs more than
  // several fair triangles.
  const auto cost_of = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                           const Vec3& pa, const Vec3& pb, const Vec3& pc) {
    if (!(twice_area(a, b, c) > 1e-6)) return kInfinity;
    const double thin = thinness(pa, pb, pc);
    return thin * thin;
  };
  const std::size_t width = m + 1;
  std::vector<double> cost((n + 1) * width, kInfinity);
  std::vector<bool> by_outer((n + 1) * width, false);
  cost[0] = 0.0;
  for (std::size_t i = 0; i <= n; ++i) {
    for (std::size_t j = 0; j <= m; ++j) {
      double& best = cost[i * width + j];
      if (i > 0 && cost[(i - 1) * width + j] < kInfinity) {
        const double c = cost[(i - 1) * width + j] + cost_of(outer.at[o(i - 1)], outer.at[o(i)],
                                                             inner.at[in(j)], space(outer, o(i - 1)),
                                                             space(outer, o(i)), space(inner, in(j)));
        if (c < best) {
          best = c;
          by_outer[i * width + j] = true;
        }
      }
      if (j > 0 && cost[i * width + j - 1] < kInfinity) {
        const double c = cost[i * width + j - 1] + cost_of(outer.at[o(i)], inner.at[in(j)],
                                                           inner.at[in(j - 1)], space(outer, o(i)),
                                                           space(inner, in(j)), space(inner, in(j - 1)));
        if (c < best) {
          best = c;
          by_outer[i * width + j] = false;
        }
      }
    }
  }
  if (!(cost.back() < kInfinity)) return std::nullopt;
  AnnulusFilling filling;
  const auto add = [&](const Triangle& t) {
    filling.triangles.push_back(t);
    filling.thinnest =
        std::max(filling.thinnest, thinness(builder.at(t[0]), builder.at(t[1]), builder.at(t[2])));
  };
  for (std::size_t i = n, j = m; i > 0 || j > 0;) {
    if (by_outer[i * width + j]) {
      add({outer.ring[o(i - 1)], outer.ring[o(i)], inner.ring[in(j)]});
      --i;
    } else {
      add({outer.ring[o(i)], inner.ring[in(j)], inner.ring[in(j - 1)]});
      --j;
    }
  }
  return filling;
}

}  // namespace phalanx::mesh
