// SPDX-License-Identifier: Apache-2.0
// Bottle, cup, pen, peg, jar and tap handle as profiles around z.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/shapes/mesh_builder.h"
#include "mesh/shapes/object_shapes.h"
#include "phalanx/mesh/objects.h"

namespace phalanx::mesh {

SpunShape bottle_shape(double diameter, double length) {
  const double d = diameter;
  const double r = 0.5 * d;
  const double half = 0.5 * length;
  const double foot = kBottleFoot * d;
  const double cap_top = half - kBottleCapChamfer * d;
  const double cap_bottom = half - kBottleCapHeight * d;
  const double neck_bottom = cap_bottom - kBottleNeckSeen * d;
  const double cap = 0.5 * kBottleCap * d;
  const double neck = 0.5 * kBottleNeck * d;
  SpunShape s(-half);
  s.line_to(r - foot, -half).arc_along_r(r, -half + foot).line_to(r, neck_bottom - kBottleShoulder * d);
  s.wave_to(neck, neck_bottom).line_to(neck, cap_bottom).line_to(cap, cap_bottom).line_to(cap, cap_top);
  s.line_to(cap - kBottleCapChamfer * d, half).line_to(0.0, half);
  return s;
}

SpunShape cup_shape(double diameter, double length) {
  const double least = std::min(diameter, length);
  const double half = 0.5 * length;
  const double r = 0.5 * diameter;
  const double foot = kCupFoot * r;
  const double wall = kCupWall * least;
  const double floor = -half + kCupFloor * least;
  const double rim = half - 0.5 * wall;
  const double fillet = kCupFillet * least;
  // Returns the radius of the outer wall at height z, straight from the rim to the bottom's edge.
  const auto outer = [=](double z) { return foot + (r - foot) * (z + half) / (rim + half); };
  SpunShape s(-half);
  s.line_to(outer(-half + fillet) - fillet, -half).arc_along_r(outer(-half + fillet), -half + fillet);
  s.line_to(r, rim).arc_along_z(r - 0.5 * wall, half).arc_along_r(r - wall, rim);
  const double inner = outer(floor + 2.0 * fillet) - wall;
  s.line_to(inner, floor + 2.0 * fillet).arc_along_z(inner - 2.0 * fillet, floor).line_to(0.0, floor);
  return s;
}

SpunShape pen_shape(double diameter, double length) {
  const double r = 0.5 * diameter;
  const double half = 0.5 * length;
  const double tip = kPenTip * r;
  const double end = kPenEnd * diameter;
  SpunShape s(-half);
  s.arc_along_r(tip, -half + tip).line_to(r, -half + tip + kPenCone * diameter).line_to(r, half - end);
  s.arc_along_z(r - end, half).line_to(0.0, half);
  return s;
}

SpunShape peg_shape(double diameter, double length, double head_diameter) {
  const double r = 0.5 * diameter;
  const double half = 0.5 * length;
  const double chamfer = std::min(kPegChamfer * diameter, 0.1 * length);
  SpunShape s(-half);
  s.line_to(r - chamfer, -half).line_to(r, -half + chamfer);
  double top = r;
  if (head_diameter > 0.0) {
    const double head = half - kPegHeadLength * length;
    top = 0.5 * head_diameter;
    s.line_to(r, head).line_to(top - chamfer, head).line_to(top, head + chamfer);
  }
  s.line_to(top, half - chamfer).line_to(top - chamfer, half).line_to(0.0, half);
  return s;
}

SpunShape jar_shape(double diameter, double length, double lid_diameter) {
  const double d = diameter;
  const double r = 0.5 * d;
  const double half = 0.5 * length;
  const double foot = kJarFoot * d;
  const double lid = 0.5 * lid_diameter;
  const double lid_bottom = half - kJarLidHeight * d;
  const double neck = kJarNeck * lid;
  const double neck_bottom = lid_bottom - kJarNeckSeen * d;
  const double fillet = kJarLidFillet * d;
  SpunShape s(-half);
  s.line_to(r - foot, -half).arc_along_r(r, -half + foot).line_to(r, neck_bottom - kJarShoulder * d);
  s.arc_along_z(neck, neck_bottom).line_to(neck, lid_bottom).line_to(lid, lid_bottom);
  s.line_to(lid, half - fillet).arc_along_z(lid - fillet, half).line_to(0.0, half);
  return s;
}

SpunShape tap_handle_shape(double diameter, double length) {
  const double r = 0.5 * diameter;
  const double half = 0.5 * length;
  const double stem = kTapStem * r;
  const double head = -half + kTapStemLength * length;
  const double fillet = std::min(kTapFillet * length, kTapFilletMost * r);
  const double shoulder = half - kTapDome * length;
  SpunShape s(-half);
  s.line_to(stem, -half).line_to(stem, head).line_to(r - fillet, head).lobes_to(kTapLobes);
  s.arc_along_r(r, head + fillet).line_to(r, shoulder - fillet).arc_along_z(r - fillet, shoulder);
  s.dome_to(half).lobes_to(0.0);
  return s;
}

}  // namespace phalanx::mesh

