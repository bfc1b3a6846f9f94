// SPDX-License-Identifier: Apache-2.0
// Small meshes with one thing wrong with each, counted by hand.
#include "mesh/repair/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh_checks.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx::mesh {
namespace {

using ::testing::HasSubstr;

/// Twelve triangles of a cube with this edge, its least corner at `at`.
TriangleMesh cube(double edge, const Vec3& at = Vec3::Zero()) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.push_back(at + edge * Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

void turn(Triangle& t) { std::swap(t[1], t[2]); }
TriangleMesh turned(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) turn(t);
  return mesh;
}

struct Repaired {
  TriangleMesh mesh;
  MeshReport report;
  [[nodiscard]] std::size_t found(FindingKind kind) const { return report.finding(kind).found; }
  [[nodiscard]] std::size_t repaired(FindingKind kind) const { return report.finding(kind).repaired; }
};

Repaired repaired(const TriangleMesh& soup, const RepairOptions& options = {}) {
  Repaired r;
  r.mesh = repair(soup, options, "test", r.report);
  check_mesh(r.mesh, "repaired");
  return r;
}

std::string repair_refusal(const TriangleMesh& soup, const RepairOptions& options = {}) {
  try {
    MeshReport report;
    (void)repair(soup, options, "test", report);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

/// All that was found, as words: what a test expects, and nothing else.
std::string findings(const Repaired& r) {
  std::string text;
  for (const MeshFinding& f : r.report.findings)
    text += (text.empty() ? "" : ", ") + std::string(finding_name(f.kind)) + " " + std::to_string(f.found) +
            "/" + std::to_string(f.repaired);
  return text;
}

constexpr double kEdge = 0.05;
constexpr double kVolume = kEdge * kEdge * kEdge;

TEST(Repair, FindsNothingInACleanCubeAndLeavesItBitByBit) {
  const TriangleMesh made = cube(kEdge);
  const Repaired r = repaired(made);
  EXPECT_EQ(findings(r), "");
  EXPECT_TRUE(test::corner_positions(r.mesh) == test::corner_positions(made));
  EXPECT_TRUE(r.report.closed);
  EXPECT_EQ(r.report.solids, 1U);
  EXPECT_NEAR(r.report.volume, kVolume, 1e-15);
  EXPECT_EQ(r.report.moved, 0.0);
}

TEST(Repair, CountsUnreferencedVertices) {
  TriangleMesh mesh = cube(kEdge);
  mesh.vertices.emplace_back(9, 9, 9);
  mesh.vertices.emplace_back(8, 8, 8);
  const Repaired r = repaired(mesh);
  EXPECT_EQ(findings(r), "unreferenced_vertices 2/2");
  EXPECT_EQ(r.report.vertices_in_file, 10U);
  EXPECT_EQ(r.report.triangles_in_file, 12U);
  EXPECT_EQ(r.mesh.vertices.size(), 8U);
  const MeshFinding unused = r.report.finding(FindingKind::kUnreferencedVertices);
  for (const double number : {unused.size, unused.width, unused.area}) EXPECT_EQ(number, 0.0);
  EXPECT_FALSE(unused.at);
}

TEST(Repair, WeldsEqualVertices) {
  TriangleMesh soup;  // as an .stl: 36 corners of 8 vertices
  for (const Triangle& t : cube(kEdge).triangles) {
    const auto first = static_cast<std::int32_t>(soup.vertices.size());
    for (const std::int32_t v : t) soup.vertices.push_back(cube(kEdge).vertices[static_cast<std::size_t>(v)]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  const Repaired r = repaired(soup);
  EXPECT_EQ(findings(r), "duplicate_vertices 28/28");
  EXPECT_EQ(r.report.vertices_in_file, 36U);
  EXPECT_TRUE(r.report.closed);
}

TEST(Repair, ClosesACrackNarrowerThanASixthOfTheTolerance) {
  TriangleMesh mesh = cube(kEdge);
  // The last face gets corners of its own, 0.05 um off: tolerance 0.5 um for 50 mm.
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  for (const int v : {1, 3, 7, 5})
    mesh.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)] + Vec3(0.05e-6, 0, 0));
  mesh.triangles[10] = {first, first + 1, first + 3};
  mesh.triangles[11] = {first + 1, first + 2, first + 3};
  const Repaired r = repaired(mesh);
  EXPECT_EQ(findings(r), "near_vertices 4/4");
  EXPECT_NEAR(r.report.finding(FindingKind::kNearVertices).size, 0.05e-6, 1e-12);
  EXPECT_NEAR(r.report.moved, 0.05e-6, 1e-12);
  EXPECT_TRUE(r.report.closed);
  EXPECT_EQ(r.mesh.vertices.size(), 8U);
}

TEST(Repair, LeavesAWiderCrackOpen) {
  TriangleMesh mesh = cube(kEdge);
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  for (const int v : {1, 3, 7, 5})
    mesh.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)] + Vec3(5e-6, 0, 0));
  mesh.triangles[10] = {first, first + 1, first + 3};
  mesh.triangles[11] = {first + 1, first + 2, first + 3};
  const Repaired r = repaired(mesh);
  EXPECT_EQ(findings(r), "slits 1/0, sheets 2/0");
  EXPECT_NEAR(r.report.finding(FindingKind::kSlits).width, 5e-6, 1e-12);
  EXPECT_NEAR(r.report.finding(FindingKind::kSlits).size, 8 * kEdge, 1e-12) << "both sides of the crack";
  EXPECT_EQ(r.report.moved, 0.0);
}

