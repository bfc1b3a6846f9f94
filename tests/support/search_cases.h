// SPDX-License-Identifier: Apache-2.0
// Pairs of meshes, and poses of the one before the other, that a search may stumble over.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "phalanx/mesh/primitives.h"
#include "support/corner_down.h"

namespace phalanx::test {

using Random = std::mt19937_64;

inline double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
inline Vec3 in_cube(Random& random, double half) {
  const double x = between(random, -half, half);
  const double y = between(random, -half, half);
  return Vec3(x, y, between(random, -half, half));
}
inline Mat3 any_rotation(Random& random) {
  Vec3 axis = in_cube(random, 1.0);
  if (!(axis.norm() > 1e-3)) axis = Vec3::UnitX();
  return rotation_about(axis.normalized(), between(random, -3.1, 3.1));
}
inline Pose any_pose(Random& random, double half) {
  const Mat3 R = any_rotation(random);
  return Pose{R, in_cube(random, half)};
}

/// Appends a triangle with vertices of its own.
inline void add_triangle(TriangleMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
}

inline TriangleMesh first_triangles(TriangleMesh mesh, int n) {
  mesh.triangles.resize(static_cast<std::size_t>(n));
  return mesh;
}

/// Points, segments (also to and fro), slivers and whole triangles within 5 cm. A sliver is as wide as
/// `width` times its length.
inline TriangleMesh degenerate_triangles(Random& random, int n, double width) {
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i) {
    const Vec3 a = in_cube(random, 0.05);
    const Vec3 b = a + in_cube(random, 0.02);
    const Vec3 c = a + in_cube(random, 0.02);
    const double share = between(random, 0.0, 1.0);
    switch (i % 6) {
      case 0:
        add_triangle(mesh, a, a, a);
        break;
      case 1:
        add_triangle(mesh, a, b, b);
        break;
      case 2:
        add_triangle(mesh, a, b, a);
        break;
      case 3:
        add_triangle(mesh, a, b, a + 2.0 * (b - a));
        break;  // on a line, to rounding
      case 4:
        add_triangle(mesh, a, b, a + share * (b - a) + width * (c - a));
        break;
      default:
        add_triangle(mesh, a, b, c);
        break;
    }
  }
  return mesh;
}

inline TriangleMesh soup(Random& random, int n) {
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i) {
    const Vec3 a = in_cube(random, 0.1);
    const Vec3 b = in_cube(random, 0.1);
    add_triangle(mesh, a, b, in_cube(random, 0.1));
  }
  return mesh;
}

/// Narrow triangles that all run from pole to pole of a ball.
inline TriangleMesh meridians(int n) {
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i) {
    const double a = 2.0 * std::numbers::pi * i / n;
    add_triangle(mesh, Vec3(0, 0, 0.05), Vec3(0, 0, -0.05),
                 Vec3(0.05 * std::cos(a), 0.05 * std::sin(a), 0.0));
    const double b = a + 0.02;
    add_triangle(mesh, Vec3(0.05 * std::cos(a), 0.05 * std::sin(a), 0.0),
                 Vec3(0.05 * std::cos(b), 0.05 * std::sin(b), 0.0), Vec3(0, 0, 0.05));
  }
  return mesh;
}

/// Three corners on a line, to rounding: the normal of such a triangle may point anywhere. Each is
/// 30 mm long.
inline TriangleMesh needles(Random& random, int n) {
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i) {
    const Vec3 a = in_cube(random, 0.02);
    const Vec3 b = a + 0.03 * (any_rotation(random) * Vec3::UnitX());
    add_triangle(mesh, a, b, a + between(random, 0.3, 0.7) * (b - a));
  }
  return mesh;
}

struct SearchCase {
  std::string name;
  TriangleMesh segment;
  TriangleMesh object;
  std::function<Pose(Random&)> pose;
};

