// SPDX-License-Identifier: Apache-2.0
// Shapes of a hand's segments: tapered capsule and rounded slab, with one grid for both.
#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>

#include "mesh/shapes/mesh_builder.h"
#include "phalanx/core/constants.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx {
namespace {

using mesh::MeshBuilder;
using mesh::Ring;

/// Half axes and height of one elliptic ring.
struct RingShape {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

struct SegmentGrid {
  int around;
  int cap_rings;
  int side_rings;
};

void require_grid(const SegmentGrid& grid, const char* maker) {
  const auto require = [&](int value, int least, const char* name) {
    constexpr int kMost = 10'000;
    if (value < least || value > kMost)
      throw std::invalid_argument(std::string(maker) + ": " + name + " is " + std::to_string(value) +
                                  "; give " + std::to_string(least) + " to " + std::to_string(kMost));
  };
  require(grid.around, 3, "around");
  require(grid.cap_rings, 1, "cap_rings");
  require(grid.side_rings, 1, "side_rings");
}

/// Makes a segment from -z to +z: pole, rings of the tip's cap, side, rings of the base's cap, pole. A cap's
/// argument w in (0, 1] runs from pole to edge.
TriangleMesh make_segment(const SegmentGrid& grid, double tip_pole_z, double base_pole_z,
                          const std::function<RingShape(double)>& tip_cap,
                          const std::function<RingShape(double)>& base_cap) {
  std::vector<RingShape> shapes;
  for (int i = 1; i <= grid.cap_rings; ++i)
    shapes.push_back(tip_cap(static_cast<double>(i) / grid.cap_rings));
  const RingShape tip = tip_cap(1.0);
  const RingShape base = base_cap(1.0);
  for (int i = 1; i < grid.side_rings; ++i) {
    const double w = static_cast<double>(i) / grid.side_rings;
    shapes.push_back(
        {tip.x + w * (base.x - tip.x), tip.y + w * (base.y - tip.y), tip.z + w * (base.z - tip.z)});
  }
  for (int i = grid.cap_rings; i >= 1; --i)
    shapes.push_back(base_cap(static_cast<double>(i) / grid.cap_rings));

  MeshBuilder builder;
  const std::int32_t tip_pole = builder.vertex({0.0, 0.0, tip_pole_z});
  Ring last;
  for (const RingShape& s : shapes) {
    Ring ring = builder.ring(grid.around, [&](int j) {
      const Eigen::Vector2d c = mesh::unit_circle(j, grid.around);
      return Vec3{s.x * c.x(), s.y * c.y(), s.z};
    });
    if (last.empty()) {
      builder.close_below(tip_pole, ring);
    } else {
      builder.strip(last, ring);
    }
    last = std::move(ring);
  }
  builder.close_above(last, builder.vertex({0.0, 0.0, base_pole_z}));
  return builder.take();
}

}  // namespace

TriangleMesh make_tapered_capsule(double length, double radius_base, double radius_tip, int around,
                                  int cap_rings, int side_rings) {
  constexpr const char* kMaker = "make_tapered_capsule";
  mesh::require_positive(length, kMaker, "length");
  mesh::require_positive(radius_base, kMaker, "radius_base");
  mesh::require_positive(radius_tip, kMaker, "radius_tip");
  require_grid({around, cap_rings, side_rings}, kMaker);
  // The cone touches both spheres along normals that lean by phi towards the tip:
  //   radius_base = radius_tip + length sin(phi).
  const double sin_phi = (radius_base - radius_tip) / length;
  if (std::abs(sin_phi) >= 1.0) {
    std::ostringstream message;
    message << kMaker << ": with radii " << radius_base << " m and " << radius_tip << " m a length of "
            << length
            << " m leaves one sphere inside the other; make it longer than the difference of the radii";
    throw std::invalid_argument(message.str());
  }
  const double phi = std::asin(sin_phi);
  const auto base_cap = [&](double w) {
    const double polar = w * (0.5 * kPi + phi);  // from +z
    const double radius = radius_base * std::sin(polar);
    return RingShape{radius, radius, radius_base * std::cos(polar)};
  };
  const auto tip_cap = [&](double w) {
    const double polar = w * (0.5 * kPi - phi);  // from -z
    const double radius = radius_tip * std::sin(polar);
    return RingShape{radius, radius, -length - radius_tip * std::cos(polar)};
  };
  return make_segment({around, cap_rings, side_rings}, -length - radius_tip, radius_base, tip_cap, base_cap);
}

TriangleMesh make_rounded_slab(double length, EllipticSection base, EllipticSection tip, int around,
                               int cap_rings, int side_rings) {
  constexpr const char* kMaker = "make_rounded_slab";
  mesh::require_positive(length, kMaker, "length");
  mesh::require_positive(base.breadth, kMaker, "base.breadth");
  mesh::require_positive(base.thickness, kMaker, "base.thickness");
  mesh::require_positive(tip.breadth, kMaker, "tip.breadth");
  mesh::require_positive(tip.thickness, kMaker, "tip.thickness");
  require_grid({around, cap_rings, side_rings}, kMaker);
  // A half ellipsoid over the section, which at its edge (w = 1) is exactly the section.
  const auto cap = [](const EllipticSection& s, double sign, double z, double w) {
    const double sine = w == 1.0 ? 1.0 : std::sin(w * 0.5 * kPi);
    const double cosine = w == 1.0 ? 0.0 : std::cos(w * 0.5 * kPi);
    return RingShape{0.5 * s.breadth * sine, 0.5 * s.thickness * sine, z + sign * 0.5 * s.thickness * cosine};
  };
  return make_segment(
      {around, cap_rings, side_rings}, -length - 0.5 * tip.thickness, 0.5 * base.thickness,
      [&](double w) { return cap(tip, -1.0, -length, w); }, [&](double w) { return cap(base, 1.0, 0.0, w); });
}

}  // namespace phalanx