TEST(Repair, KeepsVerticesOfAClosedSurfaceHoweverNear) {
  const Repaired r = repaired(make_sphere(0.02, 200'000));
  EXPECT_EQ(r.found(FindingKind::kNearVertices), 0U);
  EXPECT_EQ(r.report.moved, 0.0);
  EXPECT_TRUE(r.report.closed);
}

TEST(Repair, DropsTrianglesWithTwoEqualCorners) {
  TriangleMesh mesh = cube(kEdge);
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({4, 5, 4});
  EXPECT_EQ(findings(repaired(mesh)), "degenerate_faces 2/2");
}

// A corner on the long edge of its own triangle: the flat triangle and the one beyond the edge share the
// latter's area.
TEST(Repair, FlipsAFlatTriangleAway) {
  TriangleMesh mesh = cube(kEdge);
  // Vertex 8 in the middle of edge 1-2; of its two triangles {0,2,1} becomes {0,2,8}, {0,8,1}, while {1,2,3}
  // stays and the flat {1,8,2} fills the gap.
  mesh.vertices.push_back(0.5 * (mesh.vertices[1] + mesh.vertices[2]));
  mesh.triangles[0] = {0, 2, 8};
  mesh.triangles.push_back({0, 8, 1});
  mesh.triangles.push_back({1, 8, 2});
  ASSERT_TRUE(is_closed(mesh));
  const Repaired r = repaired(mesh);
  EXPECT_EQ(findings(r), "degenerate_faces 1/1");
  EXPECT_TRUE(r.report.closed);
  EXPECT_EQ(r.mesh.triangles.size(), 14U);
  EXPECT_NEAR(r.report.volume, kVolume, 1e-15);
  const MeshFinding flat = r.report.finding(FindingKind::kDegenerateFaces);
  EXPECT_NEAR(flat.size, kEdge * std::numbers::sqrt2, 1e-12) << "from vertex 1 to vertex 2";
  ASSERT_TRUE(flat.at);
  EXPECT_LT((*flat.at - Vec3(kEdge / 2, kEdge / 2, 0)).norm(), 1e-12);
}

TEST(Repair, CollapsesANeedle) {
  // Vertex 8 is 2 nm from vertex 7 along the cube's upper edge and splits the edge's two triangles.
  TriangleMesh mesh = cube(kEdge);
  mesh.vertices.push_back(mesh.vertices[7] - Vec3(2e-9, 0, 0));
  // Edge 6-7 belongs to {5,7,6} and {3,6,7}.
  mesh.triangles[3] = {5, 7, 8};
  mesh.triangles.push_back({5, 8, 6});
  mesh.triangles[7] = {3, 6, 8};
  mesh.triangles.push_back({3, 8, 7});
  ASSERT_TRUE(is_closed(mesh));
  const Repaired r = repaired(mesh);
  EXPECT_EQ(r.found(FindingKind::kDegenerateFaces), 2U);
  EXPECT_TRUE(r.report.closed);
  EXPECT_EQ(r.mesh.triangles.size(), 12U);
  EXPECT_NEAR(r.report.moved, 2e-9, 1e-12);
  // The first needle, {5, 7, 8}, is as long as the cube's upright edge from 5 to 7.
  const MeshFinding needle = r.report.finding(FindingKind::kDegenerateFaces);
  EXPECT_NEAR(needle.size, kEdge, 1e-12);
  ASSERT_TRUE(needle.at);
  EXPECT_LT((*needle.at - Vec3(kEdge, kEdge / 2, kEdge)).norm(), 3e-9);
}

// Vertex 8 on the edge from 6 to 7, as far from 7 as a step may move a point, or a little farther: the flat
// triangle between them goes as 8 and 7 become one, or by a flip, which leaves as many triangles.
TEST(Repair, MakesTwoCornersOneUpToASixthOfTheTolerance) {
  const double reach = 1e-5 * kEdge / 6.0;
  for (const double gap : {reach, 1.01 * reach}) {
    TriangleMesh mesh = cube(kEdge, Vec3(-kEdge, 0, 0));
    mesh.vertices.push_back(mesh.vertices[7] - Vec3(gap, 0, 0));
    mesh.triangles[7] = {3, 6, 8};
    mesh.triangles.push_back({3, 8, 7});
    mesh.triangles.push_back({6, 7, 8});
    ASSERT_TRUE(is_closed(mesh));
    const Repaired r = repaired(mesh);
    EXPECT_EQ(findings(r), "degenerate_faces 1/1") << gap;
    EXPECT_EQ(r.mesh.triangles.size(), gap > reach ? 14U : 12U) << gap;
  }
}

// A sheet with a flat triangle from 0 and 1, which are 50 nm apart, to 2. It goes as 1 moves to 0, unless the
// line from 5 to 6 passes between them: then the triangle 1, 6, 5 would be turned over.
TEST(Repair, TurnsNoTriangleOverForAFlatOne) {
  for (const double line : {25e-9, 75e-9}) {
    TriangleMesh sheet;
    sheet.vertices = {{-50e-9, 0, 0}, {0, 0, 0},         {0.02, 0, 0},     {-0.02, -0.01, 0},
                      {0, 0.02, 0},   {-line, -0.02, 0}, {-line, -0.01, 0}};
    sheet.triangles = {{1, 2, 0}, {1, 0, 3}, {1, 3, 6}, {1, 6, 5},
                       {1, 5, 2}, {3, 5, 6}, {0, 2, 4}, {0, 4, 3}};
    const Repaired r = repaired(sheet);
    EXPECT_EQ(r.found(FindingKind::kDegenerateFaces), 1U) << line;
    EXPECT_EQ(r.repaired(FindingKind::kDegenerateFaces), line > 50e-9 ? 1U : 0U) << line;
    EXPECT_EQ(r.mesh.triangles.size(), line > 50e-9 ? 6U : 8U) << line;
  }
}

// Two needles that hang together along their short side of 2 nm: no other triangle lies along their lines.
TEST(Repair, KeepsTwoFlatTrianglesThatCoverEachOtherAlone) {
  TriangleMesh mesh;
  mesh.vertices = {{0.1, 0, 0}, {0.1, 2e-9, 0}, {0.12, 0, 0}, {0.08, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  append(mesh, cube(kEdge));
  const Repaired r = repaired(mesh);
  EXPECT_EQ(r.found(FindingKind::kDegenerateFaces), 2U);
  EXPECT_EQ(r.repaired(FindingKind::kDegenerateFaces), 0U);
  EXPECT_EQ(r.mesh.triangles.size(), 14U);
}

// Two corners of a needle in the air are 0.05 um apart. They stay two, and the crack of the cube is closed.
TEST(Repair, KeepsANeedleInTheAirAndClosesACrackElsewhere) {
  TriangleMesh mesh = cube(kEdge);
  for (const std::size_t v : {1U, 3U, 7U, 5U})
    mesh.vertices.push_back(mesh.vertices[v] + Vec3(0.05e-6, 0, 0));
  mesh.triangles[10] = {8, 9, 11};
  mesh.triangles[11] = {9, 10, 11};
  for (const Vec3& p : {Vec3(0.1, 0, 0), Vec3(0.1, 0.05e-6, 0), Vec3(0.12, 0, 0)}) mesh.vertices.push_back(p);
  mesh.triangles.push_back({12, 13, 14});
  const Repaired r = repaired(mesh);
  EXPECT_EQ(r.repaired(FindingKind::kNearVertices), 4U);
  EXPECT_EQ(r.mesh.triangles.size(), 13U);
  EXPECT_EQ(r.report.solids, 1U);
  EXPECT_TRUE(r.report.complete);
}

TEST(Repair, KeepsAFlatTriangleThatNothingCovers) {
  TriangleMesh mesh = cube(kEdge);
  for (const double x : {0.1, 0.11, 0.12}) mesh.vertices.emplace_back(x, 0, 0);
  mesh.triangles.push_back({8, 9, 10});
  const Repaired r = repaired(mesh);
  EXPECT_EQ(r.found(FindingKind::kDegenerateFaces), 1U);
  EXPECT_EQ(r.repaired(FindingKind::kDegenerateFaces), 0U);
  EXPECT_EQ(r.mesh.triangles.size(), 13U) << "it can be met, so it stays";
  mesh.triangles.push_back({0, 0, 1});  // longer, but it goes
  for (const Repaired& with : {r, repaired(mesh)}) {
    const MeshFinding flat = with.report.finding(FindingKind::kDegenerateFaces);
    EXPECT_NEAR(flat.size, 0.02, 1e-12) << "where to look is what remains";
    ASSERT_TRUE(flat.at);
    EXPECT_LT((*flat.at - Vec3(0.11, 0, 0)).norm(), 1e-12);
  }
}

TEST(Repair, DropsDuplicateFacesInEitherWinding) {
  TriangleMesh mesh = cube(kEdge);
  mesh.triangles.push_back({1, 0, 2});  // {0, 2, 1} started elsewhere
  mesh.triangles.push_back({1, 3, 2});  // {1, 2, 3} from behind
  const Repaired r = repaired(mesh);
  EXPECT_EQ(findings(r), "duplicate_faces 2/2");
  EXPECT_TRUE(r.report.closed);
}

TEST(Repair, TurnsOneFaceThatWindsAgainstItsNeighbours) {
  TriangleMesh mesh = cube(kEdge);
  turn(mesh.triangles[4]);
  const Repaired r = repaired(mesh);
  EXPECT_EQ(findings(r), "inconsistent_winding 1/1");
  EXPECT_TRUE(test::corner_positions(r.mesh) == test::corner_positions(cube(kEdge)));
}

TEST(Repair, TurnsAnInsideOutSolidOutward) {
  const Repaired r = repaired(turned(cube(kEdge)));
  EXPECT_EQ(findings(r), "inside_out 1/1");
  EXPECT_NEAR(r.report.volume, kVolume, 1e-15);
  EXPECT_GT(signed_volume(r.mesh), 0.0);
}

// A hollow cube: the inner wall's normals point into the hollow, whatever the file says.
TEST(Repair, KnowsTheWallOfAHollow) {
  for (const bool inner_is_turned : {false, true}) {
    for (const bool outer_is_turned : {false, true}) {
      const TriangleMesh outer = cube(kEdge);
      const TriangleMesh inner = cube(0.02, Vec3::Constant(0.015));
      TriangleMesh mesh = outer_is_turned ? turned(outer) : outer;
      append(mesh, inner_is_turned ? turned(inner) : inner);
      const Repaired r = repaired(mesh);
      const std::size_t wrong = (outer_is_turned ? 1U : 0U) + (inner_is_turned ? 0U : 1U);
      EXPECT_EQ(r.found(FindingKind::kInsideOut), wrong);
      EXPECT_EQ(r.report.solids, 1U);
      EXPECT_EQ(r.report.cavities, 1U);
      EXPECT_NEAR(r.report.volume, kVolume - 8e-6, 1e-14);
      EXPECT_NEAR(signed_volume(r.mesh), kVolume - 8e-6, 1e-14);
    }
  }
}

TEST(Repair, KnowsASolidWithinAHollow) {
  TriangleMesh mesh = cube(0.05);
  append(mesh, cube(0.03, Vec3::Constant(0.01)));
  append(mesh, cube(0.01, Vec3::Constant(0.02)));
  const Repaired r = repaired(mesh);
  EXPECT_EQ(r.report.solids, 2U);
  EXPECT_EQ(r.report.cavities, 1U);
  EXPECT_NEAR(r.report.volume, 125e-6 - 27e-6 + 1e-6, 1e-13);
}

// The first direction of shells.cpp, from the middle of the inner solid's first triangle, runs through a
// corner of the outer one: it tells nothing, and the next one tells.
TEST(Repair, KnowsAHollowWhereTheFirstRayGrazesACorner) {
  const Vec3 u = Vec3(0.61803, 0.37139, 0.69317).normalized();
  const Vec3 v = u.unitOrthogonal();
  const Vec3 w = u.cross(v);
  TriangleMesh mesh;
  mesh.vertices = {0.01 * Vec3(1, 0, 0), 0.01 * Vec3(0, 1, 0), 0.01 * Vec3(-1, -1, 0), 0.01 * Vec3(0, 0, -1)};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}};
  TriangleMesh octahedron;
  for (const Vec3& axis : {u, v, w}) {
    octahedron.vertices.push_back(0.05 * axis);
    octahedron.vertices.push_back(-0.05 * axis);
  }
  for (std::int32_t i = 0; i < 2; ++i) {
    for (std::int32_t j = 2; j < 4; ++j) {
      for (std::int32_t k = 4; k < 6; ++k)
        octahedron.triangles.push_back((i + j + k) % 2 == 0 ? Triangle{i, j, k} : Triangle{j, i, k});
    }
  }
  append(mesh, octahedron);
  const Repaired r = repaired(mesh);
  EXPECT_EQ(r.report.solids, 1U);
  EXPECT_EQ(r.report.cavities, 1U);
}

TEST(Repair, TakesNeitherOfTwoCrossingSolidsForAHollow) {
  TriangleMesh mesh = cube(0.05);
  append(mesh, turned(cube(0.05, Vec3::Constant(0.02))));
  const Repaired r = repaired(mesh);
  EXPECT_EQ(r.report.solids, 2U);
  EXPECT_EQ(r.found(FindingKind::kInsideOut), 1U);
  EXPECT_GT(r.found(FindingKind::kSelfIntersections), 0U);
}

// 2 x 4 triangles around the open side; the rim is the face's outline. Five squares are left of the surface,
// and its first triangle is {0, 2, 1}.
TEST(Repair, MeasuresAHoleAndLeavesItOpen) {
  TriangleMesh mesh = cube(kEdge);
  mesh.triangles.resize(10);
  const Repaired r = repaired(mesh);
  const auto expect_open_box = [](const MeshFinding& sheet) {
    EXPECT_NEAR(sheet.size, kEdge, 1e-12);
    EXPECT_NEAR(sheet.area, 5 * kEdge * kEdge, 1e-15);
    ASSERT_TRUE(sheet.at);
    EXPECT_LT((*sheet.at - Vec3(kEdge / 3, kEdge / 3, 0)).norm(), 1e-12);
  };
  EXPECT_EQ(findings(r), "holes 1/0, sheets 1/0");
  EXPECT_NEAR(r.report.finding(FindingKind::kHoles).size, 4 * kEdge, 1e-12);
  EXPECT_NEAR(r.report.finding(FindingKind::kHoles).width, kEdge, 1e-12);
  expect_open_box(r.report.finding(FindingKind::kSheets));
  EXPECT_EQ(r.report.solids, 0U);
  EXPECT_FALSE(r.report.closed);
  EXPECT_EQ(r.mesh.triangles.size(), 10U);
  // A larger cube beside it is closed, and so no part of the sheet.
  append(mesh, cube(2 * kEdge, Vec3(0.2, 0, 0)));
  const Repaired beside = repaired(mesh);
  EXPECT_EQ(findings(beside), "holes 1/0, sheets 1/0");
  EXPECT_EQ(beside.report.solids, 1U);
  expect_open_box(beside.report.finding(FindingKind::kSheets));
}

// Every triangle by itself, shrunk so that 10 um lie between neighbours: nothing for a finger to go through.
TEST(Repair, TellsCracksFromHoles) {
  TriangleMesh mesh;
  const TriangleMesh whole = cube(kEdge);
  for (const Triangle& t : whole.triangles) {
    const Vec3 a = whole.vertices[static_cast<std::size_t>(t[0])];
    const Vec3 b = whole.vertices[static_cast<std::size_t>(t[1])];
    const Vec3 c = whole.vertices[static_cast<std::size_t>(t[2])];
    // Every edge 5 um inwards: towards the centre of the inscribed circle, by 5 um of its radius.
    const double la = (b - c).norm(), lb = (c - a).norm(), lc = (a - b).norm();
    const Vec3 centre = (la * a + lb * b + lc * c) / (la + lb + lc);
    const double radius = (b - a).cross(c - a).norm() / (la + lb + lc);
    const auto first = static_cast<std::int32_t>(mesh.vertices.size());
    for (const Vec3& p : {a, b, c}) mesh.vertices.push_back(p + (centre - p) * (5e-6 / radius));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  const Repaired r = repaired(mesh);
  EXPECT_EQ(findings(r), "slits 1/0, sheets 12/0");
  const MeshFinding slits = r.report.finding(FindingKind::kSlits);
  EXPECT_NEAR(slits.width, 10e-6, 0.1e-6) << "across a face; 7 um over the cube's edges";
  EXPECT_THAT(finding_meaning(slits), HasSubstr("no fingertip goes through"));
  mesh.triangles.resize(10);  // and one face away: 50 mm wide
  const Repaired open = repaired(mesh);
  EXPECT_EQ(open.found(FindingKind::kSlits), 1U);
  const MeshFinding hole = open.report.finding(FindingKind::kHoles);
  EXPECT_EQ(hole.found, 1U);
  EXPECT_NEAR(hole.width, kEdge, 20e-6);
  ASSERT_TRUE(hole.at);
  EXPECT_LT((*hole.at - Vec3(kEdge, kEdge / 2, kEdge / 2)).norm(), 20e-6);
}

// A plate of 60 mm and, 10 um beside its first quarter, one of 14 mm. The long edge has a neighbour along
// less than half of its length: it stays a border, and the slit is as long as the short edge.
TEST(Repair, CountsAnEdgeAsASlitOnlyIfMostOfItFacesTheOtherSide) {
  TriangleMesh mesh;
  const auto add_plate = [&](double x, double y, double size) {
    const auto first = static_cast<std::int32_t>(mesh.vertices.size());
    for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
      mesh.vertices.emplace_back(x + i * size, y + j * size, 0.0);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  add_plate(0.0, 0.0, 0.060);
  add_plate(0.003, -0.014 - 10e-6, 0.014);
  const Repaired r = repaired(mesh);
  EXPECT_EQ(r.found(FindingKind::kSlits), 1U);
  EXPECT_NEAR(r.report.finding(FindingKind::kSlits).size, 0.014, 1e-6);
  EXPECT_NEAR(r.report.finding(FindingKind::kSlits).width, 10e-6, 1e-9);
}

// In mm. A plate 1 mm above a larger one: the larger one's surface lies below the other's edge. A narrow
// strip whose end looks along a plate's edge. A spike that points at a strip's end. All within 3 mm, and no
// slit.
TEST(Repair, TakesEdgesThatDoNotFaceEachOtherForNoSlit) {
  const auto plate = [](const Vec3& low, const Vec3& high) {
    return TriangleMesh{{low, Vec3(high.x(), low.y(), low.z()), high, Vec3(low.x(), high.y(), low.z())},
                        {{0, 1, 2}, {0, 2, 3}}};
  };
  const TriangleMesh spike{{{0, 0, 0}, {-30, 1, 0}, {-30, -1, 0}}, {{0, 1, 2}}};
  const std::pair<TriangleMesh, TriangleMesh> pairs[] = {
      {plate({-30, -30, 0}, {30, 30, 0}), plate({-29, -29, 1}, {29, 29, 1})},
      {plate({-3, -30, 0}, {0, 0, 0}), plate({1, -10, 0}, {31, 20, 0})},
      {spike, plate({2, -1.5, 0}, {32, 1.5, 0})}};
  for (const auto& [one, other] : pairs) {
    TriangleMesh mesh = one;
    append(mesh, other);
    EXPECT_EQ(findings(repaired(mesh, {.unit = 1e-3})), "outlines 2/0, sheets 2/0") << one.vertices[0].x();
  }
}

TEST(Repair, FindsNoHoleInALoneTriangle) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.05, 0, 0}, {0, 0.03, 0}};
  mesh.triangles = {{0, 1, 2}};
  const Repaired r = repaired(mesh);
  EXPECT_EQ(findings(r), "outlines 1/0, sheets 1/0");
  const MeshFinding sheet = r.report.finding(FindingKind::kSheets);
  EXPECT_NEAR(sheet.size, 0.05, 1e-12);
  EXPECT_NEAR(sheet.area, 0.5 * 0.05 * 0.03, 1e-15);
  ASSERT_TRUE(sheet.at);
  EXPECT_LT((*sheet.at - Vec3(0.05 / 3, 0.01, 0)).norm(), 1e-12);
}

// A plate of 60 x 60 mm with an opening of 40 x `width` in the middle: the rim outside and the one inside. An
// opening is measured along its longest edge and across, however the plate lies.
TEST(Repair, TellsAPlatesOutlineFromTheHoleInIt) {
  const Mat3 aslant = rotation_about(Vec3(1, 2, 3).normalized(), 0.7);
  for (const auto& [width, turned_by] :
       {std::pair{0.01, Mat3(Mat3::Identity())}, {0.002, Mat3(Mat3::Identity())}, {0.01, aslant}}) {
    TriangleMesh mesh;
    const double h = width / 2;
    mesh.vertices = {{-0.03, -0.03, 0}, {0.03, -0.03, 0}, {0.03, 0.03, 0}, {-0.03, 0.03, 0},
                     {-0.02, -h, 0},    {0.02, -h, 0},    {0.02, h, 0},    {-0.02, h, 0}};
    mesh.triangles = {{0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
    for (Vec3& v : mesh.vertices) v = turned_by * v;
    const Repaired r = repaired(mesh);
    EXPECT_NEAR(r.report.finding(FindingKind::kOutlines).size, 0.24, 1e-12);
    EXPECT_EQ(r.report.finding(FindingKind::kOutlines).width, 0.0);
    EXPECT_EQ(r.found(FindingKind::kHoles), width > 0.003 ? 1U : 0U);
    const MeshFinding opening = r.report.finding(width > 0.003 ? FindingKind::kHoles : FindingKind::kSlits);
    EXPECT_GE(opening.found, 1U);
    EXPECT_NEAR(opening.width, width, 1e-12);
  }
}

// In the file's own units and axes, whatever size is asked for.
TEST(Repair, SaysWhereInTheFilesNumbers) {
  TriangleMesh mesh = cube(50, Vec3(100, 200, 300));
  mesh.triangles.resize(10);                         // the face x = 150 is open
  mesh.triangles.push_back({0, 0, 1});               // no area
  mesh.triangles.push_back(mesh.triangles.front());  // twice
  turn(mesh.triangles[4]);
  for (const RepairOptions& options : {RepairOptions{.unit = 1e-3}, RepairOptions{.size = 0.09}}) {
    const Repaired r = repaired(mesh, options);
    const double mm = r.report.scale;
    const auto expect = [&](FindingKind kind, double size, const Vec3& at) {
      const MeshFinding f = r.report.finding(kind);
      SCOPED_TRACE(finding_name(kind));
      EXPECT_NEAR(f.size, size * mm, 1e-9);
      ASSERT_TRUE(f.at);
      EXPECT_LT((*f.at - at).norm(), 1e-9) << f.at->transpose();
    };
    expect(FindingKind::kHoles, 200, Vec3(150, 225, 325));
    expect(FindingKind::kDegenerateFaces, 50, Vec3(125, 200, 300));
    const double diagonal = 50 * std::numbers::sqrt2;
    expect(FindingKind::kDuplicateFaces, diagonal, Vec3(100 + 50 / 3.0, 200 + 50 / 3.0, 300));
    expect(FindingKind::kInconsistentWinding, diagonal, Vec3(100 + 50 / 3.0, 200, 300 + 50 / 3.0));
    EXPECT_NEAR(r.report.finding(FindingKind::kInconsistentWinding).area, 1250 * mm * mm, 1e-12);
    expect(FindingKind::kSheets, 50, Vec3(100 + 50 / 3.0, 200 + 50 / 3.0, 300));
    for (const MeshFinding& f : r.report.findings)
      EXPECT_NEAR(f.width, f.kind == FindingKind::kHoles ? 50 * mm : 0.0, 1e-12) << finding_name(f.kind);
  }
}

TEST(Repair, KeepsTwoCubesThatShareAnEdgeAsTwoSolids) {
  TriangleMesh mesh = cube(kEdge);
  append(mesh, turned(cube(kEdge, Vec3(kEdge, kEdge, 0))));
  const Repaired r = repaired(mesh);
  EXPECT_EQ(findings(r), "duplicate_vertices 2/2, inside_out 1/1, non_manifold_edges 1/0");
  const MeshFinding edge = r.report.finding(FindingKind::kNonManifoldEdges);
  EXPECT_NEAR(edge.size, kEdge, 1e-12);
  ASSERT_TRUE(edge.at);
  EXPECT_LT((*edge.at - Vec3(kEdge, kEdge, kEdge / 2)).norm(), 1e-12);
  EXPECT_NEAR(r.report.finding(FindingKind::kInsideOut).size, kEdge, 1e-12);
  EXPECT_NEAR(r.report.finding(FindingKind::kInsideOut).area, 6 * kEdge * kEdge, 1e-12);
  EXPECT_EQ(r.report.solids, 2U);
  EXPECT_NEAR(signed_volume(r.mesh), 2 * kVolume, 1e-14);
}

TEST(Repair, CountsAPinchVertex) {
  TriangleMesh mesh = cube(kEdge);
  append(mesh, cube(kEdge, Vec3::Constant(kEdge)));  // corner to corner
  const Repaired r = repaired(mesh);
  EXPECT_EQ(findings(r), "duplicate_vertices 1/1, pinch_vertices 1/0");
  const MeshFinding pinch = r.report.finding(FindingKind::kPinchVertices);
  EXPECT_NEAR(pinch.size, kEdge, 1e-12) << "no diagonal ends there";
  ASSERT_TRUE(pinch.at);
  EXPECT_EQ(*pinch.at, Vec3(Vec3::Constant(kEdge)));
  EXPECT_EQ(r.report.solids, 2U);
}

// Of the edges that end in the common corner the one to (-40, -10) mm is the longest.
TEST(Repair, MeasuresThePinchOfTwoLooseTriangles) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.03, 0, 0}, {0.03, 0.02, 0}, {-0.04, 0, 0}, {-0.04, -0.01, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
  const MeshFinding pinch = repaired(mesh).report.finding(FindingKind::kPinchVertices);
  EXPECT_EQ(pinch.found, 1U);
  EXPECT_NEAR(pinch.size, std::hypot(0.04, 0.01), 1e-12);
  ASSERT_TRUE(pinch.at);
  EXPECT_EQ(*pinch.at, Vec3(0, 0, 0));
}

// Three triangles on one edge of 30 mm, 20 mm and twice sqrt(500) mm high: one sheet beside a solid.
TEST(Repair, TakesAFanOnOneEdgeForOneSheet) {
  TriangleMesh mesh = cube(kEdge);
  for (const Vec3& p :
       {Vec3(0.1, 0, 0), Vec3(0.1, 0, 0.03), Vec3(0.12, 0, 0), Vec3(0.09, 0.02, 0), Vec3(0.09, -0.02, 0)})
    mesh.vertices.push_back(p);
  for (const std::int32_t tip : {10, 11, 12}) mesh.triangles.push_back({8, 9, tip});
  const Repaired r = repaired(mesh);
  EXPECT_EQ(r.report.solids, 1U);
  EXPECT_EQ(r.found(FindingKind::kSheets), 1U);
  EXPECT_NEAR(r.report.finding(FindingKind::kSheets).area, 0.015 * (0.02 + 2.0 * std::sqrt(5e-4)), 1e-12);
}

// Tetrahedra around one edge, two triangles of each: up to 64 there are looked at one by one, more count as
// open, all of them.
TEST(Repair, TakesAnEdgeOfMoreThanSixtyFourTrianglesForOpen) {
  for (const int count : {32, 33}) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {0, 0, 0.05}};
    for (int i = 0; i < count; ++i) {
      for (const double share : {0.0, 0.5}) {
        const double angle = 2.0 * std::numbers::pi * (i + share) / count;
        mesh.vertices.emplace_back(0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.02);
      }
      const std::int32_t a = 2 + 2 * i;
      mesh.triangles.insert(mesh.triangles.end(), {{0, a, 1}, {0, 1, a + 1}, {1, a, a + 1}, {a, 0, a + 1}});
    }
    const Repaired r = repaired(mesh);
    EXPECT_EQ(r.report.solids, count == 32 ? 32U : 0U);
    EXPECT_EQ(r.report.sheets, count == 32 ? 0U : 1U);
  }
}

