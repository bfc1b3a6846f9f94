// SPDX-License-Identifier: Apache-2.0
// What the report says of a file, format by format.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "mesh/import/mesh_files.h"
#include "phalanx/mesh/import.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

ImportedMesh import_with_report(const std::string& text, const std::string& format,
                                const ImportOptions& options = {}) {
  return import_and_check_from_memory(text.data(), text.size(), format, options);
}

std::string report_refusal(const std::string& text, const std::string& format, const ImportOptions& options) {
  try {
    (void)import_with_report(text, format, options);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

const char* const kCubeWithFlaws =
    "v 0 0 0\nv .05 0 0\nv 0 .05 0\nv .05 .05 0\nv 0 0 .05\nv .05 0 .05\nv 0 .05 .05\nv .05 .05 .05\n"
    "v 0 0 0\nv 7 7 7\n"                                      // the first again, and one that no face names
    "f 1 3 2\nf 2 3 4\nf 5 6 7\nf 6 8 7\nf 9 2 5\nf 2 6 5\n"  // one corner by its second number
    "f 3 7 4\nf 4 7 8\nf 1 5 3\nf 3 5 7\nf 2 4 6\nf 4 6 8\n"  // the last winds the other way
    "f 1 3 2\nf 1 1 2\n";                                     // twice, and without area

TEST(ImportReport, CountsAnObjsOwnVertices) {
  const ImportedMesh imported = import_with_report(kCubeWithFlaws, "obj");
  const MeshReport& r = imported.report;
  EXPECT_EQ(r.vertices_in_file, 10U);
  EXPECT_EQ(r.finding(FindingKind::kUnreferencedVertices).found, 1U);
  EXPECT_EQ(r.finding(FindingKind::kDuplicateVertices).found, 1U);
  EXPECT_EQ(r.finding(FindingKind::kDuplicateFaces).found, 1U);
  EXPECT_EQ(r.finding(FindingKind::kDegenerateFaces).found, 1U);
  EXPECT_EQ(r.finding(FindingKind::kInconsistentWinding).found, 1U);
  EXPECT_EQ(r.triangles, 12U);
  EXPECT_EQ(r.vertices, 8U);
  EXPECT_TRUE(r.closed);
  EXPECT_NEAR(r.volume, 125e-6, 1e-10);
}

// Vertex 4 is named by a face of two corners, which is no surface.
TEST(ImportReport, CountsAVertexOfALineOnlyAsUnreferenced) {
  const std::string text = "v 0 0 0\nv .06 0 0\nv 0 .06 0\nv .06 .06 .06\nf 4 1\nf 1 2 3\n";
  const MeshReport r = import_with_report(text, "obj").report;
  EXPECT_EQ(r.finding(FindingKind::kUnreferencedVertices).found, 1U);
  EXPECT_EQ(r.vertices_in_file, 4U);
  EXPECT_EQ(r.vertices, 3U);
}

TEST(ImportReport, OfNothingYetSaysThatNothingWasFound) {
  const MeshReport r{};
  for (const std::size_t count : {r.vertices_in_file, r.triangles_in_file, r.vertices, r.triangles, r.solids,
                                  r.cavities, r.sheets, r.findings.size()})
    EXPECT_EQ(count, 0U);
  for (const double number : {r.tolerance, r.moved, r.volume, r.extent.norm(), r.origin.norm()})
    EXPECT_EQ(number, 0.0);
  EXPECT_EQ(r.scale, 1.0);
  EXPECT_FALSE(r.closed);
  EXPECT_TRUE(r.complete);
  EXPECT_FALSE(r.decimation);
  const DecimationReport d{};
  EXPECT_EQ(d.asked, 0);
  EXPECT_FALSE(d.was_closed);
  for (const std::size_t count : {d.before, d.after, d.deviation.probes}) EXPECT_EQ(count, 0U);
  for (const double metres : {d.deviation.outward, d.deviation.inward}) EXPECT_EQ(metres, 0.0);
}

TEST(ImportReport, KnowsThatAnStlHasItsCornersApart) {
  const ImportedMesh imported = import_with_report(test::to_stl_binary(make_box({0.1, 0.1, 0.1}, 12)), "stl");
  EXPECT_EQ(imported.report.finding(FindingKind::kDuplicateVertices).found, 28U);
  EXPECT_EQ(imported.report.findings.size(), 1U);
}

TEST(ImportReport, ReadsNumbersInTheUnitGiven) {
  const std::string text = test::to_ply_text(make_box({90, 60, 30}, 12));
  const ImportedMesh as_metres = import_with_report(text, "ply");
  EXPECT_EQ(as_metres.report.finding(FindingKind::kUnits).found, 1U);
  const ImportedMesh as_mm = import_with_report(text, "ply", {.unit = 1e-3});
  EXPECT_EQ(as_mm.report.findings.size(), 0U);
  EXPECT_NEAR((as_mm.report.extent - Vec3(0.09, 0.06, 0.03)).norm(), 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(as_mm.report.scale, 1e-3);
  const ImportedMesh sized = import_with_report(text, "ply", {.size = 0.045, .unit = 1e-3});
  EXPECT_NEAR(sized.report.scale, 0.5e-3, 1e-18);
}

TEST(ImportReport, SaysWhatManyTrianglesCost) {
  const ImportedMesh imported = import_with_report(test::to_stl_binary(make_sphere(0.1, 210'000)), "stl");
  EXPECT_EQ(imported.report.finding(FindingKind::kManyTriangles).found, imported.mesh.triangles.size());
  EXPECT_THAT(finding_meaning(imported.report.finding(FindingKind::kManyTriangles)), HasSubstr("decimate"));
}

TEST(ImportRefuses, AnObjectThatSinglePrecisionCannotHold) {
  TriangleMesh far = make_box({0.09, 0.09, 0.09}, 12);
  for (Vec3& v : far.vertices) v.x() += 9000.0;
  for (const auto& [text, format] : {std::pair{test::to_stl_binary(far), "stl"}, {test::to_obj(far), "obj"}})
    EXPECT_THAT(report_refusal(text, format, {}), AllOf(HasSubstr("single precision"), HasSubstr("origin")))
        << format;
}

// Points alone, one of them NaN: what lacks is a surface.
TEST(ImportRefuses, PointsWithoutASurface) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "end_header\n0 0 0\nnan nan nan\n1 0 0\n";
  EXPECT_THAT(report_refusal(text, "ply", {}), HasSubstr("no triangle"));
}

// Decimation moves no finding to another frame.
TEST(ImportReport, SaysWhereInTheFileAfterDecimationToo) {
  TriangleMesh ball = make_sphere(20, 2000);
  for (Vec3& v : ball.vertices) v += Vec3(100, 200, 300);
  std::erase_if(ball.triangles, [&](const Triangle& t) {
    return ball.vertices[static_cast<std::size_t>(t[0])].z() > 306;  // no cap: 16 mm across
  });
  const std::string text = test::to_ply_text(ball);
  for (const int triangles : {0, 500}) {
    const MeshReport r = import_with_report(text, "ply", {.size = 0.05, .triangles = triangles}).report;
    const MeshFinding hole = r.finding(FindingKind::kHoles);
    ASSERT_EQ(hole.found, 1U);
    ASSERT_TRUE(hole.at);
    EXPECT_LT((*hole.at - Vec3(100, 200, 306)).norm(), 1.5) << hole.at->transpose();
    EXPECT_NEAR(hole.width, 16 * r.scale, 2.5 * r.scale);
  }
}

TEST(ImportRefuses, AnOptionThatMakesNoSense) {
  const std::string text = test::to_obj(make_box({0.1, 0.1, 0.1}, 12));
  EXPECT_THAT(report_refusal(text, "obj", {.unit = 0.0}), HasSubstr("unit is 0 m"));
  EXPECT_THAT(report_refusal(text, "obj", {.unit = std::numeric_limits<double>::infinity()}),
              HasSubstr("unit is inf m"));
  EXPECT_THAT(report_refusal(text, "obj", {.triangles = -5}), HasSubstr("-5 triangles"));
  EXPECT_THAT(report_refusal(text, "obj", {.triangles = 1}), HasSubstr("decimated to 1 triangles"));
}

TEST(ImportRefuses, GlTf1AndUtf16InWords) {
  EXPECT_THAT(report_refusal(std::string("glTF\1\0\0\0", 8) + std::string(40, ' '), "glb", {}),
              HasSubstr("glTF 1.0"));
  EXPECT_THAT(report_refusal(std::string("\xFE\xFF\0v\0 ", 6), "obj", {}), HasSubstr("UTF-16"));
}

TEST(ImportRefuses, WhatIsNoFileOfItsFormatWithTheReadersOwnWords) {
  EXPECT_THAT(report_refusal("solid", "stl", {}), HasSubstr("mesh in memory: cannot be read as .stl ("));
}

// Four thousand million vertices in 200 bytes.
TEST(ImportRefuses, AHeaderThatClaimsMoreThanAnyMachineHolds) {
  const std::string answer = report_refusal(
      test::ply_header("binary_little_endian", 4'000'000'000, 4'000'000'000) + "abc", "ply", {});
  EXPECT_THAT(answer, HasSubstr("mesh in memory: "));
}

}  // namespace
}  // namespace phalanx
