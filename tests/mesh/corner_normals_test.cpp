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

TEST(CornerNormals, AreNeverSmoothedOverAnEdgeOfThreeFaces) {
  // Two faces 10 degrees apart, and a third that stands on their common edge.
  TriangleMesh mesh = folded(10.0 * kDegree);
  mesh.vertices.push_back({0, 0, 1});
  mesh.triangles.push_back({1, 2, 6});
  const SurfaceNormals normals = surface_normals(mesh, 30.0 * kDegree);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Vec3& n : normals.corner[t])
      ASSERT_LT((n - face_normal(mesh, mesh.triangles[t])).norm(), 1e-12) << t;
  EXPECT_EQ(normals.open_edges[0] & 2, 2) << "the edge from corner 1 to corner 2";
}

TEST(CornerNormals, OfFacesThatStandTwiceAreTheirOwn) {
  TriangleMesh mesh = folded(10.0 * kDegree);
  for (std::size_t t = 0; t < 4; ++t)
    mesh.triangles.push_back({mesh.triangles[t][1], mesh.triangles[t][0], mesh.triangles[t][2]});
  const auto normals = corner_normals(mesh, 30.0 * kDegree);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Vec3& n : normals[t]) ASSERT_LT((n - face_normal(mesh, mesh.triangles[t])).norm(), 1e-12) << t;
}

TEST(CornerNormals, OfNeighboursThatWindApartDoNotCancelOut) {
  TriangleMesh mesh = folded(10.0 * kDegree);
  std::swap(mesh.triangles[2][1], mesh.triangles[2][2]);
  std::swap(mesh.triangles[3][1], mesh.triangles[3][2]);
  const auto normals = corner_normals(mesh, 30.0 * kDegree);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Vec3& n : normals[t]) ASSERT_GT(n.dot(face_normal(mesh, mesh.triangles[t])), 0.99) << t;
}

// A tube of twelve sides is folded by 30 degrees to rounding: no rounding may pick its creases.
TEST(CornerNormals, OverFoldsOfExactlyTheCreaseAngleAreSmooth) {
  TriangleMesh tube;
  const Mat3 aslant = rotation_about(Vec3(1, 2, 3).normalized(), 0.7);  // so that there is rounding
  for (int i = 0; i < 12; ++i) {
    const Vec3 radial(std::cos(i * 30.0 * kDegree), std::sin(i * 30.0 * kDegree), 0.0);
    tube.vertices.push_back(aslant * (radial - Vec3::UnitZ()));
    tube.vertices.push_back(aslant * (radial + Vec3::UnitZ()));
    const int a = 2 * i;
    const int b = 2 * ((i + 1) % 12);
    tube.triangles.push_back({a, b, b + 1});
    tube.triangles.push_back({a, b + 1, a + 1});
  }
  const auto normals = corner_normals(tube, 30.0 * kDegree);
  for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3 radial = aslant.transpose() * tube.vertices[static_cast<std::size_t>(tube.triangles[t][k])];
      radial.z() = 0.0;
      // One side gives two triangles with 90 degrees at a corner in all, so that both sides weigh the same.
      ASSERT_LT((aslant.transpose() * normals[t][k] - radial).norm(), 1e-12) << t;
    }
  }
}

// A triangle counts as without area up to a height of a millionth of its edge, or, where that is more, of the
// rounding of single precision. Here the edge is 1 long, and that rounding is 1.94 x 2^-22 = 0.46 millionths.
TEST(CornerNormals, AreNotDisturbedByATriangleWithoutAreaInASharedEdge) {
  const TriangleMesh square = folded(20.0 * kDegree);
  const SurfaceNormals clean = surface_normals(square, 30.0 * kDegree);
  for (const double height : {1e-9, 7e-7}) {
    TriangleMesh mesh = square;
    mesh.vertices.push_back({height, 0.5, 0});
    mesh.triangles.push_back({1, 2, 6});
    const SurfaceNormals hung = surface_normals(mesh, 30.0 * kDegree);
    for (std::size_t t = 0; t < 4; ++t) {
      for (std::size_t k = 0; k < 3; ++k) EXPECT_LT((hung.corner[t][k] - clean.corner[t][k]).norm(), 1e-12);
      EXPECT_EQ(hung.open_edges[t], clean.open_edges[t]) << height;
    }
    EXPECT_EQ(hung.open_edges[4], 0) << height;
    EXPECT_GT(hung.corner[4][0].dot(clean.corner[0][1]), 0.98) << height;
  }
}

TEST(CornerNormals, TellWhichEdgesEndTheSurface) {
  // 20 degrees: smooth. 60: a crease that the second face carries on. 120: folded back. Counted by hand: 6 of
  // the squares' 8 outer edges are those of one triangle only; the diagonals are shared.
  const auto open = [](double fold) {
    int count = 0;
    for (const std::uint8_t bits : surface_normals(folded(fold * kDegree), 30.0 * kDegree).open_edges)
      for (int k = 0; k < 3; ++k) count += bits >> k & 1;
    return count;
  };
  EXPECT_EQ(open(20.0), 6);
  EXPECT_EQ(open(60.0), 6);
  EXPECT_EQ(open(120.0), 8);
  const SurfaceNormals cube = surface_normals(make_box({1, 1, 1}, 48), 30.0 * kDegree);
  for (const std::uint8_t bits : cube.open_edges) EXPECT_EQ(bits, 0) << "right angles";
}

// Corners of one smooth group have the same bits, so that they can be kept once; so have those of a face that
// is smooth with none.
TEST(CornerNormals, OfOneGroupAreTheSameToTheLastBit) {
  const TriangleMesh sphere = make_sphere(2.0, 5000);
  std::vector<const Vec3*> of_vertex(sphere.vertices.size(), nullptr);
  const auto normals = corner_normals(sphere, 30.0 * kDegree);
  for (std::size_t t = 0; t < sphere.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3*& first = of_vertex[static_cast<std::size_t>(sphere.triangles[t][k])];
      if (first == nullptr) first = &normals[t][k];
      ASSERT_EQ(*first, normals[t][k]) << t;
    }
  }
  for (const auto& n : corner_normals(sphere, 0.0)) {
    ASSERT_EQ(n[0], n[1]);
    ASSERT_EQ(n[0], n[2]);
  }
}

TEST(CornerNormals, RefuseAnInvalidAngleOrMesh) {
  EXPECT_THROW((void)corner_normals(make_box({1, 1, 1}, 12), -0.1), std::invalid_argument);
  EXPECT_THROW((void)corner_normals(make_box({1, 1, 1}, 12), std::nan("")), std::invalid_argument);
  EXPECT_THROW((void)corner_normals({}, 0.5), std::invalid_argument);
}

}  // namespace
}  // namespace phalanx
