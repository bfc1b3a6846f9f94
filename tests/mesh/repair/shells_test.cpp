// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/shells.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "phalanx/mesh/primitives.h"
#include "support/sanitized.h"

namespace phalanx::mesh {
namespace {

constexpr double kTolerance = 1e-3;

TriangleMesh inside_out(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

Shells turned(TriangleMesh& mesh, TurnedShells& result) {
  const EdgeTable edges(mesh);
  const Patches patches = orient_patches(mesh, edges);
  Shells shells = find_shells(mesh, edges, patches);
  result = turn_shells_outward(mesh, shells, triangle_boxes(mesh), {}, kTolerance);
  return shells;
}

// Two triangles of a unit square that both run from vertex 1 to vertex 2, so that they wind against each
// other: of one and one the first is right, and the second is turned.
TEST(Patches, OfTwoTrianglesThatDisagreeTheFirstStaysAsItIs) {
  TriangleMesh square{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 2, 3}}};
  const EdgeTable edges(square);
  const Patches patches = orient_patches(square, edges);
  EXPECT_EQ(patches.turned, 1U);
  EXPECT_EQ(square.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}));
}

// A cube within a cube within a cube; the normals of the two outer ones point the wrong way.
TEST(Shells, ACavityPointsIntoItsHollowAndWhatLiesInItOutAgain) {
  TriangleMesh mesh = inside_out(make_box(Vec3(3, 3, 3), 12));
  append(mesh, make_box(Vec3(2, 2, 2), 12));
  append(mesh, make_box(Vec3(1, 1, 1), 12));
  TurnedShells result;
  const Shells shells = turned(mesh, result);
  ASSERT_EQ(shells.shell.size(), 3U);
  EXPECT_FALSE(shells.shell[0].cavity);
  EXPECT_TRUE(shells.shell[1].cavity);
  EXPECT_FALSE(shells.shell[2].cavity);
  EXPECT_NEAR(shells.shell[0].volume, 27.0, 1e-9);
  EXPECT_NEAR(shells.shell[1].volume, -8.0, 1e-9);
  EXPECT_NEAR(shells.shell[2].volume, 1.0, 1e-9);
  EXPECT_EQ(result.count, 2U);
  EXPECT_NEAR(result.area, 6.0 * 9.0 + 6.0 * 4.0, 1e-9);
  EXPECT_NEAR(result.largest.size, 3.0, 1e-6);
}

// A tetrahedron, a second one around it that touches it everywhere, and a box that holds both and touches the
// base. Whether the tetrahedron lies in the box can be told from the middles of its sides alone, where it
// touches one other shell (with three triangles), and not from the middle of its base, where it touches two
// (with one triangle each).
TEST(Shells, IsJudgedWhereItTouchesTheFewestOthers) {
  const std::array<Vec3, 4> corner = {Vec3(0.1, 0, 0), Vec3(1, 0, 0), Vec3(0.2, 1, 0), Vec3(0.3, 0.3, 1)};
  TriangleMesh mesh{{corner.begin(), corner.end()}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  TriangleMesh around{mesh.vertices, {mesh.triangles[0]}};
  for (std::size_t side = 1; side < 4; ++side) {
    const auto [a, b, c] = mesh.triangles[side];
    const Vec3 p = corner[static_cast<std::size_t>(a)];
    const Vec3 q = corner[static_cast<std::size_t>(b)];
    const Vec3 r = corner[static_cast<std::size_t>(c)];
    const auto middle = static_cast<std::int32_t>(around.vertices.size());
    around.vertices.push_back((p + q + r) / 3.0 + 0.1 * kTolerance * (q - p));  // no ray starts on an edge
    around.triangles.insert(around.triangles.end(), {{a, b, middle}, {b, c, middle}, {c, a, middle}});
  }
  append(mesh, around);
  append(mesh, make_box(Vec3(5, 5, 3), 12), Pose{Mat3::Identity(), Vec3(0.5, 0.5, 1.5)});
  TurnedShells result;
  const Shells shells = turned(mesh, result);
  ASSERT_EQ(shells.shell.size(), 3U);
  EXPECT_TRUE(shells.shell[0].cavity);
  EXPECT_FALSE(shells.shell[2].cavity);
}

// The outer solid shares three sides of the tetrahedron and bulges below the fourth, the first in the file.
// From the middle of that one alone it can be told that the tetrahedron lies inside: the upper side, in
// x + y + 0.6 z = 1, is hit.
TEST(Shells, IsJudgedFromItsFirstTriangleIfOnlyThatOneIsFree) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, 1}},
                    {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  TriangleMesh around = mesh;
  around.vertices.emplace_back(0.3, 0.3, -0.5);
  around.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 4}, {2, 1, 4}, {1, 0, 4}};
  append(mesh, around);
  TurnedShells result;
  const Shells shells = turned(mesh, result);
  ASSERT_EQ(shells.shell.size(), 2U);
  EXPECT_TRUE(shells.shell[0].cavity);
  EXPECT_FALSE(shells.shell[1].cavity);
}

