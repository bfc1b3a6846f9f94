// SPDX-License-Identifier: Apache-2.0
// Box, sphere, cylinder and torus.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <sstream>
#include <stdexcept>

#include "mesh/shapes/mesh_builder.h"
#include "phalanx/core/constants.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx {
namespace {

using mesh::MeshBuilder;
using mesh::Ring;
using mesh::round_to;
using mesh::unit_circle;

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

Vec3 on_circle(double radius, double z, int j, int n) {
  const Eigen::Vector2d c = unit_circle(j, n);
  return {radius * c.x(), radius * c.y(), z};
}

struct SphereGrid {
  int rings = 1;   // odd, so that one is the equator
  int around = 4;  // a multiple of 4, so that both horizontal extents are exact
};

SphereGrid choose_sphere_grid(int triangles) {
  // The grid has 2 around rings triangles. Its cells at the equator are square if around = 2 (rings + 1).
  const double ideal = 0.5 * (std::sqrt(1.0 + triangles) - 1.0);
  const int middle = std::max(1, 2 * static_cast<int>(ideal / 2.0) + 1);
  SphereGrid best;
  for (int rings = std::max(1, middle - 2); rings <= middle + 2; rings += 2) {
    const SphereGrid grid{rings, round_to(0.5 * triangles / rings, 4, 4)};
    const auto miss = [&](const SphereGrid& g) { return std::abs(2 * g.around * g.rings - triangles); };
    if (miss(grid) < miss(best)) best = grid;
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

TriangleMesh make_sphere(double diameter, int triangles) {
  mesh::require_positive(diameter, "make_sphere", "diameter");
  mesh::require_triangles(triangles, "make_sphere");
  const SphereGrid grid = choose_sphere_grid(triangles);
  const double r = 0.5 * diameter;
  MeshBuilder builder;
  const std::int32_t south = builder.vertex({0.0, 0.0, -r});
  Ring last;
  for (int i = 1; i <= grid.rings; ++i) {
    // The rows cover half a turn from pole to pole; unit_circle is exact at the equator.
    const Eigen::Vector2d latitude = unit_circle(i, 2 * (grid.rings + 1));
    const double radius = r * latitude.y();
    const double z = -r * latitude.x();
    Ring ring = builder.ring(grid.around, [&](int j) { return on_circle(radius, z, j, grid.around); });
    if (i == 1) {
      builder.close_below(south, ring);
    } else {
      builder.strip(last, ring);
    }
    last = std::move(ring);
  }
  builder.close_above(last, builder.vertex({0.0, 0.0, r}));
  return builder.take();
}

namespace {

struct CylinderGrid {
  int around = 4;
  int bands = 1;      // along the side
  int cap_rings = 1;  // the outermost is the edge
};

/// Returns the number of points around the cap ring k of 1..cap_rings. It is in proportion to the ring's
/// radius, so that the cap's triangles are as wide as the edge's.
int cap_count(const CylinderGrid& g, int k) {
  return round_to(static_cast<double>(g.around) * k / g.cap_rings, 4, 4);
}

int count_triangles(const CylinderGrid& g) {
  int caps = 0;
  for (int k = 1; k <= g.cap_rings; ++k) caps += cap_count(g, k) + (k > 1 ? cap_count(g, k - 1) : 0);
  return 2 * (g.around * g.bands + caps);
}

CylinderGrid choose_cylinder_grid(double diameter, double length, int triangles) {
  const double area = kPi * diameter * (length + 0.5 * diameter);
  const double edge = std::sqrt(2.0 * area / triangles);
  CylinderGrid best;
  const int middle = round_to(std::min(kPi * diameter / edge, 0.5 * triangles), 4, 4);
  for (int around = std::max(4, middle - 8); around <= middle + 8; around += 4) {
    const double cell = kPi * diameter / around;
    CylinderGrid g{around, 1, round_to(0.5 * diameter / cell, 1, 1)};
    const int caps = count_triangles(g) - 2 * around;
    g.bands = round_to(0.5 * (triangles - caps) / around, 1, 1);
    const auto miss = [&](const CylinderGrid& c) { return std::abs(count_triangles(c) - triangles); };
    if (miss(g) < miss(best)) best = g;
  }
  return best;
}

}  // namespace

TriangleMesh make_cylinder(double diameter, double length, int triangles) {
  mesh::require_positive(diameter, "make_cylinder", "diameter");
  mesh::require_positive(length, "make_cylinder", "length");
  mesh::require_triangles(triangles, "make_cylinder");
  const CylinderGrid g = choose_cylinder_grid(diameter, length, triangles);
  const double r = 0.5 * diameter;
  const double half = 0.5 * length;
  MeshBuilder builder;
  const auto cap_ring = [&](int k, double z) {
    const int n = cap_count(g, k);
    const double radius = k == g.cap_rings ? r : r * k / g.cap_rings;
    return builder.ring(n, [&](int j) { return on_circle(radius, z, j, n); });
  };
  const std::int32_t bottom = builder.vertex({0.0, 0.0, -half});
  Ring last = cap_ring(1, -half);
  builder.close_below(bottom, last);
  const auto go_on = [&](Ring ring) {
    builder.strip(last, ring);
    last = std::move(ring);
  };
  for (int k = 2; k <= g.cap_rings; ++k) go_on(cap_ring(k, -half));
  for (int i = 1; i < g.bands; ++i) {
    const double z = -half + length * i / g.bands;
    go_on(builder.ring(g.around, [&](int j) { return on_circle(r, z, j, g.around); }));
  }
  for (int k = g.cap_rings; k >= 1; --k) go_on(cap_ring(k, half));
  builder.close_above(last, builder.vertex({0.0, 0.0, half}));
  return builder.take();
}

TriangleMesh make_torus(double ring_diameter, double tube_diameter, int triangles) {
  mesh::require_positive(ring_diameter, "make_torus", "ring_diameter");
  mesh::require_positive(tube_diameter, "make_torus", "tube_diameter");
  mesh::require_triangles(triangles, "make_torus");
  if (tube_diameter >= ring_diameter) {
    std::ostringstream message;
    message << "make_torus: tube_diameter " << tube_diameter << " m is not below ring_diameter "
            << ring_diameter << " m, so the tube would meet itself; make the tube thinner or the ring wider";
    throw std::invalid_argument(message.str());
  }
  // The grid has 2 along around triangles, with square cells on the tube's centre line. Both counts are
  // multiples of 4, so that the extents are exact.
  const double ratio = ring_diameter / tube_diameter;
  const int around = round_to(std::sqrt(0.5 * triangles / ratio), 4, 4);
  const int along = round_to(0.5 * triangles / around, 4, 4);
  MeshBuilder builder;
  std::vector<Ring> rings;
  for (int i = 0; i < around; ++i) {
    const Eigen::Vector2d section = unit_circle(i, around);
    const double radius = 0.5 * (ring_diameter + tube_diameter * section.x());
    const double z = 0.5 * tube_diameter * section.y();
    rings.push_back(builder.ring(along, [&](int j) { return on_circle(radius, z, j, along); }));
  }
  for (std::size_t i = 0; i < rings.size(); ++i) builder.strip(rings[i], rings[(i + 1) % rings.size()]);
  return builder.take();
}

}  // namespace phalanx
