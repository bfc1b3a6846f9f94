// SPDX-License-Identifier: Apache-2.0
#include "mesh/shapes/wall_hole.h"

#include <algorithm>
#include <cmath>

namespace phalanx::mesh {

std::optional<Hole> cut_hole(const std::vector<Eigen::Vector2d>& loop, int wall_bands, double margin) {
  Eigen::Vector2d low = loop.front();
  Eigen::Vector2d high = loop.front();
  for (const auto& p : loop) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  if (!(low.y() > 0.0 && high.y() < wall_bands)) return std::nullopt;
  const Eigen::Vector2d centre = 0.5 * (low + high);
  const Eigen::Vector2d grow = Eigen::Vector2d::Ones() + (2.0 * margin) * (high - low).cwiseInverse();
  Hole hole;
  constexpr int kParts = 16;  // parts of each edge, so that no band on its way is missed
  const std::size_t n = loop.size();
  for (std::size_t k = 0; k < n; ++k) {
    for (int s = 0; s < kParts; ++s) {
      const Eigen::Vector2d on = loop[k] + (loop[(k + 1) % n] - loop[k]) * s / kParts;
      const Eigen::Vector2d p = centre + (on - centre).cwiseProduct(grow);
      const int band = std::clamp(static_cast<int>(std::floor(p.y())), 0, wall_bands - 1);
      // A sample on the line of a column takes the cells on both sides.
      const Hole::Cut cut{static_cast<int>(std::ceil(p.x())) - 1, static_cast<int>(std::floor(p.x())) + 1};
      const auto [entry, fresh] = hole.bands.try_emplace(band, cut);
      entry->second.begin = std::min(entry->second.begin, cut.begin);
      entry->second.end = std::max(entry->second.end, cut.end);
    }
  }
  return hole;
}

std::vector<std::pair<int, int>> boundary(const Hole& hole) {
  using Point = std::pair<int, int>;
  std::map<Point, Point> next;
  const auto inside = [&](int column, int band) {
    const auto found = hole.bands.find(band);
    return found != hole.bands.end() && column >= found->second.begin && column < found->second.end;
  };
  for (const auto& [b, cut] : hole.bands) {
    for (int c = cut.begin; c < cut.end; ++c) {
      if (!inside(c, b - 1)) next[{c, b}] = {c + 1, b};
      if (!inside(c + 1, b)) next[{c + 1, b}] = {c + 1, b + 1};
      if (!inside(c, b + 1)) next[{c + 1, b + 1}] = {c, b + 1};
      if (!inside(c - 1, b)) next[{c, b + 1}] = {c, b};
    }
  }
  std::vector<Point> loop;
  const Point start = next.begin()->first;
  Point p = start;
  do {
    loop.push_back(p);
    p = next.at(p);
  } while (p != start && loop.size() <= next.size());
  return loop;
}

}  // namespace phalanx::mesh
