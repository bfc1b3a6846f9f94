// SPDX-License-Identifier: Apache-2.0
// Meshes made to break the repair: solids that touch, heaps that take for ever, faces that can be flipped
// back and forth, and steps that add up.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "mesh/import/deviation.h"
#include "mesh/mesh_checks.h"
#include "mesh/repair/box_tree.h"
#include "mesh/repair/edge_table.h"
#include "mesh/repair/patches.h"
#include "mesh/repair/repair.h"
#include "mesh/repair/shells.h"
#include "mesh/repair/t_junctions.h"
#include "mesh/repair/weld.h"
#include "phalanx/mesh/corner_normals.h"
#include "support/sanitized.h"

namespace phalanx::mesh {
namespace {

struct AttackRepaired {
  TriangleMesh mesh;
  MeshReport report;
};

AttackRepaired attacked(const TriangleMesh& soup) {
  AttackRepaired r;
  r.mesh = repair(soup, {}, "test", r.report);
  return r;
}

void expect_no_second_repair(const TriangleMesh& once) {
  const AttackRepaired r = attacked(once);
  for (const MeshFinding& f : r.report.findings) EXPECT_EQ(f.repaired, 0U) << finding_name(f.kind);
  EXPECT_TRUE(test::corner_positions(once) == test::corner_positions(r.mesh));
}

void add_to(TriangleMesh& mesh, const TriangleMesh& more) {
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const Triangle& t : more.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

TriangleMesh block(const Vec3& size, const Vec3& centre) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(centre +
                            size.cwiseProduct(Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1) - Vec3::Constant(0.5)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TriangleMesh turned_round(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

// On a table top, apart, exactly on it, and less than the tolerance into it.
TEST(RepairAttack, PartsThatStandOnAnotherStaySolids) {
  for (const double into : {-1e-7, 0.0, 0.5e-6}) {
    SCOPED_TRACE(::testing::Message() << "into " << into << " m");
    TriangleMesh mesh = block({0.2, 0.2, 0.02}, {0, 0, -0.01});
    for (const double x : {-0.06, 0.0, 0.055})
      add_to(mesh, block({0.02, 0.03, 0.04}, {x, 0.3 * x + 0.01, 0.02 - into}));
    const AttackRepaired r = attacked(mesh);
    EXPECT_EQ(r.report.solids, 4U);
    EXPECT_EQ(r.report.cavities, 0U);
    EXPECT_EQ(r.report.finding(FindingKind::kInsideOut).found, 0U);
    EXPECT_NEAR(r.report.volume, 8e-4 + 3 * 2.4e-5, 1e-12);
  }
}

// Whichever of a block's sides touches, whichever is first in the file, and whichever is inside out.
TEST(RepairAttack, ABlockOnAnySideOfAnotherIsTurnedAsIfAlone) {
  for (int side = 0; side < 6; ++side) {
    for (int kind = 0; kind < 4; ++kind) {
      SCOPED_TRACE(::testing::Message() << "side " << side << " kind " << kind);
      Vec3 centre(0.013, 0.017, 0.011);
      centre[side / 2] = side % 2 == 0 ? 0.06 : -0.06;
      const TriangleMesh small = block(Vec3::Constant(0.02), centre);
      const TriangleMesh big = block(Vec3::Constant(0.1), Vec3::Zero());
      TriangleMesh mesh = kind % 2 == 0 ? big : small;
      add_to(mesh, kind % 2 == 0 ? small : big);
      const AttackRepaired r = attacked(kind < 2 ? mesh : turned_round(mesh));
      EXPECT_EQ(r.report.solids, 2U);
      EXPECT_EQ(r.report.finding(FindingKind::kInsideOut).repaired, kind < 2 ? 0U : 2U);
      EXPECT_NEAR(r.report.volume, 1e-3 + 8e-6, 1e-12);
    }
  }
}

// One wall of the hollow touches the outer wall: it is inside all the same.
TEST(RepairAttack, AHollowThatTouchesItsOuterWallStaysAHollow) {
  TriangleMesh mesh = block(Vec3::Constant(0.1), Vec3::Zero());
  add_to(mesh, block(Vec3::Constant(0.02), {0.04, 0.003, 0.005}));
  const AttackRepaired r = attacked(mesh);
  EXPECT_EQ(r.report.solids, 1U);
  EXPECT_EQ(r.report.cavities, 1U);
  EXPECT_NEAR(r.report.volume, 1e-3 - 8e-6, 1e-12);
}

TriangleMesh nested(int count) {
  TriangleMesh mesh;
  for (int i = 1; i <= count; ++i) {
    const double s = 0.05 * i / count;
    const auto v = static_cast<std::int32_t>(mesh.vertices.size());
    for (const Vec3& p : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)})
      mesh.vertices.push_back(s * p);
    for (const Triangle& t : {Triangle{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}})
      mesh.triangles.push_back({t[0] + v, t[1] + v, t[2] + v});
  }
  return mesh;
}

TEST(RepairAttack, NestedShellsAreSolidAndHollowInTurn) {
  const AttackRepaired r = attacked(nested(101));
  EXPECT_EQ(r.report.solids, 51U);
  EXPECT_EQ(r.report.cavities, 50U);
  EXPECT_TRUE(r.report.complete);
}

// Work that grows with the square of their number stops, and the report says so. In the file all shells wind
// like solids, and those that are not reached stay so. 2,000 shells are all judged, of 3,000 less than half.
TEST(RepairAttack, TooManyNestedShellsAreSaidToBe) {
  if (!test::kSlowBuild) {
    EXPECT_EQ(attacked(nested(2000)).report.cavities, 1000U);
  }
  const AttackRepaired r = attacked(nested(3000));
  EXPECT_EQ(r.report.solids + r.report.cavities, 3000U);
  EXPECT_GT(r.report.solids, 2 * r.report.cavities);
}

// All boxes overlap, so that all pairs of triangles are looked at for intersections: up to 3,000,000 and 20
// for each triangle. 2,460 triangles are 3,024,570 pairs of 3,049,200 that are allowed, 2,480 are 3,073,960
// of 3,049,600.
TEST(RepairAttack, PairsAreLookedAtUpToALimitThatGrowsWithTheTriangles) {
  EXPECT_TRUE(attacked(nested(615)).report.complete);
  EXPECT_FALSE(attacked(nested(620)).report.complete);
}

/// A convex polygon cut into a fan from its first corner.
TriangleMesh disc(int corners) {
  TriangleMesh mesh;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    mesh.vertices.emplace_back(0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.0);
  }
  for (int i = 1; i + 1 < corners; ++i) mesh.triangles.push_back({0, i, i + 1});
  return mesh;
}

TEST(RepairAttack, FlipsAreNotUndoneByFlips) {
  const TriangleMesh fan = disc(8000);
  const AttackRepaired r = attacked(fan);
  EXPECT_LE(r.report.finding(FindingKind::kDegenerateFaces).found, fan.triangles.size());
  EXPECT_LE(r.report.moved, r.report.tolerance);
  expect_no_second_repair(r.mesh);
}

// Flat triangles around one vertex: every one of them would gather all the others.
TEST(RepairAttack, AHubOfFlatTrianglesComesToAnEnd) {
  TriangleMesh mesh;
  constexpr int kCount = 20000;
  mesh.vertices.emplace_back(0, 0, 0);
  for (int i = 0; i < kCount; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCount;
    mesh.vertices.emplace_back(1e-8 * std::cos(angle), 1e-8 * std::sin(angle), 0.0);
  }
  for (int i = 0; i < kCount; ++i) mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % kCount});
  add_to(mesh, block(Vec3::Constant(0.1), {0.2, 0, 0}));
  const AttackRepaired r = attacked(mesh);
  EXPECT_LE(r.report.finding(FindingKind::kDegenerateFaces).found, mesh.triangles.size());
  EXPECT_EQ(r.report.solids, 1U);
}

