// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "mesh/shapes/mesh_builder.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx {
namespace {

using Cells = std::array<int, 3>;

std::int64_t triangle_count(const Cells& n) {
  const auto area = [&](std::size_t i, std::size_t j) { return std::int64_t{n[i]} * n[j]; };
  return 4 * (area(0, 1) + area(1, 2) + area(2, 0));
}

/// Returns the cells along the three edges, as square as the triangle count allows.
Cells choose_cells(const Vec3& size, int triangles) {
  const double area = size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
  const double edge = std::sqrt(4.0 * area / triangles);
  Cells best{1, 1, 1};
  for (int percent = 60; percent <= 160; ++percent) {
    Cells n{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double cells = 100.0 * size[static_cast<Eigen::Index>(i)] / (percent * edge);
      n[i] = mesh::round_to(std::min(cells, static_cast<double>(triangles)), 1, 1);
    }
    if (std::abs(triangle_count(n) - triangles) < std::abs(triangle_count(best) - triangles)) best = n;
  }
  return best;
}

}  // namespace

TriangleMesh make_box(const Vec3& size, int triangles) {
  for (const double edge : size) mesh::require_positive(edge, "make_box", "an edge length");
  mesh::require_triangles(triangles, "make_box");
  const Cells n = choose_cells(size, triangles);
  mesh::MeshBuilder builder;
  std::map<Cells, std::int32_t> at;  // from surface lattice to vertex
  const auto vertex = [&](const Cells& lattice) {
    const auto [entry, fresh] = at.try_emplace(lattice, -1);
    if (fresh) {
      Vec3 p;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        // The distance counts from the nearer face, so that opposite faces mirror each other exactly.
        const int from_max = n[i] - lattice[i];
        p[axis] = lattice[i] <= from_max ? -0.5 * size[axis] + size[axis] * lattice[i] / n[i]
                                         : 0.5 * size[axis] - size[axis] * from_max / n[i];
      }
      entry->second = builder.vertex(p);
    }
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    for (const bool far : {false, true}) {
      for (int i = 0; i < n[u]; ++i) {
        for (int j = 0; j < n[v]; ++j) {
          const auto corner = [&](int di, int dj) {
            Cells c{};
            c[axis] = far ? n[axis] : 0;
            c[u] = i + di;
            c[v] = j + dj;
            return vertex(c);
          };
          const std::int32_t a = corner(0, 0);
          const std::int32_t b = far ? corner(1, 0) : corner(0, 1);
          const std::int32_t c = corner(1, 1);
          const std::int32_t d = far ? corner(0, 1) : corner(1, 0);
          builder.triangle(a, b, c);
          builder.triangle(a, c, d);
        }
      }
    }
  }
  return builder.take();
}

}  // namespace phalanx
