// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/mesh_report_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace phalanx {
namespace {

using Json = nlohmann::json;

/// Every field has a number of its own.
MeshReport numbered_report() {
  MeshReport report;
  report.vertices_in_file = 101;
  report.triangles_in_file = 102;
  report.vertices = 103;
  report.triangles = 104;
  report.extent = Vec3(0.25, 0.5, 0.125);
  report.scale = 1e-3;
  report.tolerance = 1e-6;
  report.moved = 0.5e-6;
  report.held_back = true;
  report.closed = true;
  report.volume = 0.0078125;
  report.solids = 2;
  report.cavities = 1;
  report.findings = {{.kind = FindingKind::kDegenerateFaces,
                      .found = 7,
                      .repaired = 5,
                      .size = 0.0625,
                      .width = 0.03125,
                      .area = 0.015625,
                      .at = Vec3(250.0, -500.0, 125.0)},
                     {.kind = FindingKind::kPinchVertices, .found = 3}};
  return report;
}

TEST(MeshReportJson, EveryFieldIsInTheUnitOfItsName) {
  MeshReport report = numbered_report();
  report.decimation = {
      .asked = 90,
      .before = 104,
      .after = 88,
      .was_closed = true,
      .deviation = {.outward = 0.25e-3, .inward = 0.125e-3, .probes = 4096},
  };
  const Json json = Json::parse(mesh_report_json("cup.stl", report));
  EXPECT_EQ(json["file"], "cup.stl");
  EXPECT_EQ(json["usable"], true);
  // Two solids, one of them with a hollow: three shells.
  EXPECT_EQ(json["verdict"], "usable: a closed solid in 3 pieces");
  EXPECT_EQ(json["triangles_in_file"], 102);
  EXPECT_EQ(json["vertices_in_file"], 101);
  EXPECT_EQ(json["triangles"], 104);
  EXPECT_EQ(json["vertices"], 103);
  EXPECT_EQ(json["extent_m"], (Json{0.25, 0.5, 0.125}));
  EXPECT_EQ(json["metres_per_unit"], 1e-3);
  EXPECT_EQ(json["closed"], true);
  EXPECT_EQ(json["volume_m3"], 0.0078125);
  EXPECT_EQ(json["solids"], 2);
  EXPECT_EQ(json["hollows"], 1);
  EXPECT_EQ(json["sheets"], 0);
  EXPECT_EQ(json["tolerance_m"], 1e-6);
  EXPECT_EQ(json["moved_m"], 0.5e-6);
  EXPECT_EQ(json["held_back"], true);
  EXPECT_EQ(json["complete"], true);
  ASSERT_EQ(json["findings"].size(), 2U);
  EXPECT_EQ(json["findings"][0], (Json{{"kind", "degenerate_faces"},
                                       {"found", 7},
                                       {"repaired", 5},
                                       {"remains", 2},
                                       {"size_m", 0.0625},
                                       {"width_m", 0.03125},
                                       {"area_m2", 0.015625},
                                       {"at", {250.0, -500.0, 125.0}},
                                       {"meaning", finding_meaning(report.findings[0])}}));
  EXPECT_EQ(json["findings"][1]["remains"], 3);
  EXPECT_TRUE(json["findings"][1]["at"].is_null()) << "no place is known";
  EXPECT_EQ(json["decimation"], (Json{{"asked", 90},
                                      {"before", 104},
                                      {"after", 88},
                                      {"was_closed", true},
                                      {"original_to_decimated_m", 0.25e-3},
                                      {"decimated_to_original_m", 0.125e-3},
                                      {"points", 4096}}));
  EXPECT_EQ(json.size(), 20U) << "a field without a check";
}

TEST(MeshReportJson, AMeshWithoutFaultHasAnEmptyListOfFindings) {
  MeshReport report = numbered_report();
  report.findings.clear();
  EXPECT_EQ(Json::parse(mesh_report_json("cup.stl", report)).at("findings"), Json::array());
}

TEST(MeshReportJson, TheVerdictSaysWhatMayBeUsed) {
  MeshReport report = numbered_report();
  report.solids = 1;
  report.cavities = 0;
  EXPECT_EQ(mesh_verdict(report), "usable: a closed solid");
  report.closed = false;
  EXPECT_EQ(mesh_verdict(report), "usable: closed, though edges are shared by more than two triangles");
  report.sheets = 1;
  EXPECT_EQ(mesh_verdict(report), "usable: open, so that its sheets are met from both sides");
  // 90 m wide, in units of 1 m: 90 of something that is 1 mm makes 90 mm.
  report.scale = 1.0;
  report.findings = {{.kind = FindingKind::kUnits, .found = 1, .size = 90.0}};
  EXPECT_EQ(
      mesh_verdict(report),
      "refused in a scene as it stands: it is 90 m wide; probably its numbers are mm (90 mm): give unit "
      "\"mm\" with size_mm 0, or the size in mm");
  EXPECT_EQ(Json::parse(mesh_report_json("far.stl", report))["usable"], false);
}

}  // namespace
}  // namespace phalanx
