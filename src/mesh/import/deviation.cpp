// SPDX-License-Identifier: Apache-2.0
#include "mesh/import/deviation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "mesh/import/box_tree.h"
#include "mesh/import/edge_table.h"

namespace phalanx::mesh {
namespace {

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) noexcept {
  const Vec3 edge = b - a;
  const double squared = edge.squaredNorm();
  const double s = squared > 0.0 ? std::clamp((p - a).dot(edge) / squared, 0.0, 1.0) : 0.0;
  return a + s * edge;
}

double squared_gap(const FloatBox& box, const Vec3& p) noexcept {
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double gap =
        std::max(static_cast<double>(box.min[i]) - p[k], p[k] - static_cast<double>(box.max[i]));
    if (gap > 0.0) sum += gap * gap;
  }
  return sum;
}

class Surface {
 public:
  explicit Surface(const TriangleMesh& mesh) : mesh_(mesh), tree_(triangle_boxes(mesh)) {}

  [[nodiscard]] double distance(const Vec3& p) const {
    double best = std::numeric_limits<double>::infinity();
    tree_.walk([&](const FloatBox& box) { return squared_gap(box, p) < best; },
               [&](std::uint32_t t) {
                 const Triangle& c = mesh_.triangles[t];
                 const Vec3 q = nearest_on_triangle(p, mesh_.vertices[idx(c[0])], mesh_.vertices[idx(c[1])],
                                                    mesh_.vertices[idx(c[2])]);
                 best = std::min(best, (q - p).squaredNorm());
               },
               [&](const FloatBox& left, const FloatBox& right) {
                 return squared_gap(right, p) < squared_gap(left, p);
               });
    return std::sqrt(best);
  }

 private:
  const TriangleMesh& mesh_;
  BoxTree tree_;
};

double farthest(const TriangleMesh& from, const Surface& to, std::size_t& probes) {
  double worst = 0.0;
  const auto probe = [&](const Vec3& p) {
    worst = std::max(worst, to.distance(p));
    ++probes;
  };
  for (const Vec3& v : from.vertices) probe(v);
  for (const Triangle& t : from.triangles)
    probe((from.vertices[idx(t[0])] + from.vertices[idx(t[1])] + from.vertices[idx(t[2])]) / 3.0);
  EdgeTable(from).for_each([&](std::span<const HalfEdge> edge) {
    probe(0.5 * (from.vertices[idx(edge[0].low)] + from.vertices[idx(edge[0].high)]));
  });
  return worst;
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

SurfaceDeviation measure_deviation(const TriangleMesh& original, const TriangleMesh& decimated) {
  SurfaceDeviation deviation;
  deviation.outward = farthest(original, Surface(decimated), deviation.probes);
  deviation.inward = farthest(decimated, Surface(original), deviation.probes);
  return deviation;
}

}  // namespace phalanx::mesh
