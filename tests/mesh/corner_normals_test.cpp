// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/corner_normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "phalanx/mesh/primitives.h"

namespace phalanx {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Vec3 face_normal(const TriangleMesh& mesh, const Triangle& t) {
  const auto v = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
  return (v(1) - v(0)).cross(v(2) - v(0)).normalized();
}

/// Two unit squares that share the y axis from (0, 0, 0) to (0, 1, 0), folded by `angle`.
TriangleMesh folded(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {{{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {c, 0, s}, {c, 1, s}},
          {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}};
}

TEST(CornerNormals, OfACubeAreItsFacesNormals) {
  const TriangleMesh cube = make_box({1, 1, 1}, 300);
  const auto normals = corner_normals(cube, 30.0 * kDegree);
  for (std::size_t t = 0; t < cube.triangles.size(); ++t)
    for (const Vec3& n : normals[t]) ASSERT_LT((n - face_normal(cube, cube.triangles[t])).norm(), 1e-12);
}

TEST(CornerNormals, OfASphereAreRadialToHalfADegree) {
  const TriangleMesh sphere = make_sphere(2.0, 5000);
  const auto normals = corner_normals(sphere, 30.0 * kDegree);
  double worst = 0.0;
  for (std::size_t t = 0; t < sphere.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& radial = sphere.vertices[static_cast<std::size_t>(sphere.triangles[t][k])];
      worst = std::max(worst, std::acos(std::min(1.0, normals[t][k].dot(radial))));
      ASSERT_NEAR(normals[t][k].norm(), 1.0, 1e-12);
    }
  }
  EXPECT_LT(worst, 0.5 * kDegree);
}

TEST(CornerNormals, AverageAcrossAFoldBelowTheCreaseAngleAndNotAboveIt) {
  const TriangleMesh mesh = folded(29.9 * kDegree);
  const auto smooth = corner_normals(mesh, 30.0 * kDegree);
  // Vertex 1, on the fold: 45 degrees of triangle 0 (angles there sum to 90 on the left, 90 on the right):
  // the middle.
  const Vec3 middle{-std::sin(14.95 * kDegree), 0.0, std::cos(14.95 * kDegree)};
  EXPECT_LT((smooth[0][1] - middle).norm(), 1e-12);
  EXPECT_LT((smooth[2][0] - middle).norm(), 1e-12);
  const auto creased = corner_normals(folded(30.1 * kDegree), 30.0 * kDegree);
  EXPECT_LT((creased[0][1] - Vec3::UnitZ()).norm(), 1e-12);
}

// A cone's tip: neighbours are smooth, faces across the tip are not, but one smooth fan joins them all.
TEST(CornerNormals, AreJoinedByAnUnbrokenSmoothFan) {
  TriangleMesh cone;
  cone.vertices.push_back(Vec3::UnitZ());
  constexpr int kSides = 24;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kSides;
    cone.vertices.push_back({std::cos(angle), std::sin(angle), 0.0});
    cone.triangles.push_back({0, 1 + i, 1 + (i + 1) % kSides});
  }
  for (const auto& n : corner_normals(cone, 30.0 * kDegree)) EXPECT_LT((n[0] - Vec3::UnitZ()).norm(), 1e-12);
}

TEST(CornerNormals, OfADegenerateTriangleAreItsNeighbours) {
  // A T-shaped sliver on the edge between two triangles of the plane z = 0.
  const TriangleMesh mesh{{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, -1, 0}, {1, 1, 0}},
                          {{0, 2, 1}, {0, 1, 4}, {0, 3, 2}}};
  const auto normals = corner_normals(mesh, 30.0 * kDegree);
  for (const Vec3& n : normals[0]) EXPECT_LT((n - Vec3::UnitZ()).norm(), 1e-12);
  const auto alone = corner_normals({{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}}, 30.0 * kDegree);
  EXPECT_EQ(alone[0][0], Vec3(Vec3::UnitZ()));
}

TEST(CornerNormals, RefuseAnInvalidAngleOrMesh) {
  EXPECT_THROW((void)corner_normals(make_box({1, 1, 1}, 12), -0.1), std::invalid_argument);
  EXPECT_THROW((void)corner_normals(make_box({1, 1, 1}, 12), std::nan("")), std::invalid_argument);
  EXPECT_THROW((void)corner_normals({}, 0.5), std::invalid_argument);
}

}  // namespace
}  // namespace phalanx
