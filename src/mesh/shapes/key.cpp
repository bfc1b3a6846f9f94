// SPDX-License-Identifier: Apache-2.0
// Door key: a disc with a hole and a blade with cuts, extruded from one triangulated outline.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "mesh/shapes/mesh_builder.h"
#include "mesh/shapes/object_shapes.h"
#include "phalanx/core/constants.h"
#include "phalanx/mesh/objects.h"

namespace phalanx::mesh {

std::span<const KeyCut> key_lower_edge() {
  static constexpr std::array<KeyCut, 18> kEdge = [] {
    constexpr std::array<double, 5> kDepths = {0.30, 0.18, 0.36, 0.22, 0.32};
    constexpr double kLand = 0.06;  // remaining depth between two cuts
    std::array<KeyCut, 18> edge{{{0.0, 0.0}, {0.22, 0.0}}};
    std::size_t at = 2;
    for (std::size_t i = 0; i < kDepths.size(); ++i) {
      const double begin = 0.275 + 0.14 * static_cast<double>(i);
      if (i > 0) edge[at++] = {begin - 0.045, kLand};
      edge[at++] = {begin, kDepths[i]};
      edge[at++] = {begin + 0.05, kDepths[i]};
    }
    edge[at++] = {0.93, 0.10};
    edge[at] = {1.0, 0.45};
    return edge;
  }();
  return kEdge;
}

std::span<const KeyCut> key_upper_edge() {
  static constexpr std::array<KeyCut, 3> kEdge{{{0.0, 0.0}, {0.93, 0.0}, {1.0, 0.35}}};
  return kEdge;
}

namespace {

/// Triangulated flat area.
struct PlaneArea {
  std::vector<Eigen::Vector2d> points;
  std::vector<Triangle> triangles;  ///< counter-clockwise
  std::vector<Ring> edges;          ///< indices of points: outer edge counter-clockwise, holes clockwise
};

/// Makes the plate from z = -thickness/2 to thickness/2, its walls cut into `bands`.
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

double depth_at(std::span<const KeyCut> edge, double along) {
  for (std::size_t i = 0; i + 1 < edge.size(); ++i) {
    if (along == edge[i].along) return edge[i].depth;
    if (along < edge[i + 1].along)
      return edge[i].depth + (edge[i + 1].depth - edge[i].depth) * (along - edge[i].along) /
                                 (edge[i + 1].along - edge[i].along);
  }
  return edge.back().depth;
}

struct KeyGrid {
  int across = 2;               // rows of the blade, and cells of the bow at the blade
  std::array<int, 4> around{};  // other cells of the bow: to +y, -x, -y and back
  int rings = 1;                // of the bow, from hole to rim
  std::vector<int> columns;     // of the blade, for each interval between two of its corners
  int bands = 1;                // along the thickness
  [[nodiscard]] int bow_cells() const { return across + around[0] + around[1] + around[2] + around[3]; }
  [[nodiscard]] int blade_columns() const {
    int sum = 0;
    for (const int n : columns) sum += n;
    return sum;
  }
  [[nodiscard]] double triangles() const {
    const double flat = 2.0 * bow_cells() * rings + 2.0 * across * blade_columns();
    const double rim = 2.0 * bow_cells() - across + across + 2.0 * blade_columns();
    return 2.0 * flat + 2.0 * rim * bands;
  }
};

/// Lengths of a key [m]; here the bow's centre is the origin.
struct KeyShape {
  double bow, hole, blade_half, tip_x, thickness;
  double joint;               // half angle of the bow's rim that the blade covers
  std::vector<double> along;  // all corners of both edges of the blade