// So many tetrahedra, each inside the next, that not all can be judged.
TEST(Shells, AreNotAllTurnedWhereThereAreTooMany) {
  if (test::kSlowBuild) GTEST_SKIP() << "RepairAttack has such shells, too";
  for (const int count : {2000, 3000}) {
    TriangleMesh mesh;
    for (int i = 1; i <= count; ++i) {
      const double s = 50.0 * i / count;
      append(mesh, {{{s, s, s}, {s, -s, -s}, {-s, s, -s}, {-s, -s, s}},
                    {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}});
    }
    TurnedShells result;
    const Shells shells = turned(mesh, result);
    EXPECT_EQ(shells.shell.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(result.complete, count == 2000);
  }
}

TEST(Shells, OfALooseTriangleIsOpenAndHoldsNothing) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  TurnedShells result;
  const Shells shells = turned(mesh, result);
  ASSERT_EQ(shells.shell.size(), 1U);
  EXPECT_EQ(shells.shell[0].first, 0U);
  EXPECT_EQ(shells.shell[0].triangles, 1U);
  EXPECT_FALSE(shells.shell[0].closed);
  EXPECT_TRUE(shells.shell[0].two_sided);
  EXPECT_FALSE(shells.shell[0].cavity);
  EXPECT_EQ(shells.shell[0].volume, 0.0);
  EXPECT_EQ(result.count, 0U);
}

// A tetrahedron's six edges, each with the corners from which its two triangles run through it.
TEST(EdgeTable, VisitsEdgesInTheOrderOfTheirVertices) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  using Seen = std::array<std::int64_t, 4>;
  std::vector<Seen> seen;
  const EdgeTable table(mesh);
  table.for_each([&](std::span<const HalfEdge> edge) {
    ASSERT_EQ(edge.size(), 2U);
    seen.push_back({edge[0].low, edge[0].high, edge[0].start, edge[1].start});
  });
  EXPECT_EQ(seen, (std::vector<Seen>{
                      {0, 1, 2, 3}, {0, 2, 0, 9}, {0, 3, 5, 10}, {1, 2, 1, 6}, {1, 3, 4, 8}, {2, 3, 7, 11}}));
  ASSERT_EQ(table.at(3, 1).size(), 2U);
  EXPECT_EQ(table.at(3, 1)[0].start, 4U);
  EXPECT_TRUE(table.at(0, 0).empty());
}

// A tetrahedron whose base is half a square of 0.5 in z = 0. The first direction of shells.cpp, from the
// middle of the small one's first triangle, goes through the other half of that square in (0.375, 0.375, 0),
// 0.1 on; all the other planes are behind.
TEST(Shells, ARayBesideATriangleMissesIt) {
  const Vec3 start = Vec3(0.375, 0.375, 0) - 0.1 * Vec3(0.61803, 0.37139, 0.69317).normalized();
  TriangleMesh mesh{{start + Vec3(0.01, 0, 0), start + Vec3(0, 0.01, 0), start + Vec3(-0.01, -0.01, 0),
                     start + Vec3(0, 0, -0.01)},
                    {{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}}};
  append(mesh, TriangleMesh{{{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}},
                            {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}});
  TurnedShells result;
  const Shells shells = turned(mesh, result);
  ASSERT_EQ(shells.shell.size(), 2U);
  EXPECT_FALSE(shells.shell[0].cavity);
  EXPECT_FALSE(shells.shell[1].cavity);
  EXPECT_EQ(result.count, 0U);
}

}  // namespace
}  // namespace phalanx::mesh