// Edges of three triangles each: one of 40 mm about the origin, one of 30 mm a metre away.
TEST(Repair, NamesTheLongestEdgeOfMoreThanTwoTrianglesWhereverItLies) {
  TriangleMesh mesh;
  for (const auto& [x, length] : {std::pair{0.0, 0.04}, {1.0, 0.03}}) {
    const auto first = static_cast<std::int32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{x, 0, -0.5 * length}, {x, 0, 0.5 * length}});
    for (const int corner : {2, 3, 4}) {
      const double angle = 2.0 * std::numbers::pi * corner / 3.0;
      mesh.vertices.emplace_back(x + 0.02 * std::cos(angle), 0.02 * std::sin(angle), 0.0);
      mesh.triangles.push_back({first, first + 1, first + corner});
    }
  }
  const Repaired r = repaired(mesh);
  const MeshFinding found = r.report.finding(FindingKind::kNonManifoldEdges);
  EXPECT_EQ(found.found, 2U);
  EXPECT_NEAR(found.size, 0.07, 1e-12);
  ASSERT_TRUE(found.at.has_value());
  EXPECT_LT(found.at->norm(), 1e-9);
}

// Two triangles meet one across their common long edge.
TEST(Repair, SplitsATJunction) {
  TriangleMesh strip;
  strip.vertices = {{0, 0, 0},       {0.02, 0, 0},     {0.04, 0, 0},
                    {0.02, 0.02, 0}, {0.01, -0.02, 0}, {0.03, -0.02, 0}};
  strip.triangles = {{0, 2, 3}, {0, 4, 1}, {1, 5, 2}};
  const Repaired r = repaired(strip);
  EXPECT_EQ(findings(r), "t_junctions 1/1, outlines 1/0, sheets 1/0");
  EXPECT_EQ(r.mesh.triangles.size(), 4U);
  EXPECT_EQ(r.report.sheets, 1U) << "three triangles became one surface";
}

