// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "mesh/shapes/mesh_builder.h"
#include "mesh/shapes/object_shapes.h"
#include "phalanx/core/constants.h"
#include "phalanx/mesh/objects.h"

namespace phalanx::mesh {

constexpr double kZone = kPi / 6.0;  // between latitudes with bumps

double ball_radius(double diameter, double bump, const Vec3& u) {
  const double latitude = std::atan2(u.z(), u.head<2>().norm());
  const double row = std::round(latitude / kZone);  // -3 .. 3
  const int in_row = std::abs(row) > 2.5 ? 1 : std::abs(row) > 1.5 ? 6 : 12;
  const double step = 2.0 * kPi / in_row;
  const double longitude = in_row == 1 ? 0.0 : step * std::round(std::atan2(u.y(), u.x()) / step);
  const double level = std::cos(row * kZone);
  const Vec3 top{level * std::cos(longitude), level * std::sin(longitude), std::sin(row * kZone)};
  const double angle = 2.0 * std::asin(std::min(1.0, 0.5 * (u - top).norm())) / kBallBumpAngle;
  const double low = 0.5 * diameter - bump;
  if (angle >= 1.0) return low;
  constexpr double kOnTop = 1e-7;  // its square is below rounding: exactly the full radius
  if (angle < kOnTop) return 0.5 * diameter;
  const double flank = 1.0 - angle * angle;
  return low + bump * flank * flank;
}

}  // namespace phalanx::mesh

namespace phalanx {
namespace {

/// Bands in each zone of 30 degrees from the equator to a pole, and points around (a multiple of 12).
struct BallGrid {
  std::array<int, 3> bands{1, 1, 1};
  int around = 12;
  [[nodiscard]] int rings() const { return 2 * (bands[0] + bands[1] + bands[2]) - 1; }
  [[nodiscard]] int triangles() const { return 2 * around * rings(); }
};

BallGrid choose_grid(int triangles) {
  BallGrid best;
  double least = std::numeric_limits<double>::infinity();
  const int middle = mesh::round_to(std::sqrt(static_cast<double>(triangles)), 12, 12);
  for (int around = std::max(12, middle - 24); around <= middle + 24; around += 12) {
    const int all = mesh::round_to(0.25 * triangles / around + 0.5, 1, 3);
    const BallGrid grid{{(all + 2) / 3, (all + 1) / 3, all / 3}, around};
    const double miss = std::abs(static_cast<double>(grid.triangles()) - triangles) / triangles;
    const double cost = (miss > 0.04 ? 20.0 * miss : 0.0) + std::abs(std::log(around / (4.0 * all)));
    if (cost < least) {
      least = cost;
      best = grid;
    }
  }
  return best;
}

}  // namespace

TriangleMesh make_therapy_ball(double diameter, double bump, int triangles) {
  constexpr const char* kMaker = "make_therapy_ball";
  mesh::require_positive(diameter, kMaker, "diameter");
  mesh::require_triangles(triangles, kMaker);
  constexpr double kHighest = 0.15;  // greatest bump in diameters
  if (!(bump >= 0.0 && bump <= kHighest * diameter)) {
    std::ostringstream message;
    message << kMaker << ": bump is " << bump << " m; give 0 (smooth) to " << kHighest
            << " of the diameter of " << diameter << " m";
    throw std::invalid_argument(message.str());
  }
  const BallGrid grid = choose_grid(triangles);
  const auto place = [&](const Vec3& u) { return Vec3(mesh::ball_radius(diameter, bump, u) * u); };
  // Latitudes are those of the upper half from the equator on. The lower half is their mirror image.
  std::vector<double> latitude;
  for (std::size_t zone = 0; zone < 3; ++zone)
    for (int i = 0; i < grid.bands[zone]; ++i)
      latitude.push_back(mesh::kZone *
                         (static_cast<double>(zone) + static_cast<double>(i) / grid.bands[zone]));
  const auto upper = static_cast<int>(latitude.size());
  mesh::MeshBuilder builder;
  const std::int32_t south = builder.vertex({0.0, 0.0, -0.5 * diameter});
  mesh::Ring last;
  for (int i = 1 - upper; i < upper; ++i) {
    const double angle = latitude[static_cast<std::size_t>(std::abs(i))];
    const double level = std::cos(angle);
    const double z = i < 0 ? -std::sin(angle) : std::sin(angle);
    mesh::Ring ring = builder.ring(grid.around, [&](int j) {
      const Eigen::Vector2d c = mesh::unit_circle(j, grid.around);
      return place({level * c.x(), level * c.y(), z});
    });
    if (last.empty()) {
      builder.close_below(south, ring);
    } else {
      builder.strip(last, ring);
    }
    last = std::move(ring);
  }
  builder.close_above(last, builder.vertex({0.0, 0.0, 0.5 * diameter}));
  return builder.take();
}

}  // namespace phalanx