namespace phalanx {

TriangleMesh make_bottle(double diameter, double length, int triangles) {
  constexpr const char* kMaker = "make_bottle";
  mesh::require_positive(diameter, kMaker, "diameter");
  mesh::require_positive(length, kMaker, "length");
  mesh::require_ratio(length, diameter, {1.5, 8.0}, kMaker, "length", "diameter");
  return mesh::make_spun_solid(mesh::bottle_shape(diameter, length), triangles, kMaker);
}

TriangleMesh make_cup(double diameter, double length, int triangles) {
  constexpr const char* kMaker = "make_cup";
  mesh::require_positive(diameter, kMaker, "diameter");
  mesh::require_positive(length, kMaker, "length");
  mesh::require_ratio(length, diameter, {0.5, 3.0}, kMaker, "length", "diameter");
  return mesh::make_spun_solid(mesh::cup_shape(diameter, length), triangles, kMaker);
}

TriangleMesh make_pen(double diameter, double length, int triangles) {
  constexpr const char* kMaker = "make_pen";
  mesh::require_positive(diameter, kMaker, "diameter");
  mesh::require_positive(length, kMaker, "length");
  mesh::require_ratio(length, diameter, {4.0, 40.0}, kMaker, "length", "diameter");
  return mesh::make_spun_solid(mesh::pen_shape(diameter, length), triangles, kMaker);
}

TriangleMesh make_peg(double diameter, double length, double head_diameter, int triangles) {
  constexpr const char* kMaker = "make_peg";
  mesh::require_positive(diameter, kMaker, "diameter");
  mesh::require_positive(length, kMaker, "length");
  mesh::require_ratio(length, diameter, {1.0, 20.0}, kMaker, "length", "diameter");
  if (head_diameter != 0.0) {  // 0: a plain dowel
    mesh::require_positive(head_diameter, kMaker, "head_diameter");
    mesh::require_ratio(head_diameter, diameter, {1.2, 6.0}, kMaker, "head_diameter", "diameter");
  }
  return mesh::make_spun_solid(mesh::peg_shape(diameter, length, head_diameter), triangles, kMaker);
}

TriangleMesh make_jar(double diameter, double length, double lid_diameter, int triangles) {
  constexpr const char* kMaker = "make_jar";
  mesh::require_positive(diameter, kMaker, "diameter");
  mesh::require_positive(length, kMaker, "length");
  mesh::require_positive(lid_diameter, kMaker, "lid_diameter");
  mesh::require_ratio(length, diameter, {0.7, 5.0}, kMaker, "length", "diameter");
  mesh::require_ratio(lid_diameter, diameter, {0.5, 1.05}, kMaker, "lid_diameter", "diameter");
  return mesh::make_spun_solid(mesh::jar_shape(diameter, length, lid_diameter), triangles, kMaker);
}

TriangleMesh make_tap_handle(double diameter, double length, int triangles) {
  constexpr const char* kMaker = "make_tap_handle";
  mesh::require_positive(diameter, kMaker, "diameter");
  mesh::require_positive(length, kMaker, "length");
  mesh::require_ratio(length, diameter, {0.3, 2.0}, kMaker, "length", "diameter");
  return mesh::make_spun_solid(mesh::tap_handle_shape(diameter, length), triangles, kMaker);
}

}  // namespace phalanx
