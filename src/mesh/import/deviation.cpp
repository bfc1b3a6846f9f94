// SPDX-License-Identifier: Apache-2.0
#include "mesh/import/deviation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "mesh/repair/box_tree.h"
#include "mesh/repair/edge_table.h"
#include "mesh/repair/triangle_measures.h"

namespace phalanx::mesh {
namespace {

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

SurfaceDeviation measure_deviation(const TriangleMesh& original, const TriangleMesh& decimated) {
  SurfaceDeviation deviation;
  deviation.outward = farthest(original, Surface(decimated), deviation.probes);
  deviation.inward = farthest(decimated, Surface(original), deviation.probes);
  return deviation;
}

}  // namespace phalanx::mesh