/// Poses of a 20 mm cube's on the upper face of a 100 mm one: exactly on it, just above, or far over an edge.
inline Pose on_the_face(Random& random) {
  constexpr double kHeights[] = {0.06, 0.06 + 1e-9, 0.06 + 50e-6, 0.06 - 1e-6, 0.061};
  const double turn = between(random, 0.0, 1.0) < 0.5 ? 0.0 : between(random, -3.0, 3.0);
  const double x = between(random, -0.07, 0.07);
  const double y = between(random, -0.07, 0.07);
  const auto height = static_cast<std::size_t>(between(random, 0.0, 4.999));
  return Pose{rotation_about(Vec3::UnitZ(), turn), Vec3(x, y, kHeights[height])};
}

/// The cube stands on an edge across an edge of the large one, which lies turned by 45 degrees.
inline Pose edge_on_edge(Random& random) {
  const Mat3 stand = rotation_about(Vec3::UnitX(), std::numbers::pi / 4.0);
  const Mat3 turn = rotation_about(Vec3::UnitZ(), between(random, -1.4, 1.4));
  const double up = std::numbers::sqrt2 * 0.06 + between(random, 0.0, 1e-4);
  const double x = between(random, -0.02, 0.02);
  const double y = between(random, -0.002, 0.002);
  const Mat3 back = rotation_about(Vec3::UnitY(), -std::numbers::pi / 4.0);  // into the large cube's frame
  return Pose{back, Vec3::Zero()} * Pose{turn * stand, Vec3(y, x, up)};
}

/// The cube stands on a corner on the upper face.
inline Pose corner_on_face(Random& random) {
  const Mat3 R = corner_down();
  const Mat3 turn = rotation_about(Vec3::UnitZ(), between(random, -3.0, 3.0));
  const double x = between(random, -0.05, 0.05);
  const double y = between(random, -0.05, 0.05);
  return Pose{turn * R, Vec3(x, y, 0.05 + std::sqrt(3.0) * 0.01 + between(random, 0.0, 1e-4))};
}

inline std::vector<SearchCase> search_cases(Random& random) {
  const TriangleMesh finger = make_tapered_capsule(0.03, 0.008, 0.006, 10, 3, 2);
  const TriangleMesh torus = make_torus(0.08, 0.02, 600);
  const TriangleMesh cube = make_box(Vec3(0.02, 0.02, 0.02), 48);
  const TriangleMesh table = make_box(Vec3(0.1, 0.1, 0.1), 108);
  const auto around = [](double half) { return [half](Random& r) { return any_pose(r, half); }; };
  std::vector<SearchCase> cases;
  cases.push_back({"smooth", finger, torus, around(0.08)});
  for (const double width : {1e-2, 1e-4, 1e-11}) {
    cases.push_back({"degenerate object, slivers " + std::to_string(std::log10(width)), finger,
                     degenerate_triangles(random, 90, width), around(0.08)});
    cases.push_back({"degenerate segment, slivers " + std::to_string(std::log10(width)),
                     degenerate_triangles(random, 60, width), torus, around(0.12)});
  }
  cases.push_back({"needles on a segment", needles(random, 12), make_sphere(0.02, 60), around(0.05)});
  cases.push_back({"an object of needles", finger, needles(random, 12), around(0.04)});
  cases.push_back({"flat on flat", cube, table, on_the_face});
  cases.push_back({"edge on edge", cube, table, edge_on_edge});
  cases.push_back({"corner on face", cube, table, corner_on_face});
  for (const int n : {1, 2, 7, 8, 9, 64, 65}) {
    cases.push_back({"object of " + std::to_string(n), finger, first_triangles(torus, n), around(0.08)});
    cases.push_back({"segment of " + std::to_string(n), first_triangles(finger, n), torus, around(0.06)});
  }
  TriangleMesh thrice = torus;
  for (int i = 0; i < 2; ++i)
    thrice.triangles.insert(thrice.triangles.end(), torus.triangles.begin(), torus.triangles.end());
  cases.push_back({"every triangle three times", finger, thrice, around(0.08)});
  cases.push_back({"soup", finger, soup(random, 60), around(0.3)});
  cases.push_back({"meridians", finger, meridians(60), around(0.12)});
  cases.push_back({"inside a large ball", finger, make_sphere(0.2, 500), around(0.05)});
  cases.push_back({"around a small ball", make_sphere(0.2, 300), make_sphere(0.01, 60), around(0.05)});
  return cases;
}

}  // namespace phalanx::test
