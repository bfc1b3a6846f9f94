// SPDX-License-Identifier: Apache-2.0
#include "mesh/import/decimate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "mesh/import/deviation.h"
#include "mesh/import/mesh_files.h"
#include "mesh/mesh_checks.h"
#include "phalanx/mesh/import.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx::mesh {
namespace {

using ::testing::HasSubstr;

// A cube against itself moved by 1 mm along x: by hand, every point is at most 1 mm off, the outer face's
// exactly.
TEST(Deviation, OfAMovedCubeIsHowFarItMoved) {
  const TriangleMesh cube = make_box({0.05, 0.05, 0.05}, 200);
  TriangleMesh moved = cube;
  for (Vec3& v : moved.vertices) v.x() += 1e-3;
  const SurfaceDeviation d = measure_deviation(cube, moved);
  EXPECT_NEAR(d.outward, 1e-3, 1e-15);
  EXPECT_NEAR(d.inward, 1e-3, 1e-15);
  const SurfaceDeviation none = measure_deviation(cube, cube);
  EXPECT_LT(std::max(none.outward, none.inward), 1e-16);
}

// A sphere of N triangles is flatter than one of many by the sagitta of its edges; an inscribed one lies
// inside.
TEST(Deviation, SeesWhatOneSideHasAndTheOtherLacks) {
  const TriangleMesh cube = make_box({0.05, 0.05, 0.05}, 12);
  TriangleMesh with_spike = cube;
  append(with_spike, make_box({0.001, 0.001, 0.001}, 12), Pose{Mat3::Identity(), Vec3(0.1, 0, 0)});
  const SurfaceDeviation d = measure_deviation(cube, with_spike);
  EXPECT_LT(d.outward, 1e-15) << "all of the cube is in the other";
  EXPECT_NEAR(d.inward, 0.1 + 0.0005 - 0.025, 1e-12) << "but not the reverse";
}

// A box of 8 vertices, 12 triangles and 18 edges has 8 + 12 + 18 = 38 probes.
TEST(Deviation, ProbesVerticesCentresAndTheMiddleOfEachEdgeOnce) {
  const TriangleMesh box = make_box({0.05, 0.05, 0.05}, 12);
  EXPECT_EQ(measure_deviation(box, box).probes, 76U);
}

// In mm: one triangle, and the same outline with a dent down to (2, 2, -1). The triangle's centre (2, 2, 0)
// is sqrt(2/3) from the dent's third side, x + y - 2 z = 6, and farther from the other two, y + 2 z = 0 and
// x + 2 z = 0. 4 + 3 + 6 probes of the dent, 3 + 1 + 3 of the triangle.
TEST(Deviation, OfADentUnderATrianglesCentre) {
  const TriangleMesh dent{{{0, 0, 0}, {6e-3, 0, 0}, {0, 6e-3, 0}, {2e-3, 2e-3, -1e-3}},
                          {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  const TriangleMesh flat{{dent.vertices[0], dent.vertices[1], dent.vertices[2]}, {{0, 1, 2}}};
  const SurfaceDeviation d = measure_deviation(dent, flat);
  EXPECT_NEAR(d.inward, std::sqrt(2.0 / 3.0) * 1e-3, 1e-12);
  EXPECT_NEAR(d.outward, 1e-3, 1e-12);
  EXPECT_EQ(d.probes, 20U);
}

// In mm: a triangle over (-1, 0, 0), (1, 0, 0), (0, 1, 0), and the same with the middle of its first edge
// pulled down to (0, 0, -1). That middle is 1/sqrt(3) from both halves, +-x + y - z = 1; the centre is
// nearer, by a third. Whichever of the triangle's corners is its first, and whichever way round it is.
TEST(Deviation, OfADentUnderTheMiddleOfAnEdge) {
  const TriangleMesh dent{{{-1e-3, 0, 0}, {1e-3, 0, 0}, {0, 1e-3, 0}, {0, 0, -1e-3}}, {{0, 3, 2}, {3, 1, 2}}};
  for (const Triangle& corners :
       {Triangle{0, 1, 2}, Triangle{2, 0, 1}, Triangle{1, 2, 0}, Triangle{0, 2, 1}}) {
    const TriangleMesh flat{{dent.vertices[0], dent.vertices[1], dent.vertices[2]}, {corners}};
    EXPECT_NEAR(measure_deviation(dent, flat).inward, 1e-3 / std::sqrt(3.0), 1e-12) << corners[0];
  }
}

TEST(Decimate, KeepsASolidClosedAndNearTheOriginal) {
  const TriangleMesh fine = make_torus(0.08, 0.03, 20'000);
  const TriangleMesh coarse = decimate(fine, 2000, "torus");
  EXPECT_LE(coarse.triangles.size(), 2000U);
  EXPECT_GT(coarse.triangles.size(), 1500U);
  EXPECT_EQ(test::manifold_flaw(coarse), "");
  const SurfaceDeviation d = measure_deviation(fine, coarse);
  // 2000 equal triangles over 0.0237 m^2 would have edges of 5.2 mm, whose sagitta on the tube (r = 15 mm) is
  // 0.23 mm; the longest edges are twice as long.
  EXPECT_LT(std::max(d.outward, d.inward), 4 * 0.23e-3);
  EXPECT_GT(d.outward, 10e-6);
}

TEST(Decimate, LeavesAMeshThatIsSmallEnough) {
  const TriangleMesh mesh = make_box({0.1, 0.1, 0.1}, 12);
  EXPECT_EQ(decimate(mesh, 12, "box").triangles, mesh.triangles);
}

TEST(Decimate, RefusesATargetThatDestroysTheMesh) {
  const auto refusal = [](const TriangleMesh& mesh, int triangles) -> std::string {
    try {
      (void)decimate(mesh, triangles, "cup.obj");
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal(make_sphere(0.1, 500), 2), AllOf(HasSubstr("cup.obj"), HasSubstr("2 triangles")));
  // 100 triangles do not hold 60 loose balls of at least 4 triangles each together.
  TriangleMesh balls;
  for (int i = 0; i < 60; ++i)
    append(balls, make_sphere(0.005, 100), Pose{Mat3::Identity(), Vec3(0.01 * i, 0, 0)});
  EXPECT_NE(refusal(balls, 100), "accepted");
}

TEST(PictureOf, KeepsASolidClosedAndNearTheOriginal) {
  const TriangleMesh fine = make_torus(0.08, 0.03, 20'000);
  const TriangleMesh picture = picture_of(fine, 2000);
  EXPECT_LE(picture.triangles.size(), 2000U);
  EXPECT_EQ(test::manifold_flaw(picture), "");
  const SurfaceDeviation d = measure_deviation(fine, picture);
  EXPECT_LT(std::max(d.outward, d.inward), 4 * 0.23e-3);  // as for decimate()
}

TEST(PictureOf, LeavesAMeshThatIsSmallEnough) {
  const TriangleMesh mesh = make_box({0.1, 0.1, 0.1}, 12);
  EXPECT_EQ(picture_of(mesh, 12).triangles, mesh.triangles);
}

// The triangles that point to one side, of a plane cut into equal ones. They meet in vertices only, and no edge
// of them can be collapsed.
TEST(PictureOf, JoinsTheVerticesOfAMeshWhoseEdgesCannotBeCollapsed) {
  constexpr std::int32_t kSide = 60;
  TriangleMesh mesh;
  const auto vertex = [](std::int32_t i, std::int32_t j) { return i * (i + 1) / 2 + j; };
  for (std::int32_t i = 0; i <= kSide; ++i)
    for (std::int32_t j = 0; j <= i; ++j) mesh.vertices.emplace_back(1e-3 * i, 1e-3 * j, 0.0);
  for (std::int32_t i = 0; i < kSide; ++i)
    for (std::int32_t j = 0; j <= i; ++j)
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
  EXPECT_THROW((void)decimate(mesh, 100, "mesh"), std::invalid_argument);
  const TriangleMesh picture = picture_of(mesh, 100);
  EXPECT_LE(picture.triangles.size(), 100U);
  ASSERT_GT(picture.triangles.size(), 10U);
  EXPECT_LT((test::extents(picture) - test::extents(mesh)).norm(), 0.02);
}

TEST(ImportAndCheck, DecimatesAndReportsHowFarItIsOff) {
  const TriangleMesh ball = make_sphere(0.09, 5000);
  const std::string text = test::to_obj(ball);
  const ImportedMesh imported =
      import_and_check_from_memory(text.data(), text.size(), "obj", {.triangles = 500});
  ASSERT_TRUE(imported.report.decimation.has_value());
  const DecimationReport& d = *imported.report.decimation;
  EXPECT_EQ(d.asked, 500);
  EXPECT_EQ(d.before, ball.triangles.size());
  EXPECT_EQ(d.after, imported.mesh.triangles.size());
  EXPECT_LE(d.after, 500U);
  EXPECT_TRUE(d.was_closed);
  EXPECT_TRUE(imported.report.closed);
  EXPECT_TRUE(is_closed(imported.mesh));
  // The facets of an inscribed sphere of 500 triangles are some 0.5 mm below the surface.
  EXPECT_GT(d.deviation.outward, 0.1e-3);
  EXPECT_LT(d.deviation.outward, 2e-3);
  // The rest of the report is of what is handed back, too, and lists nothing that was not found.
  const MeshReport& report = imported.report;
  EXPECT_EQ(report.triangles, imported.mesh.triangles.size());
  EXPECT_EQ(report.vertices, imported.mesh.vertices.size());
  EXPECT_NEAR(report.volume, signed_volume(imported.mesh), 1e-12);
  EXPECT_LT((report.extent - test::extents(imported.mesh)).norm(), 1e-15);
  for (const MeshFinding& finding : report.findings)
    EXPECT_GT(finding.found, 0U) << finding_name(finding.kind);
}

// A sphere of 1,000 triangles without each 30th. With locked rims more than 88 triangles remain, a tenth over
// the 80 that are asked for. So decimate() goes on without the lock, and the holes close.
TEST(ImportAndCheck, SaysThatDecimationHasClosedTheHoles) {
  const TriangleMesh whole = make_sphere(0.05, 1000);
  TriangleMesh ball{whole.vertices, {}};
  for (std::size_t t = 0; t < whole.triangles.size(); ++t)
    if (t % 30 != 0) ball.triangles.push_back(whole.triangles[t]);
  const std::string text = test::to_obj(ball);
  const ImportedMesh before = import_and_check_from_memory(text.data(), text.size(), "obj");
  EXPECT_FALSE(before.report.closed);
  EXPECT_GT(before.report.finding(FindingKind::kHoles).found, 0U);
  const ImportedMesh after = import_and_check_from_memory(text.data(), text.size(), "obj", {.triangles = 80});
  EXPECT_FALSE(after.report.decimation.value().was_closed);
  EXPECT_TRUE(is_closed(after.mesh));
  EXPECT_TRUE(after.report.closed);
  EXPECT_EQ(after.report.finding(FindingKind::kHoles).found, 0U);
}

TEST(ImportAndCheck, LeavesAMeshOfAsManyTrianglesAsAskedForUndecimated) {
  const std::string text = test::to_obj(make_box({0.05, 0.05, 0.05}, 12));
  const ImportedMesh imported =
      import_and_check_from_memory(text.data(), text.size(), "obj", {.triangles = 12});
  EXPECT_FALSE(imported.report.decimation.has_value());
  EXPECT_EQ(imported.mesh.triangles.size(), 12U);
}

TEST(ImportAndCheck, DecimatesASheetWithoutMovingItsOutline) {
  TriangleMesh sheet;
  constexpr int kSide = 40;
  for (int i = 0; i <= kSide; ++i)
    for (int j = 0; j <= kSide; ++j)
      sheet.vertices.emplace_back(0.002 * i, 0.002 * j, 0.003 * std::sin(0.2 * i));
  for (std::int32_t i = 0; i < kSide; ++i)
    for (std::int32_t j = 0; j < kSide; ++j) {
      const std::int32_t a = i * (kSide + 1) + j;
      sheet.triangles.push_back({a, a + kSide + 1, a + 1});
      sheet.triangles.push_back({a + 1, a + kSide + 1, a + kSide + 2});
    }
  const std::string text = test::to_obj(sheet);
  const ImportedMesh imported =
      import_and_check_from_memory(text.data(), text.size(), "obj", {.triangles = 800});
  EXPECT_EQ(imported.report.sheets, 1U);
  EXPECT_LE(imported.mesh.triangles.size(), 880U);
  EXPECT_LT((test::extents(imported.mesh) - test::extents(sheet)).norm(), 1e-8);
  EXPECT_LT(imported.report.decimation->deviation.outward, 0.5e-3);
}

}  // namespace
}  // namespace phalanx::mesh
