// SPDX-License-Identifier: Apache-2.0
#include "mesh/shapes/mug_shape.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "mesh/shapes/mesh_builder.h"
#include "phalanx/core/constants.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx::mesh {

MugShape mug_shape(double diameter, double height) {
  MugShape s;
  s.radius = 0.5 * diameter;
  s.half_height = 0.5 * height;
  const double least = std::min(diameter, height);
  s.wall = 0.05 * least;
  s.foot_fillet = 0.06 * least;
  s.inner_fillet = 0.10 * least;
  s.floor = 0.07 * least;
  s.handle_half_span = 0.29 * height;
  s.handle_reach = std::min(0.30 * diameter, 0.9 * s.handle_half_span);
  s.handle_half_width = 0.075 * least;
  s.handle_half_thickness = 0.052 * least;
  s.flare = 0.45;
  return s;
}

RevolvedSurface mug_body(const MugShape& s) {
  const double bottom = -s.half_height;
  const double inner = s.radius - s.wall;
  const double floor_z = bottom + s.floor;
  const double rim = 0.5 * s.wall;
  RevolvedSurface body;
  body.quarter = [](double q) {
    return Eigen::Vector2d{std::cos(0.5 * kPi * q), q == 0.0 ? 0.0 : std::sin(0.5 * kPi * q)};
  };
  body.profile = [=](double t) -> Eigen::Vector2d {
    const int piece = std::clamp(static_cast<int>(std::floor(t)), 0, 6);
    const double f = t - piece;
    const auto between = [&](double r0, double z0, double r1, double z1) {
      return Eigen::Vector2d{r0 + f * (r1 - r0), f == 1.0 ? z1 : z0 + f * (z1 - z0)};
    };
    switch (piece) {
      case 0:
        return between(0.0, bottom, s.radius - s.foot_fillet, bottom);
      case 1:
        return {s.radius - s.foot_fillet * (1.0 - std::sin(0.5 * kPi * f)),
                bottom + s.foot_fillet * (1.0 - std::cos(0.5 * kPi * f))};
      case 2:
        return {s.radius, between(0.0, bottom + s.foot_fillet, 0.0, s.half_height - rim).y()};
      case 3:
        return {s.radius - rim * (1.0 - std::cos(kPi * f)), s.half_height - rim * (1.0 - std::sin(kPi * f))};
      case 4:
        return {inner, between(0.0, s.half_height - rim, 0.0, floor_z + s.inner_fillet).y()};
      case 5:
        return {inner - s.inner_fillet * (1.0 - std::cos(0.5 * kPi * f)),
                floor_z + s.inner_fillet * (1.0 - std::sin(0.5 * kPi * f))};
      default:
        return {f == 1.0 ? 0.0 : (1.0 - f) * (inner - s.inner_fillet), floor_z};
    }
  };
  body.least_bands = {1, 1, 5, 2, 1, 1, 1};
  body.wall_begin = 2;
  body.wall_end = 3;
  return body;
}

Tube mug_handle(const MugShape& s) {
  Tube handle;
  handle.point = [=](double a, double v) -> Vec3 {
    // Straight stubs inside the wall precede and follow a half ellipse, which leaves the wall
    // at right angles.
    const double stub = 0.5 * s.wall;
    const double quarter = 0.06;  // share of v of each stub
    const double phi = kPi * (v - quarter) / (1.0 - 2.0 * quarter);
    Eigen::Vector2d centre;   // (x, z)
    Eigen::Vector2d tangent;  // unit
    double past = 0.0;        // approximate distance from the wall along the tube, for the flare
    if (phi < 0.0 || phi > kPi) {
      const double depth = stub * (phi < 0.0 ? 1.0 - v / quarter : 1.0 - (1.0 - v) / quarter);
      centre = {s.radius - depth, phi < 0.0 ? s.handle_half_span : -s.handle_half_span};
      tangent = {phi < 0.0 ? 1.0 : -1.0, 0.0};
    } else {
      centre = {s.radius + s.handle_reach * std::sin(phi), s.handle_half_span * std::cos(phi)};
      tangent =
          Eigen::Vector2d{s.handle_reach * std::cos(phi), -s.handle_half_span * std::sin(phi)}.normalized();
      past = s.handle_reach * std::sin(phi);
    }
    const double blend = std::max(0.0, 1.0 - past / (0.55 * s.handle_reach));
    const double scale = 1.0 + s.flare * blend * blend;
    const Eigen::Vector2d out{-tangent.y(), tangent.x()};  // away from the finger hole
    const double c = -scale * s.handle_half_thickness * std::cos(2.0 * kPi * a);
    const double w = scale * s.handle_half_width * std::sin(2.0 * kPi * a);
    return {centre.x() + c * out.x(), w, centre.y() + c * out.y()};
  };
  handle.returns = true;
  handle.keep = 0.5;
  return handle;
}

}  // namespace phalanx::mesh

namespace phalanx {

TriangleMesh make_mug(double diameter, double height, int triangles) {
  mesh::require_positive(diameter, "make_mug", "diameter");
  mesh::require_positive(height, "make_mug", "height");
  mesh::require_triangles(triangles, "make_mug");
  const double ratio = height / diameter;
  if (ratio < 0.5 || ratio > 3.0) {
    std::ostringstream message;
    message << "make_mug: a height of " << height << " m is " << ratio << " times the diameter of "
            << diameter << " m; a mug's handle fits from 0.5 to 3 times";
    throw std::invalid_argument(message.str());
  }
  const mesh::MugShape shape = mesh::mug_shape(diameter, height);
  return mesh::fit_stitched_solid(mesh::mug_body(shape), {mesh::mug_handle(shape)}, triangles, "make_mug");
}

}  // namespace phalanx