// A needle stands on the long edge with two corners that are 0.05 um apart. They stay two, for nothing else
// covers it. At the first one the edge is split; the piece to the second would be shorter than 0.067 um,
// which is what a step may move a point.
TEST(Repair, SplitsAnEdgeIntoNoPieceShorterThanASixthOfTheTolerance) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0},    {0.04, 0, 0},           {0.02, 0.02, 0},
                   {0.01, 0, 0}, {0.01 + 0.05e-6, 0, 0}, {0.01, 0, 0.02}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  const Repaired r = repaired(mesh);
  EXPECT_EQ(r.repaired(FindingKind::kTJunctions), 1U);
  EXPECT_EQ(r.mesh.triangles.size(), 3U);
}

TEST(Repair, SplitsAllThreeEdgesOfATriangle) {
  // A tetrahedron of which one face is one triangle and the others are cut at the middles of its edges.
  const std::vector<Vec3> p = {{0, 0, 0}, {0.05, 0, 0}, {0, 0.05, 0}, {0, 0, 0.05}};
  TriangleMesh mesh;
  mesh.vertices = {p[0], p[1], p[2], p[3], 0.5 * (p[1] + p[2]), 0.5 * (p[2] + p[3]), 0.5 * (p[3] + p[1])};
  mesh.triangles = {{1, 2, 3}, {0, 2, 4}, {0, 4, 1}, {0, 3, 5}, {0, 5, 2}, {0, 1, 6}, {0, 6, 3}};
  const Repaired r = repaired(mesh);
  EXPECT_EQ(findings(r), "t_junctions 3/3");
  EXPECT_TRUE(r.report.closed);
  EXPECT_EQ(r.mesh.triangles.size(), 10U);
  EXPECT_NEAR(r.report.volume, 0.05 * 0.05 * 0.05 / 6, 1e-15);
}

