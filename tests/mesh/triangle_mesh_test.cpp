// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/triangle_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TriangleMesh unit_tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

std::string mesh_refusal(const TriangleMesh& mesh) {
  try {
    check_mesh(mesh, "cup.obj");
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

TEST(TriangleMesh, TetrahedronOfThreeUnitEdgesHasASixthOfTheirCube) {
  EXPECT_DOUBLE_EQ(signed_volume(unit_tetrahedron()), 1.0 / 6.0);
}

TEST(TriangleMesh, VolumeChangesSignWhenTheTrianglesAreTurnedOver) {
  TriangleMesh mesh = unit_tetrahedron();
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_DOUBLE_EQ(signed_volume(mesh), -1.0 / 6.0);
}

TEST(TriangleMesh, IsClosedUntilATriangleIsMissingTurnedOrDoubled) {
  EXPECT_TRUE(is_closed(unit_tetrahedron()));
  EXPECT_FALSE(is_closed(TriangleMesh{}));
  TriangleMesh missing = unit_tetrahedron();
  missing.triangles.pop_back();
  EXPECT_FALSE(is_closed(missing));
  TriangleMesh turned = unit_tetrahedron();
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_FALSE(is_closed(turned));
  TriangleMesh doubled = unit_tetrahedron();
  doubled.triangles.push_back(doubled.triangles[0]);
  EXPECT_FALSE(is_closed(doubled));
}

TEST(TriangleMesh, AppendMapsThePartByItsPose) {
  TriangleMesh mesh = unit_tetrahedron();
  append(mesh, unit_tetrahedron(), Pose{rotation_about(Vec3::UnitZ(), std::acos(-1.0) / 2.0), Vec3{5, 0, 0}});
  ASSERT_EQ(mesh.vertices.size(), 8U);
  EXPECT_LT((mesh.vertices[5] - Vec3(5, 1, 0)).norm(), 1e-15);
  EXPECT_EQ(mesh.triangles[4], (Triangle{4, 6, 5}));
  EXPECT_TRUE(is_closed(mesh));
}

TEST(TriangleMesh, AppendTakesItself) {
  TriangleMesh mesh = unit_tetrahedron();
  append(mesh, mesh, Pose{Mat3::Identity(), Vec3{2, 0, 0}});
  EXPECT_EQ(mesh.triangles.size(), 8U);
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 2.0 / 6.0);
}

TEST(TriangleMesh, BoundsAreTheExtremeCoordinates) {
  const Bounds b = bounds({{{1, -2, 3}, {-4, 5, -6}}, {}});
  EXPECT_EQ(b.min, Vec3(-4, -2, -6));
  EXPECT_EQ(b.max, Vec3(1, 5, 3));
}

TEST(TriangleMesh, CheckNamesTheMeshThePlaceAndTheValue) {
  EXPECT_EQ(mesh_refusal(unit_tetrahedron()), "accepted");
  EXPECT_THAT(mesh_refusal({}), AllOf(StartsWith("cup.obj: "), HasSubstr("no triangle")));
  TriangleMesh nan = unit_tetrahedron();
  nan.vertices[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(mesh_refusal(nan),
              AllOf(StartsWith("cup.obj: vertex 2"), HasSubstr("nan"), HasSubstr("not finite")));
  TriangleMesh high = unit_tetrahedron();
  high.triangles[3][1] = 4;
  EXPECT_THAT(mesh_refusal(high),
              AllOf(StartsWith("cup.obj: triangle 3"), HasSubstr("vertex 4"), HasSubstr("4 vertices")));
  TriangleMesh negative = unit_tetrahedron();
  negative.triangles[1][0] = -1;
  EXPECT_THAT(mesh_refusal(negative), AllOf(StartsWith("cup.obj: triangle 1"), HasSubstr("vertex -1")));
}

std::string arrays_refusal(std::vector<double> coordinates, std::vector<std::int32_t> indices) {
  try {
    static_cast<void>(mesh_from_arrays(coordinates, indices));
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

TEST(MeshFromArrays, HasTheVerticesAndTrianglesInTheirOrder) {
  const std::vector<double> coordinates{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<std::int32_t> indices{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  const TriangleMesh mesh = mesh_from_arrays(coordinates, indices);
  EXPECT_EQ(mesh.vertices, unit_tetrahedron().vertices);
  EXPECT_EQ(mesh.triangles, unit_tetrahedron().triangles);
}

TEST(MeshFromArrays, RefusesInWordsWhatIsNoMesh) {
  const std::vector<double> three{0, 0, 0, 1, 0, 0, 0, 1, 0};
  EXPECT_EQ(arrays_refusal(three, {0, 1, 2}), "accepted");
  EXPECT_THAT(arrays_refusal({0, 0, 0, 1}, {0, 1, 2}),
              AllOf(HasSubstr("4 coordinates"), HasSubstr("give x, y and z")));
  EXPECT_THAT(arrays_refusal(three, {0, 1, 2, 0}),
              AllOf(HasSubstr("4 indices"), HasSubstr("three vertices for each triangle")));
  EXPECT_THAT(arrays_refusal(three, {0, 1, 3}),
              HasSubstr("triangle 0 names vertex 3, but there are 3 vertices"));
  EXPECT_THAT(arrays_refusal(three, {0, 1, -1}), HasSubstr("names vertex -1"));
  EXPECT_THAT(arrays_refusal({0, 0, 0, 1, 0, 0, 0, std::numeric_limits<double>::quiet_NaN(), 0}, {0, 1, 2}),
              HasSubstr("vertex 2 is (0, nan, 0), not finite"));
  EXPECT_THAT(arrays_refusal(three, {}), HasSubstr("no triangle"));
}

}  // namespace
}  // namespace phalanx
