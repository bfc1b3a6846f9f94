// SPDX-License-Identifier: Apache-2.0
#include "mesh/shapes/extruded_solid.h"

#include <utility>

namespace phalanx::mesh {

TriangleMesh extrude(const PlaneArea& area, double thickness, int bands) {
  MeshBuilder builder;
  const auto side = [&](double z) {
    std::vector<std::int32_t> index;
    index.reserve(area.points.size());
    for (const Eigen::Vector2d& p : area.points) index.push_back(builder.vertex({p.x(), p.y(), z}));
    return index;
  };
  const auto at = [](const std::vector<std::int32_t>& index, std::int32_t i) {
    return index[static_cast<std::size_t>(i)];
  };
  const std::vector<std::int32_t> below = side(-0.5 * thickness);
  const std::vector<std::int32_t> above = side(0.5 * thickness);
  for (const auto& [a, b, c] : area.triangles) {
    builder.triangle(at(above, a), at(above, b), at(above, c));
    builder.triangle(at(below, a), at(below, c), at(below, b));
  }
  for (const Ring& edge : area.edges) {
    Ring last;
    for (int band = 0; band <= bands; ++band) {
      Ring ring;
      for (const std::int32_t i : edge) {
        if (band == 0) {
          ring.push_back(at(below, i));
        } else if (band == bands) {
          ring.push_back(at(above, i));
        } else {
          const Eigen::Vector2d& p = area.points[static_cast<std::size_t>(i)];
          ring.push_back(
              builder.vertex({p.x(), p.y(), thickness * (static_cast<double>(band) / bands - 0.5)}));
        }
      }
      if (!last.empty()) builder.strip(last, ring);
      last = std::move(ring);
    }
  }
  return builder.take();
}

}  // namespace phalanx::mesh