// Two tetrahedra, the tip of one through the base of the other: three triangles cross the base, whose own
// edges stay clear of them.
TEST(Repair, CountsTrianglesThatCross) {
  TriangleMesh mesh;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const auto i = static_cast<std::int32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c, d});
    mesh.triangles.insert(mesh.triangles.end(),
                          {{i, i + 2, i + 1}, {i, i + 1, i + 3}, {i + 1, i + 2, i + 3}, {i + 2, i, i + 3}});
  };
  add({-0.05, -0.04, 0}, {0.05, -0.04, 0}, {0, 0.05, 0}, {0, 0, 0.06});
  add({-0.01, -0.01, -0.03}, {0, 0.012, -0.03}, {0.01, -0.01, -0.03}, {0, 0, 0.01});
  const Repaired r = repaired(mesh);
  EXPECT_EQ(r.found(FindingKind::kSelfIntersections), 3U);
  const MeshFinding crossing = r.report.finding(FindingKind::kSelfIntersections);
  // A quarter of the way from the tip at z = 0.01 to the base at -0.03: a quarter of its longest side.
  EXPECT_NEAR(crossing.size, std::hypot(0.01, 0.022) / 4, 1e-9);
  ASSERT_TRUE(crossing.at);
  EXPECT_NEAR(crossing.at->z(), 0.0, 1e-12);
  EXPECT_NEAR(std::abs(crossing.at->x()), 0.005 / 4, 1e-9);
  EXPECT_NEAR(crossing.at->y(), 0.001 / 4, 1e-9);
  EXPECT_EQ(r.report.solids, 2U) << "not one within the other";
  EXPECT_EQ(test::self_intersections(r.mesh), 3U);
}

