// SPDX-License-Identifier: Apache-2.0
// Seeded damage to closed meshes is undone, and a second repair finds nothing to do.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>

#include "mesh/mesh_checks.h"
#include "mesh/repair/repair.h"
#include "phalanx/mesh/primitives.h"
#include "support/sanitized.h"

namespace phalanx::mesh {
namespace {

struct Case {
  std::string name;
  TriangleMesh mesh;
};

Case teapot_case() { return {"Teapot", make_teapot(0.15, 2000)}; }
Case mug_case() { return {"Mug", make_mug(0.08, 0.1, 1500)}; }
Case torus_case() { return {"Torus", make_torus(0.08, 0.02, 1200)}; }

/// A shuffled soup: two fifths of the triangles turned, corners apart, some twice, some without area,
/// vertices that nobody uses, and positions off by at most `noise` [m].
TriangleMesh damage(const TriangleMesh& mesh, double noise, std::mt19937& random) {
  std::vector<std::size_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  TriangleMesh soup;
  const auto somewhere = [&] { return noise * (static_cast<double>(random() % 2001) / 1000.0 - 1.0); };
  const auto put = [&](Triangle t, bool turn) {
    if (turn) std::swap(t[1], t[2]);
    const auto first = static_cast<std::int32_t>(soup.vertices.size());
    for (const std::int32_t v : t)
      soup.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)] +
                              Vec3(somewhere(), somewhere(), somewhere()));
    soup.triangles.push_back({first, first + 1, first + 2});
  };
  for (const std::size_t t : order) {
    put(mesh.triangles[t], random() % 5 < 2);
    if (random() % 20 == 0) put(mesh.triangles[t], random() % 2 == 0);
    if (random() % 20 == 0) put({mesh.triangles[t][0], mesh.triangles[t][0], mesh.triangles[t][1]}, false);
    if (random() % 20 == 0) soup.vertices.emplace_back(0, 0, 0);
  }
  return soup;
}

constexpr unsigned kSeeds = test::kSlowBuild ? 3 : 10;

class DamagedMesh : public ::testing::TestWithParam<Case (*)()> {};

TEST_P(DamagedMesh, IsRepairedBackToTheSameClosedSolid) {
  const TriangleMesh made = GetParam()().mesh;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    MeshReport report;
    const TriangleMesh mesh = repair(damage(made, 0.0, random), {}, "test", report);
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_EQ(mesh.vertices.size(), made.vertices.size());
    EXPECT_EQ(mesh.triangles.size(), made.triangles.size());
    EXPECT_NEAR(signed_volume(mesh), signed_volume(made), 1e-12 * signed_volume(made));
    EXPECT_GT(report.finding(FindingKind::kInconsistentWinding).repaired, made.triangles.size() / 4);
    EXPECT_GT(report.finding(FindingKind::kDuplicateFaces).repaired, 0U);
    EXPECT_GT(report.finding(FindingKind::kDegenerateFaces).repaired, 0U);
    EXPECT_GT(report.finding(FindingKind::kUnreferencedVertices).repaired, 0U);
  }
}

TEST_P(DamagedMesh, IsClosedAgainWhenEveryCornerIsALittleOff) {
  const TriangleMesh made = GetParam()().mesh;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    MeshReport report;
    const TriangleMesh mesh = repair(damage(made, 0.05e-6, random), {}, "test", report);
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_NEAR(signed_volume(mesh), signed_volume(made), 1e-5 * signed_volume(made));
    EXPECT_GT(report.finding(FindingKind::kNearVertices).repaired, made.vertices.size());
    EXPECT_LE(report.moved, 0.2e-6);
  }
}

TEST_P(DamagedMesh, NeedsNoSecondRepair) {
  const TriangleMesh made = GetParam()().mesh;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    TriangleMesh soup = damage(made, seed % 2 == 0 ? 0.0 : 0.3e-6, random);
    if (seed % 3 == 0) soup.triangles.resize(soup.triangles.size() * 9 / 10);  // with holes
    MeshReport first;
    const TriangleMesh once = repair(soup, {}, "test", first);
    EXPECT_FALSE(first.held_back);
    MeshReport second;
    const TriangleMesh twice = repair(once, {}, "test", second);
    for (const MeshFinding& f : second.findings) EXPECT_EQ(f.repaired, 0U) << finding_name(f.kind);
    EXPECT_TRUE(test::corner_positions(once) == test::corner_positions(twice));
  }
}

TEST_P(DamagedMesh, IsRepairedTheSameEveryTime) {
  const TriangleMesh made = GetParam()().mesh;
  std::mt19937 random(7);
  const TriangleMesh soup = damage(made, 0.3e-6, random);
  MeshReport report;
  const TriangleMesh a = repair(soup, {.size = 0.1}, "test", report);
  const TriangleMesh b = repair(soup, {.size = 0.1}, "test", report);
  EXPECT_TRUE(a.vertices == b.vertices);
  EXPECT_TRUE(a.triangles == b.triangles);
}

INSTANTIATE_TEST_SUITE_P(Closed, DamagedMesh, ::testing::Values(teapot_case, mug_case, torus_case),
                         [](const auto& each) { return each.param().name; });

}  // namespace
}  // namespace phalanx::mesh
