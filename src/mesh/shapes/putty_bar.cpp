// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "mesh/shapes/mesh_builder.h"
#include "mesh/shapes/object_shapes.h"
#include "phalanx/mesh/objects.h"

namespace phalanx {
namespace {

using Cells = std::array<int, 3>;

/// Cells of the box' lattice: `round` in each half of a rounded edge, `flat` between the edges.
struct BarGrid {
  int round = 2;
  Cells flat{1, 1, 1};
  [[nodiscard]] int cells(std::size_t axis) const { return 2 * round + flat[axis]; }
  [[nodiscard]] double triangles() const {
    const auto area = [&](std::size_t i, std::size_t j) { return static_cast<double>(cells(i)) * cells(j); };
    return 4.0 * (area(0, 1) + area(1, 2) + area(2, 0));
  }
};

BarGrid choose_grid(const Vec3& flat, double fillet, int triangles) {
  const auto grid_of = [&](double edge) {
    BarGrid grid;
    // Two cells a half edge give 22.5 degrees between neighbours.
    grid.round = mesh::round_to(0.25 * std::numbers::pi * fillet / edge, 1, 2);
    for (std::size_t i = 0; i < 3; ++i)
      grid.flat[i] = mesh::round_to(flat[static_cast<Eigen::Index>(i)] / edge, 1, 1);
    return grid;
  };
  const double area = 2.0 * (flat.x() * flat.y() + flat.y() * flat.z() + flat.z() * flat.x()) +
                      2.0 * std::numbers::pi * fillet * (flat.sum() + 2.0 * fillet);
  const double square = std::sqrt(2.0 * area / triangles);
  BarGrid best;
  double least = std::numeric_limits<double>::infinity();
  for (double stretch = 0.5; stretch < 4.0; stretch *= 1.01) {
    const BarGrid grid = grid_of(square * stretch);
    const double miss = std::abs(grid.triangles() - triangles);
    if (miss < least) {
      least = miss;
      best = grid;
    }
  }
  return best;
}

}  // namespace

TriangleMesh make_putty_bar(const Vec3& size, int triangles) {
  constexpr const char* kMaker = "make_putty_bar";
  for (const double length : size) mesh::require_positive(length, kMaker, "a length");
  mesh::require_triangles(triangles, kMaker);
  mesh::require_ratio(size.maxCoeff(), size.minCoeff(), {1.0, 10.0}, kMaker, "largest length",
                      "smallest length");
  const double fillet = mesh::kBarFillet * size.minCoeff();
  const Vec3 half = 0.5 * size;
  const Vec3 half_flat = half.array() - fillet;
  const BarGrid grid = choose_grid(2.0 * half_flat, fillet, triangles);

  // Returns a lattice coordinate from -half to half. Within a rounded edge it is spaced so that equal steps
  // become equal angles. It is mirrored, so that opposite sides have the same bits.
  const auto coordinate = [&](std::size_t axis, int k) {
    const auto i = static_cast<Eigen::Index>(axis);
    const int n = grid.cells(axis);
    const bool low = 2 * k < n;
    const int from_end = low ? k : n - k;
    double c = 0.0;
    if (from_end < grid.round) {
      const double angle = 0.25 * std::numbers::pi * (grid.round - from_end) / grid.round;
      c = from_end == 0 ? half[i] : half_flat[i] + fillet * std::tan(angle);
    } else {
      c = 2 * k == n ? 0.0 : half_flat[i] - 2.0 * half_flat[i] * (from_end - grid.round) / grid.flat[axis];
    }
    return low ? -c : c;
  };
  mesh::MeshBuilder builder;
  std::map<Cells, std::int32_t> at;
  const auto vertex = [&](const Cells& lattice) {
    const auto [entry, fresh] = at.try_emplace(lattice, -1);
    if (fresh) {
      Vec3 p;
      for (std::size_t i = 0; i < 3; ++i) p[static_cast<Eigen::Index>(i)] = coordinate(i, lattice[i]);
      // The point moves to the rounded surface, along the direction from the nearest point of the box
      // without its fillets.
      const Vec3 core = p.cwiseMax(-half_flat).cwiseMin(half_flat);
      const Vec3 out = p - core;
      // Over a flat side `out` has one coordinate, and p keeps its bits.
      if ((out.array() != 0.0).count() > 1) p = core + fillet * out.normalized();
      entry->second = builder.vertex(p);
    }
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    for (const bool far : {false, true}) {
      for (int i = 0; i < grid.cells(u); ++i) {
        for (int j = 0; j < grid.cells(v); ++j) {
          const auto corner = [&](int di, int dj) {
            Cells c{};
            c[axis] = far ? grid.cells(axis) : 0;
            c[u] = i + di;
            c[v] = j + dj;
            return vertex(c);
          };
          const std::int32_t a = corner(0, 0);
          const std::int32_t b = far ? corner(1, 0) : corner(0, 1);
          const std::int32_t c = corner(1, 1);
          const std::int32_t d = far ? corner(0, 1) : corner(1, 0);
          if ((builder.at(a) - builder.at(c)).norm() <=
              (1.0 + 1e-9) * (builder.at(b) - builder.at(d)).norm()) {
            builder.triangle(a, b, c);
            builder.triangle(a, c, d);
          } else {
            builder.triangle(a, b, d);
            builder.triangle(b, c, d);
          }
        }
      }
    }
  }
  return builder.take();
}

}  // namespace phalanx
