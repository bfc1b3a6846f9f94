// SPDX-License-Identifier: Apache-2.0
#include "mesh/shapes/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace phalanx::mesh {

std::int32_t MeshBuilder::vertex(const Vec3& p) {
  mesh_.vertices.push_back(p);
  return static_cast<std::int32_t>(mesh_.vertices.size()) - 1;
}

Ring MeshBuilder::ring(int n, const std::function<Vec3(int)>& point) {
  Ring ring;
  ring.reserve(static_cast<std::size_t>(n));
  for (int j = 0; j < n; ++j) ring.push_back(vertex(point(j)));
  return ring;
}

void MeshBuilder::strip(const Ring& lower, const Ring& upper, const std::function<bool(int)>& skip) {
  const std::size_t n = lower.size();
  const std::size_t m = upper.size();
  if (n == m) {
    for (std::size_t j = 0; j < n; ++j) {
      if (skip && skip(static_cast<int>(j))) continue;
      const std::int32_t a = lower[j];
      const std::int32_t b = lower[(j + 1) % n];
      const std::int32_t c = upper[(j + 1) % n];
      const std::int32_t d = upper[j];
      // The tolerance keeps one direction over a whole band whose diagonals are equal up to rounding.
      if ((at(a) - at(c)).norm() <= (1.0 + 1e-9) * (at(b) - at(d)).norm()) {
        triangle(a, b, c);
        triangle(a, c, d);
      } else {
        triangle(a, b, d);
        triangle(b, c, d);
      }
    }
    return;
  }
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < n || j < m) {
    // The side advances whose next edge has the earlier middle in the turn: (i + 1/2)/n against (j + 1/2)/m.
    if (j == m || (i < n && (2 * i + 1) * m <= (2 * j + 1) * n)) {
      triangle(lower[i % n], lower[(i + 1) % n], upper[j % m]);
      ++i;
    } else {
      triangle(lower[i % n], upper[(j + 1) % m], upper[j % m]);
      ++j;
    }
  }
}

void MeshBuilder::close_below(std::int32_t pole, const Ring& ring) {
  for (std::size_t j = 0; j < ring.size(); ++j) triangle(pole, ring[(j + 1) % ring.size()], ring[j]);
}

void MeshBuilder::close_above(const Ring& ring, std::int32_t pole) {
  for (std::size_t j = 0; j < ring.size(); ++j) triangle(ring[j], ring[(j + 1) % ring.size()], pole);
}

TriangleMesh MeshBuilder::take() {
  std::vector<std::int32_t> renumbered(mesh_.vertices.size(), -1);
  for (const Triangle& t : mesh_.triangles)
    for (const std::int32_t i : t) renumbered[static_cast<std::size_t>(i)] = 0;
  TriangleMesh out;
  for (std::size_t i = 0; i < renumbered.size(); ++i) {
    if (renumbered[i] < 0) continue;
    renumbered[i] = static_cast<std::int32_t>(out.vertices.size());
    out.vertices.push_back(mesh_.vertices[i]);
  }
  out.triangles = std::move(mesh_.triangles);
  for (Triangle& t : out.triangles)
    for (std::int32_t& i : t) i = renumbered[static_cast<std::size_t>(i)];
  mesh_ = {};
  return out;
}

void require_positive(double value, const char* maker, const char* name) {
  if (std::isfinite(value) && value > 0.0) return;
  std::ostringstream message;
  message << maker << ": " << name << " is " << value << " m; give a finite length above 0";
  throw std::invalid_argument(message.str());
}

void require_ratio(double value, double reference, RatioRange range, const char* maker, const char* name,
                   const char* reference_name) {
  const double ratio = value / reference;
  constexpr double kRounding = 1e-12;
  if (ratio >= range.min * (1.0 - kRounding) && ratio <= range.max * (1.0 + kRounding)) return;
  std::ostringstream message;
  message << maker << ": a " << name << " of " << value << " m is " << ratio << " times the "
          << reference_name << " of " << reference << " m; give " << range.min << " to " << range.max
          << " times";
  throw std::invalid_argument(message.str());
}

void require_triangles(int triangles, const char* maker) {
  constexpr int kMost = 50'000'000;
  if (triangles >= 1 && triangles <= kMost) return;
  throw std::invalid_argument(std::string(maker) + ": triangles is " + std::to_string(triangles) +
                              "; give 1 to " + std::to_string(kMost));
}

int round_to(double x, int step, int least) {
  return std::max(least, step * static_cast<int>(std::lround(x / step)));
}

Eigen::Vector2d unit_circle(int j, int n) {
  // The octants mirror each other exactly, so that the extents of a ring equal its diameter to the last bit.
  j = ((j % n) + n) % n;
  const std::int64_t eighths = std::int64_t{8} * j;
  const auto octant = static_cast<int>(eighths / n);
  const auto within = static_cast<double>(eighths % n) / static_cast<double>(n);  // [0, 1) within this octant
  const double w = octant % 2 == 0 ? within : 1.0 - within;
  const double angle = w * (std::numbers::pi / 4.0);
  const double c = std::cos(angle);
  const double s = w == 0.0 ? 0.0 : std::sin(angle);
  switch (octant) {  // 0.0 - s avoids a negative zero
    case 0:
      return {c, s};
    case 1:
      return {s, c};
    case 2:
      return {0.0 - s, c};
    case 3:
      return {-c, s};
    case 4:
      return {-c, 0.0 - s};
    case 5:
      return {-s, -c};
    case 6:
      return {s, -c};
    default:
      return {c, -s};
  }
}

}  // namespace phalanx::mesh
