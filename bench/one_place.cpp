// SPDX-License-Identifier: Apache-2.0
#include "one_place.h"

#include <cmath>

#include "peer_record.h"
#include "phalanx/contact/triangle_distance.h"

namespace phalanx::bench {
namespace {

constexpr double kApart = 1e-7;  ///< points this far from each other are two places [m]

Corners corners_of(const TriangleMesh& mesh, int triangle, const Pose& X) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto vertex = static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(triangle)][i]);
    corners[i] = X * mesh.vertices[vertex];
  }
  return corners;
}

/// Calls see(closest) for the pairs of features of two triangles: corners with triangles and edges with
/// edges, as triangles that are degenerate.
template <class See>
void for_each_feature(const Corners& a, const Corners& b, See&& see) {
  for (std::size_t i = 0; i < 3; ++i) {
    see(triangle_distance({a[i], a[i], a[i]}, b));
    see(triangle_distance(a, {b[i], b[i], b[i]}));
    for (std::size_t j = 0; j < 3; ++j) {
      see(triangle_distance({a[i], a[(i + 1) % 3], a[i]}, {b[j], b[(j + 1) % 3], b[j]}));
    }
  }
}

}  // namespace

bool one_place(const TriangleMesh& segment, const Pose& X_WS, const TriangleMesh& object,
               const std::vector<ClosePair>& tied) {
  const double limit = tied.front().distance + kTie;
  bool one = true;
  for (const ClosePair& pair : tied) {
    const Corners a = corners_of(segment, pair.segment_triangle, X_WS);
    const Corners b = corners_of(object, pair.object_triangle, Pose{});
    for_each_feature(a, b, [&](const TriangleDistance& closest) {
      if (std::sqrt(closest.squared) > limit) return;
      one = one && (closest.on_a - tied.front().on_segment).norm() <= kApart &&
            (closest.on_b - tied.front().on_object).norm() <= kApart;
    });
  }
  return one;
}

}  // namespace phalanx::bench
