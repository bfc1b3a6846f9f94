// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "mesh/shapes/mesh_builder.h"
#include "mesh/shapes/stitched_solid.h"

namespace phalanx::mesh {

TriangleMesh fit_stitched_solid(const RevolvedSurface& surface, const std::vector<Tube>& tubes, int triangles,
                                const char* maker) {
  double widest = 0.0;
  for (int t = surface.wall_begin; t <= surface.wall_end; ++t)
    widest = std::max(widest, surface.profile(t).x());
  constexpr double kTurn = 6.283185307179586;
  CurveCache cache;
  std::optional<TriangleMesh> best;
  const auto miss = [&](const TriangleMesh& m) {
    return std::abs(static_cast<double>(m.triangles.size()) - triangles) / triangles;
  };
  // The count is proportional to 1/edge^2, so that its ratio to the target corrects the edge until it fits.
  // Near the coarsest grids the count moves in steps. There columns and edge are varied against each other.
  const auto attempt = [&](const Resolution& resolution) {
    auto mesh = build_stitched_solid(surface, tubes, resolution, cache);
    const double count = mesh ? static_cast<double>(mesh->triangles.size()) : 0.0;
    if (mesh && (!best || miss(*mesh) < miss(*best))) best = std::move(mesh);
    return count;
  };
  double edge = widest * std::sqrt(60.0 / triangles);
  constexpr double kGoodEnough = 0.02;
  for (int i = 0; i < 12; ++i) {
    const double count = attempt({.edge = edge, .around = round_to(kTurn * widest / edge, 4, 8)});
    if (best && miss(*best) < kGoodEnough) return std::move(*best);
    edge *= count > 0.0 ? std::clamp(std::sqrt(count / triangles), 0.5, 2.0) : 0.97;
  }
  constexpr int kCoarse = 20'000;
  if (triangles < kCoarse) {
    const int middle = round_to(kTurn * std::sqrt(triangles / 60.0), 4, 8);
    for (const double margin : {0.45, 0.2, 0.08}) {
      for (int around = std::max(8, middle - 12); around <= middle + 8; around += 4) {
        for (int percent = 70; percent <= 200; percent += 10)
          attempt({.edge = kTurn * widest / around * percent / 100.0, .around = around, .margin = margin});
      }
      constexpr double kCoarseGoodEnough = 0.06;
      if (best && miss(*best) < kCoarseGoodEnough) break;
    }
  }
  if (!best)
    throw std::invalid_argument(std::string(maker) + ": no valid grid near " + std::to_string(triangles) +
                                " triangles for these proportions; ask for more triangles");
  return std::move(*best);
}

}  // namespace phalanx::mesh