TEST(Repair, AgreesWithBruteForceOnCrossings) {
  TriangleMesh mesh = make_sphere(0.05, 400);
  append(mesh, make_torus(0.05, 0.02, 500),
         Pose{rotation_about(Vec3(1, 2, 3).normalized(), 0.7), Vec3(0.011, 0.007, 0.003)});
  append(mesh, make_box({0.04, 0.03, 0.09}, 100),
         Pose{rotation_about(Vec3(3, 1, 2).normalized(), 0.4), Vec3(0.004, 0.009, 0.013)});
  const Repaired r = repaired(mesh);
  EXPECT_EQ(r.found(FindingKind::kSelfIntersections), test::self_intersections(r.mesh));
  EXPECT_GT(r.found(FindingKind::kSelfIntersections), 100U);
}

TEST(Repair, LeavesAMoebiusStripOneSided) {
  TriangleMesh strip;
  constexpr int kCuts = 12;
  for (int i = 0; i < kCuts; ++i) {
    const double u = 2 * std::numbers::pi * i / kCuts;
    for (const double w : {-0.01, 0.01})
      strip.vertices.emplace_back((0.04 + w * std::cos(u / 2)) * std::cos(u),
                                  (0.04 + w * std::cos(u / 2)) * std::sin(u), w * std::sin(u / 2));
  }
  for (int i = 0; i < kCuts; ++i) {
    const std::int32_t a = 2 * i;
    // At the seam the two rims change places.
    const std::int32_t c = i + 1 < kCuts ? a + 2 : 1;
    const std::int32_t d = i + 1 < kCuts ? a + 3 : 0;
    strip.triangles.push_back({a, c, a + 1});
    strip.triangles.push_back({a + 1, c, d});
  }
  const Repaired r = repaired(strip);
  EXPECT_EQ(findings(r), "outlines 1/0, sheets 1/0, non_orientable 1/0");
  EXPECT_TRUE(test::corner_positions(r.mesh) == test::corner_positions(strip)) << "left as it is";
}

TEST(Repair, SaysWhichUnitTheNumbersProbablyAre) {
  const Repaired r = repaired(cube(90));
  EXPECT_EQ(findings(r), "units 1/0, coarse_numbers 1/0");
  EXPECT_DOUBLE_EQ(r.report.finding(FindingKind::kUnits).size, 90);
  EXPECT_EQ(unit_advice(90, 1.0),
            "it is 90 m wide; probably its numbers are mm (90 mm): give unit \"mm\" with size_mm 0, or the "
            "size in mm");
  EXPECT_THAT(unit_advice(0.0012, 0.001), HasSubstr("in (30.48 mm)"));
  EXPECT_EQ(unit_advice(0.09, 1.0), "");
  EXPECT_EQ(findings(repaired(cube(90), {.unit = 1e-3})), "");
  EXPECT_EQ(findings(repaired(cube(90), {.size = 0.1})), "");
}

TEST(Repair, RefusesNumbersTooLargeForSinglePrecision) {
  // 90 mm at 10 km: a float's step there is 2^-23 x 10 km = 1.2 mm.
  EXPECT_THAT(repair_refusal(cube(0.09, Vec3(9000, 0, 0))),
              AllOf(HasSubstr("test: "), HasSubstr("1.07"), HasSubstr("mm")));
  EXPECT_THAT(repair_refusal(cube(0.09, Vec3(9000, 0, 0)), {.size = 0.09}), HasSubstr("origin"));
  const Repaired r = repaired(cube(0.09, Vec3(100, 0, 0)));
  EXPECT_NEAR(r.report.finding(FindingKind::kCoarseNumbers).size, 100.09 * std::pow(2.0, -23), 1e-9);
  // The contact margin is 50 um: 400.09 m x 2^-23 = 47.7 um, 430.09 m x 2^-23 = 51.3 um.
  EXPECT_EQ(repair_refusal(cube(0.09, Vec3(400, 0, 0))), "accepted");
  EXPECT_THAT(repair_refusal(cube(0.09, Vec3(430, 0, 0))),
              AllOf(HasSubstr("single precision"), HasSubstr("contact margin of 0.05 mm")));
  // At the bound, on both sides: 419.48 m x 2^-23 = 50.006 um, 419.39 m x 2^-23 = 49.995 um.
  EXPECT_THAT(repair_refusal(cube(0.09, Vec3(-419.48, 0, 0))), HasSubstr("single precision"));
  EXPECT_EQ(repair_refusal(cube(0.09, Vec3(-419.39, 0, 0))), "accepted");
}