  KeyShape(double length, double breadth, double thickness_in)
      : bow(0.5 * breadth),
        hole(kKeyHole * bow),
        blade_half(kKeyBlade * bow),
        tip_x(length - bow),
        thickness(thickness_in),
        joint(std::asin(kKeyBlade)) {
    for (const KeyCut& cut : key_lower_edge()) along.push_back(cut.along);
    for (const KeyCut& cut : key_upper_edge()) along.push_back(cut.along);
    std::sort(along.begin(), along.end());
    along.erase(std::unique(along.begin(), along.end()), along.end());
  }
  [[nodiscard]] double blade_length() const { return tip_x - bow; }
};

KeyGrid grid_of(const KeyShape& key, double edge) {
  constexpr double kSmooth = 25.0 * kPi / 180.0;
  const auto cells = [&](double length, int least) { return round_to(length / edge, 1, least); };
  KeyGrid grid;
  grid.across = cells(2.0 * key.blade_half, 2);
  const double mean = 0.5 * (key.bow + key.hole);
  const auto arc = [&](double angle) {
    return cells(mean * angle, static_cast<int>(std::ceil(angle / kSmooth)));
  };
  const int beside = arc(0.5 * kPi - key.joint);
  const int back = arc(0.5 * kPi);
  grid.around = {beside, back, back, beside};
  grid.rings = cells(key.bow - key.hole, 1);
  for (std::size_t i = 0; i + 1 < key.along.size(); ++i)
    grid.columns.push_back(cells((key.along[i + 1] - key.along[i]) * key.blade_length(), 1));
  grid.bands = cells(key.thickness, 1);
  return grid;
}

KeyGrid choose_grid(const KeyShape& key, int triangles) {
  const double area =
      2.0 * (kPi * (key.bow * key.bow - key.hole * key.hole) + 1.6 * key.blade_half * key.blade_length());
  const double square = std::sqrt(2.0 * area / triangles);
  KeyGrid best;
  double least = std::numeric_limits<double>::infinity();
  for (double stretch = 0.5; stretch < 6.0; stretch *= 1.01) {
    KeyGrid grid = grid_of(key, square * stretch);
    const double miss = std::abs(grid.triangles() - triangles);
    if (miss < least) {
      least = miss;
      best = std::move(grid);
    }
  }
  return best;
}

PlaneArea outline(const KeyShape& key, const KeyGrid& grid) {
  PlaneArea area;
  const auto point = [&](double x, double y) {
    area.points.emplace_back(x, y);
    return static_cast<std::int32_t>(area.points.size()) - 1;
  };
  const auto quad = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    const auto at = [&](std::int32_t i) { return area.points[static_cast<std::size_t>(i)]; };
    if ((at(a) - at(c)).norm() <= (1.0 + 1e-9) * (at(b) - at(d)).norm()) {
      area.triangles.push_back({a, b, c});
      area.triangles.push_back({a, c, d});
    } else {
      area.triangles.push_back({a, b, d});
      area.triangles.push_back({b, c, d});
    }
  };

  // Directions around the bow: first those of the blade's rows, equally spaced in y, then the rest
  // of the turn.
  std::vector<Eigen::Vector2d> direction;
  for (int j = 0; j < grid.across; ++j) {
    const double y = kKeyBlade * (2.0 * j / grid.across - 1.0);
    direction.emplace_back(std::sqrt(1.0 - y * y), y);
  }
  std::vector<Eigen::Vector2d> upper;  // from the blade to +y, then to -x
  for (int j = 0; j < grid.around[0]; ++j) {
    const double a = key.joint + (0.5 * kPi - key.joint) * j / grid.around[0];
    upper.emplace_back(j == 0 ? Eigen::Vector2d(std::sqrt(1.0 - kKeyBlade * kKeyBlade), kKeyBlade)
                              : Eigen::Vector2d(std::cos(a), std::sin(a)));
  }
  for (int j = 0; j < grid.around[1]; ++j) {
    const Eigen::Vector2d c = unit_circle(j, 4 * grid.around[1]);
    upper.emplace_back(-c.y(), c.x());
  }
  direction.insert(direction.end(), upper.begin(), upper.end());
  direction.emplace_back(-1.0, 0.0);
  for (std::size_t j = upper.size() - 1; j > 0; --j) direction.emplace_back(upper[j].x(), -upper[j].y());