// A strip of triangles too low to have a normal, longer than any that a scan of all edges for each of them
// would get through; the one at its end has one.
TEST(RepairAttack, ANormalSpreadsThroughALongStrip) {
  constexpr int kCount = 100000;
  TriangleMesh mesh;
  for (int i = 0; i < kCount + 2; ++i) mesh.vertices.emplace_back(2e-5 * i, i % 2 == 0 ? 0.0 : 1e-12, 0.0);
  for (int i = 0; i < kCount; ++i)
    mesh.triangles.push_back(i % 2 == 0 ? Triangle{i, i + 2, i + 1} : Triangle{i, i + 1, i + 2});
  mesh.vertices.emplace_back(0, -0.3, 0);
  mesh.triangles.push_back({0, kCount + 2, 2});
  for (const auto& corners : corner_normals(mesh, 0.5))
    for (const Vec3& n : corners) ASSERT_EQ(n, Vec3(0, 0, 1));
}

/// A block whose triangles are apart, cut and folded, every corner off by 1 nm to 1 um.
TriangleMesh rattled(std::mt19937_64& random) {
  const auto real = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const auto off = [&] {
    const double most = std::pow(10.0, -9.0 + 0.9 * static_cast<double>(random() % 4));
    const double x = real();
    const double y = real();
    return Vec3(most * (2 * x - 1), most * (2 * y - 1), most * (2 * real() - 1));
  };
  TriangleMesh mesh;
  for (int cut = 0; cut < 8; ++cut) {
    const TriangleMesh whole = block({0.05, 0.04, 0.03}, Vec3::Zero());
    for (const Triangle& t : whole.triangles) {
      const auto k = static_cast<std::size_t>(random() % 3);
      const auto at = [&](std::size_t i) { return whole.vertices[static_cast<std::size_t>(t[(k + i) % 3])]; };
      const auto o = static_cast<std::int32_t>(mesh.vertices.size());
      const double s = real();
      for (const Vec3& p : {at(0), at(1), at(2), Vec3(at(0) + s * (at(1) - at(0)))})
        mesh.vertices.push_back(p + off());
      const auto kind = random() % 3;
      if (kind == 0) mesh.triangles.push_back({o, o + 1, o + 2});
      if (kind == 1) mesh.triangles.insert(mesh.triangles.end(), {{o, o + 3, o + 2}, {o + 3, o + 1, o + 2}});
      if (kind == 2) mesh.triangles.insert(mesh.triangles.end(), {{o, o + 1, o + 2}, {o, o + 3, o + 1}});
    }
  }
  return mesh;
}