// 0.1 m of 1e-310 units would be 1e309 m a unit, which no double holds.
TEST(Repair, RefusesASizeToWhichItCannotBeScaled) {
  EXPECT_THAT(repair_refusal(cube(1e-310), {.size = 0.1}), HasSubstr("cannot be scaled"));
}

TEST(Repair, RefusesWhatIsFartherThanTenKilometres) {
  EXPECT_THAT(repair_refusal(cube(20'000)), HasSubstr("10 km"));
  EXPECT_THAT(repair_refusal(cube(20'000)), HasSubstr("in mm"));
  EXPECT_EQ(repair_refusal(cube(20'000), {.size = 0.1}), "accepted");
  EXPECT_THAT(repair_refusal(cube(20e6), {.unit = 1e-3}), HasSubstr("it is 2e+04 m wide"));
  EXPECT_THAT(repair_refusal(cube(20e6), {.unit = 1e-3}), HasSubstr("it reaches 2e+04 m far"));
}

TEST(Repair, RefusesTrianglesWithoutAnyArea) {
  TriangleMesh line;
  for (const double x : {0.0, 0.01, 0.05}) line.vertices.emplace_back(x, 0, 0);
  line.triangles = {{0, 1, 2}};
  EXPECT_THAT(repair_refusal(line), HasSubstr("area"));
}

// From 0.1 mm on in mm, from 1 m on in m.
TEST(FindingWords, SayAWidthInItsUnit) {
  for (const auto& [width, words] :
       {std::pair{10e-6, "10 um"}, {99e-6, "99 um"}, {1e-4, "0.1 mm"}, {2.5e-3, "2.5 mm"}, {1.0, "1 m"}}) {
    for (const FindingKind kind : {FindingKind::kSlits, FindingKind::kHoles}) {
      EXPECT_THAT(finding_meaning({.kind = kind, .found = 1, .size = 0.05, .width = width}),
                  HasSubstr(std::string("the widest is ") + words));
    }
  }
}

TEST(FindingWords, TellWhatWasRepairedFromWhatRemains) {
  const auto flat = [](std::size_t repaired) {
    return finding_meaning({.kind = FindingKind::kDegenerateFaces, .found = 3, .repaired = repaired});
  };
  EXPECT_THAT(flat(3), HasSubstr("covered by its neighbours"));
  EXPECT_THAT(flat(3), ::testing::Not(HasSubstr("thin lines")));
  EXPECT_THAT(flat(0), HasSubstr("thin lines"));
  EXPECT_THAT(flat(0), ::testing::Not(HasSubstr("covered by its neighbours")));
  EXPECT_THAT(flat(1), HasSubstr("covered by its neighbours; those that remain: met as thin lines"));
  EXPECT_THAT(finding_meaning({.kind = FindingKind::kUnits, .found = 1, .size = 2e-3}),
              HasSubstr("too small"));
  EXPECT_THAT(finding_meaning({.kind = FindingKind::kUnits, .found = 1, .size = 90.0}),
              HasSubstr("too large"));
}

TEST(FindingWords, AreThereForEveryKind) {
  for (std::size_t k = 0; k < kFindingKinds; ++k) {
    const auto kind = static_cast<FindingKind>(k);
    EXPECT_NE(std::string(finding_name(kind)), "");
    EXPECT_TRUE(!finding_meaning({kind, 1, 0, 5.0, 0.1}).empty() ||
                !finding_meaning({kind, 1, 1, 5.0, 0.1}).empty());
  }
}

// A bar of 100 x 50 x 50 mm has 2 x (100 x 50 + 50 x 50 + 50 x 100) mm^2 = 25,000 mm^2. Its first triangle is
// {0, 2, 1}: (0, 0, 0), (0, 50, 0), (100, 0, 0) mm.
TEST(Repair, MeasuresABarInsideOutAlongItsLength) {
  TriangleMesh bar = turned(cube(kEdge));
  for (Vec3& v : bar.vertices) v.x() *= 2.0;
  const Repaired r = repaired(bar);
  EXPECT_EQ(findings(r), "inside_out 1/1");
  const MeshFinding wrong = r.report.finding(FindingKind::kInsideOut);
  EXPECT_NEAR(wrong.size, 2 * kEdge, 1e-12);
  EXPECT_NEAR(wrong.area, 0.025, 1e-14);
  ASSERT_TRUE(wrong.at);
  EXPECT_LT((*wrong.at - Vec3(0.1 / 3, 0.05 / 3, 0)).norm(), 1e-12);
}

// The hollow's first triangle has its middle in (7, 4, 4) mm, and the outer wall, 400 x 100 x 100 mm about
// the origin, has edges along x in y = z. Rays that all ran in the plane y = z would all graze these.
TEST(Repair, KnowsAHollowInThePlaneOfTheOuterWallsEdges) {
  TriangleMesh mesh = cube(0.1, Vec3::Constant(-0.05));
  for (Vec3& v : mesh.vertices) v.x() *= 4.0;
  append(mesh, cube(0.012, Vec3(0.003, 0, 0.004)));
  const Repaired r = repaired(mesh);
  EXPECT_EQ(r.report.solids, 1U);
  EXPECT_EQ(r.report.cavities, 1U);
}

// Beside a hollow cube a loose triangle, which stands between the two walls in the file.
TEST(Repair, KnowsAHollowWhateverStandsBeforeItInTheFile) {
  TriangleMesh mesh = cube(0.05);
  append(mesh, TriangleMesh{{{0.2, 0, 0}, {0.22, 0, 0}, {0.2, 0.02, 0}}, {{0, 1, 2}}});
  append(mesh, cube(0.02, Vec3::Constant(0.015)));
  const Repaired r = repaired(mesh);
  EXPECT_EQ(r.report.solids, 1U);
  EXPECT_EQ(r.report.cavities, 1U);
  EXPECT_EQ(r.report.sheets, 1U);
}

// In mm. Between two plates, 2 mm apart, lies a strip of 0.4 mm that is 1 mm from the one and 0.6 mm from the
// other: two slits, of two edges of 10 mm each. The plates' edges face each other, too, farther away.
TEST(Repair, MeasuresASlitToTheNearestEdge) {
  TriangleMesh mesh;
  for (const auto& [low, high] : {std::pair{-30.0, 0.0}, {1.0, 1.4}, {2.0, 32.0}}) {
    const auto v = static_cast<std::int32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{0, low, 0}, {10, low, 0}, {10, high, 0}, {0, high, 0}});
    mesh.triangles.insert(mesh.triangles.end(), {{v, v + 1, v + 2}, {v, v + 2, v + 3}});
  }
  const MeshFinding slits = repaired(mesh, {.unit = 1e-3}).report.finding(FindingKind::kSlits);
  EXPECT_EQ(slits.found, 2U);
  EXPECT_NEAR(slits.width, 1e-3, 1e-12);
  EXPECT_NEAR(slits.size, 20e-3, 1e-12);
}

// A square bucket of 40 mm whose rim's corners are at 0 and 30 mm in turn: four edges of 50 mm. Seen from
// above, along the rim's area vector, the opening is 40 mm wide. Its middle is that of the edges.
TEST(Repair, MeasuresAHoleWhoseRimIsNotFlatAcrossItsArea) {
  constexpr double kSide = 0.04;
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, -0.05}, {kSide, 0, -0.05}, {kSide, kSide, -0.05}, {0, kSide, -0.05},
                   {0, 0, 0},     {kSide, 0, 0.03},  {kSide, kSide, 0},     {0, kSide, 0.03}};
  for (const std::int32_t i : {0, 1, 2, 3}) {
    const std::int32_t j = (i + 1) % 4;
    mesh.triangles.insert(mesh.triangles.end(), {{i, j, 4 + j}, {i, 4 + j, 4 + i}});
  }
  mesh.triangles.insert(mesh.triangles.end(), {{0, 2, 1}, {0, 3, 2}});
  const Repaired r = repaired(mesh);
  EXPECT_EQ(findings(r), "holes 1/0, sheets 1/0");
  const MeshFinding hole = r.report.finding(FindingKind::kHoles);
  EXPECT_NEAR(hole.width, kSide, 1e-12);
  EXPECT_NEAR(hole.size, 0.2, 1e-12);
  ASSERT_TRUE(hole.at);
  EXPECT_LT((*hole.at - Vec3(0.02, 0.02, 0.015)).norm(), 1e-12);
}

// A cone with as many sides as triangles meet at its tip, vertex 0. The last vertex is 2 nm from the tip on
// the edge to vertex 2, so that two of the sides end in needles. Where up to 256 triangles meet these go;
// where more do they are left, and the report says so.
TEST(Repair, SaysThatFlatTrianglesWereLeftWhereVeryManyMeet) {
  for (const std::int32_t sides : {256, 257}) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0.04}, {0, 0, 0}};
    for (std::int32_t i = 0; i < sides; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / sides;
      mesh.vertices.emplace_back(0.03 * std::cos(angle), 0.03 * std::sin(angle), 0.0);
    }
    const std::int32_t last = 1 + sides;  // of the rim
    const std::int32_t near = 2 + sides;
    mesh.vertices.push_back(mesh.vertices[0] + 2e-9 * (mesh.vertices[2] - mesh.vertices[0]).normalized());
    for (std::int32_t i = 0; i < sides; ++i) {
      const std::int32_t a = 2 + i;
      const std::int32_t b = 2 + (i + 1) % sides;
      mesh.triangles.push_back({a, b, i == 0 || a == last ? near : 0});
      mesh.triangles.push_back({1, b, a});
    }
    mesh.triangles.push_back({near, 3, 0});
    mesh.triangles.push_back({last, near, 0});
    ASSERT_TRUE(is_closed(mesh));
    const Repaired r = repaired(mesh);
    EXPECT_EQ(r.found(FindingKind::kDegenerateFaces), 2U) << sides;
    EXPECT_EQ(r.repaired(FindingKind::kDegenerateFaces), sides == 256 ? 2U : 0U);
    EXPECT_EQ(r.report.complete, sides == 256);
    EXPECT_TRUE(r.report.closed);
  }
}

// Eight triangles on a grid of 10 mm that a fuzzer found; the fourth number moves a corner by steps of 0.2 um
// along x. Their extent of 70 mm gives a tolerance of 0.7 um, a step moves at most a sixth of it, and here
// the steps follow one another: six of the widest would come to the tolerance.
TEST(Repair, HoldsBackAStepThatWouldMoveTheSurfaceFartherThanTheTolerance) {
  constexpr int kHeap[8][3][4] = {
      {{0, 4, 0, 4}, {2, 1, 0, 0}, {2, 6, 5, 7}}, {{5, 4, 1, 1}, {4, 6, 5, 4}, {0, 4, 0, 3}},
      {{4, 5, 5, 7}, {1, 4, 1, 2}, {0, 4, 0, 5}}, {{6, 4, 5, 0}, {3, 4, 5, 2}, {0, 4, 0, 1}},
      {{4, 7, 5, 4}, {0, 4, 0, 6}, {1, 5, 5, 1}}, {{2, 1, 4, 2}, {6, 5, 1, 2}, {7, 3, 1, 4}},
      {{0, 4, 0, 2}, {0, 4, 0, 7}, {0, 6, 4, 2}}, {{0, 6, 4, 3}, {0, 4, 0, 0}, {6, 5, 4, 0}}};
  TriangleMesh soup;
  for (const auto& triangle : kHeap) {
    const auto first = static_cast<std::int32_t>(soup.vertices.size());
    for (const auto& [x, y, z, moved] : triangle)
      soup.vertices.emplace_back(0.01 * x + 0.2e-6 * moved, 0.01 * y, 0.01 * z);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  const Repaired once = repaired(soup);
  EXPECT_NEAR(once.report.tolerance, 0.7e-6, 1e-11);
  EXPECT_TRUE(once.report.held_back);
  EXPECT_GT(once.report.moved, once.report.tolerance * 5 / 6) << "another step would be too far";
  EXPECT_LE(once.report.moved, once.report.tolerance);
  // What it leaves is found by a second repair, which has moved nothing yet.
  const Repaired twice = repaired(once.mesh);
  EXPECT_EQ(twice.repaired(FindingKind::kTJunctions), 1U);
  EXPECT_FALSE(twice.report.held_back);
  EXPECT_EQ(repaired(twice.mesh).repaired(FindingKind::kTJunctions), 0U);
}

// 500 x 200 squares of 0.1 mm are 200,000 triangles; a loose one more is too many. (Two repairs of so many
// triangles, a second or two: release only, if the sanitizer's level is to stay quick.)
TEST(Repair, CallsMoreThanTwoHundredThousandTrianglesMany) {
  constexpr std::int32_t kAlong = 500;
  constexpr std::int32_t kAcross = 200;
  TriangleMesh sheet;
  for (std::int32_t j = 0; j <= kAcross; ++j)
    for (std::int32_t i = 0; i <= kAlong; ++i) sheet.vertices.emplace_back(1e-4 * i, 1e-4 * j, 0.0);
  for (std::int32_t j = 0; j < kAcross; ++j) {
    for (std::int32_t i = 0; i < kAlong; ++i) {
      const std::int32_t a = j * (kAlong + 1) + i;
      const std::int32_t b = a + kAlong + 1;
      sheet.triangles.insert(sheet.triangles.end(), {{a, a + 1, b + 1}, {a, b + 1, b}});
    }
  }
  ASSERT_EQ(sheet.triangles.size(), 200'000U);
  EXPECT_EQ(repaired(sheet).found(FindingKind::kManyTriangles), 0U);
  append(sheet, TriangleMesh{{{0.1, 0, 0}, {0.11, 0, 0}, {0.1, 0.01, 0}}, {{0, 1, 2}}});
  EXPECT_EQ(repaired(sheet).found(FindingKind::kManyTriangles), 200'001U);
}

}  // namespace
}  // namespace phalanx::mesh