  const std::size_t n = direction.size();
  std::vector<Ring> rings;
  for (int k = 0; k <= grid.rings; ++k) {
    const double r = k == grid.rings ? key.bow : key.hole + (key.bow - key.hole) * k / grid.rings;
    Ring ring;
    for (const Eigen::Vector2d& c : direction) ring.push_back(point(r * c.x(), r * c.y()));
    if (k > 0)
      for (std::size_t j = 0; j < n; ++j)
        quad(rings.back()[j], ring[j], ring[(j + 1) % n], rings.back()[(j + 1) % n]);
    rings.push_back(std::move(ring));
  }

  // The blade's first column is the bow's rim. The columns up to its first corner change gradually
  // into straight ones.
  const auto rows = static_cast<std::size_t>(grid.across);
  std::vector<Ring> columns{Ring(rings.back().begin(), rings.back().begin() + grid.across + 1)};
  const auto rim = columns.front();
  for (std::size_t i = 0; i < grid.columns.size(); ++i) {
    for (int k = 1; k <= grid.columns[i]; ++k) {
      const double share = static_cast<double>(k) / grid.columns[i];
      const double along =
          share == 1.0 ? key.along[i + 1] : key.along[i] + share * (key.along[i + 1] - key.along[i]);
      const double x = along == 1.0 ? key.tip_x : key.bow + along * key.blade_length();
      const double low = -key.blade_half * (1.0 - 2.0 * depth_at(key_lower_edge(), along));
      const double high = key.blade_half * (1.0 - 2.0 * depth_at(key_upper_edge(), along));
      Ring column;
      for (std::size_t j = 0; j <= rows; ++j) {
        const double rim_x = area.points[static_cast<std::size_t>(rim[j])].x();
        const double from_rim =
            i == 0 ? rim_x + share * (key.bow + key.along[1] * key.blade_length() - rim_x) : x;
        column.push_back(
            point(i == 0 ? from_rim : x, low + (high - low) * static_cast<double>(j) / grid.across));
      }
      const Ring& last = columns.back();
      for (std::size_t j = 0; j < rows; ++j) quad(last[j], column[j], column[j + 1], last[j + 1]);
      columns.push_back(std::move(column));
    }
  }

  // The edges run along the blade's lower side, its tip, back along its upper side, and around the bow.
  Ring outer;
  for (const Ring& column : columns) outer.push_back(column.front());
  for (std::size_t j = 1; j < rows; ++j) outer.push_back(columns.back()[j]);
  for (std::size_t i = columns.size(); i-- > 0;) outer.push_back(columns[i].back());
  for (std::size_t j = rows + 1; j < n; ++j) outer.push_back(rings.back()[j]);
  area.edges = {std::move(outer), Ring(rings.front().rbegin(), rings.front().rend())};
  return area;
}

}  // namespace
}  // namespace phalanx::mesh

namespace phalanx {

TriangleMesh make_key(double length, double breadth, double thickness, int triangles) {
  constexpr const char* kMaker = "make_key";
  mesh::require_positive(length, kMaker, "length");
  mesh::require_positive(breadth, kMaker, "breadth");
  mesh::require_positive(thickness, kMaker, "thickness");
  mesh::require_triangles(triangles, kMaker);
  mesh::require_ratio(length, breadth, {1.8, 4.0}, kMaker, "length", "breadth");
  mesh::require_ratio(thickness, breadth, {0.02, 0.3}, kMaker, "thickness", "breadth");
  const mesh::KeyShape key(length, breadth, thickness);
  const mesh::KeyGrid grid = mesh::choose_grid(key, triangles);
  mesh::PlaneArea area = mesh::outline(key, grid);
  // The origin moves from the bow's centre to the middle of the length.
  for (Eigen::Vector2d& p : area.points)
    p.x() = p.x() == key.tip_x  ? 0.5 * length
            : p.x() == -key.bow ? -0.5 * length
                                : p.x() + key.bow - 0.5 * length;
  return mesh::extrude(area, thickness, grid.bands);
}

}  // namespace phalanx