TEST(RepairAttack, AllStepsTogetherStayWithinTheTolerance) {
  for (unsigned seed = 1; seed <= (test::kSlowBuild ? 6 : 60); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    const TriangleMesh soup = rattled(random);
    const AttackRepaired r = attacked(soup);
    EXPECT_GT(r.report.moved, 0.0);
    EXPECT_LE(r.report.moved, r.report.tolerance);
    const SurfaceDeviation off = measure_deviation(weld(soup), r.mesh);
    EXPECT_LE(off.outward, r.report.moved * (1.0 + 1e-6) + 1e-15);
    EXPECT_LE(off.inward, r.report.moved * (1.0 + 1e-6) + 1e-15);
    expect_no_second_repair(r.mesh);
  }
}

// As above; here each shell winds as it should, every other one from the outermost, the last, as a hollow's
// wall. Nothing is turned, and it is said nevertheless that not all were looked at.
TEST(RepairAttack, TooManyNestedShellsAreSaidToBeWhereNoneIsTurned) {
  constexpr int kCount = 3000;
  TriangleMesh mesh = nested(kCount);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if ((kCount - 1 - static_cast<int>(t / 4)) % 2 == 1)
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  const EdgeTable edges(mesh);
  const Patches patches = orient_patches(mesh, edges);
  Shells shells = find_shells(mesh, edges, patches);
  ASSERT_EQ(shells.shell.size(), 3000U);
  const TurnedShells turned = turn_shells_outward(mesh, shells, triangle_boxes(mesh), {}, 1e-6);
  EXPECT_EQ(turned.count, 0U);
  EXPECT_FALSE(turned.complete);
}

// 300 long triangles, whose first and third edge have boxes that hold all of the small ones: 3 x 600 pairs of
// a vertex and an edge for each of these. Of 10,000 that is 18 million, of 12,000 21.6 million, and about
// 0.15 million more; up to 20 million are looked at. No vertex lies on an edge.
TEST(RepairAttack, TJunctionsAreLookedForUpToALimit) {
  for (const int count : {10'000, 12'000}) {
    TriangleMesh mesh;
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      const auto v = static_cast<std::int32_t>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
      mesh.triangles.push_back({v, v + 1, v + 2});
    };
    for (int i = 0; i < 300; ++i) {
      const Vec3 aside(0, 0.001 * i, -0.001 * i);
      add(Vec3(-1, -1, -1) - aside, Vec3(1, 1, 1) + aside, Vec3(1, 0.7, 1) + aside);
    }
    for (int i = 0; i < count; ++i) {
      const Vec3 at(0.1 + 0.003 * (i % 110), -0.1 - 0.003 * (i / 110), 0);
      add(at, at + Vec3(0.001, 0, 0), at + Vec3(0, 0.001, 0.0005));
    }
    Allowance allowance{1e-7, 1e-6, std::vector<double>(mesh.vertices.size(), 0.0)};
    const Mended mended = split_t_junctions(mesh, allowance);
    EXPECT_EQ(mended.count, 0U);
    EXPECT_EQ(mended.complete, count == 10'000);
  }
}

}  // namespace
}  // namespace phalanx::mesh
