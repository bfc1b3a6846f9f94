// SPDX-License-Identifier: Apache-2.0
// What `phalanx mesh check` prints, writes and returns.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/run_program.h"
#include "phalanx/mesh/import.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::read_file;
using testing::run_program;
using testing::TemporaryFolder;
using testing::write_file;

const char* const kOpenCube =
    "v 0 0 0\nv .05 0 0\nv 0 .05 0\nv .05 .05 0\nv 0 0 .05\nv .05 0 .05\nv 0 .05 .05\nv .05 .05 .05\n"
    "f 1 3 2\nf 2 3 4\nf 5 6 7\nf 6 8 7\nf 1 2 5\nf 2 6 5\nf 3 7 4\nf 4 7 8\nf 1 5 3\nf 3 5 7\n";

TEST(CliMesh, SaysWhatRemainsAndWhatItMeans) {
  const TemporaryFolder folder;
  write_file(folder / "cube.obj", kOpenCube);
  const auto result = run_program(folder, "mesh check cube.obj");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("cube.obj"), HasSubstr("closed       no"), HasSubstr("holes"),
                    HasSubstr("200 mm"), HasSubstr("(0.05, 0.025, 0.025)"), HasSubstr("both sides")));
}

TEST(CliMesh, PrintsTheSameAsJson) {
  const TemporaryFolder folder;
  write_file(folder / "cube.obj", kOpenCube);
  write_file(folder / "none.obj", "");
  const auto result = run_program(folder, "mesh check cube.obj none.obj --json");
  EXPECT_EQ(result.exit_code, 2) << "one of them is refused";
  const auto reports = nlohmann::json::parse(result.out);
  ASSERT_EQ(reports.size(), 2U);
  EXPECT_EQ(reports[0]["usable"], true);
  EXPECT_EQ(reports[0]["triangles"], 10);
  EXPECT_EQ(reports[0]["sheets"], 1);
  EXPECT_EQ(reports[0]["findings"][0]["kind"], "holes");
  EXPECT_NEAR(reports[0]["findings"][0]["size_m"].get<double>(), 0.2, 1e-7);
  EXPECT_NEAR(reports[0]["findings"][0]["width_m"].get<double>(), 0.05, 1e-7);
  EXPECT_NEAR(reports[0]["findings"][0]["at"][0].get<double>(), 0.05, 1e-7);
  EXPECT_EQ(reports[1]["usable"], false);
  EXPECT_THAT(reports[1]["verdict"].get<std::string>(), HasSubstr("empty"));
}

TEST(CliMesh, RefusesASizeThatNoHandHolds) {
  const TemporaryFolder folder;
  write_obj(make_box({90, 60, 30}, 12), folder / "box.obj", "box");
  const auto as_metres = run_program(folder, "mesh check box.obj");
  EXPECT_EQ(as_metres.exit_code, 2);
  EXPECT_THAT(as_metres.out, HasSubstr("the size in mm; type --unit mm\n"));
  EXPECT_EQ(run_program(folder, "mesh check box.obj --unit mm").exit_code, 0);
  EXPECT_EQ(run_program(folder, "mesh check box.obj --size-mm 90").exit_code, 0);
}

TEST(CliMesh, WritesTheDecimatedMesh) {
  const TemporaryFolder folder;
  write_obj(make_sphere(0.09, 5000), folder / "ball.obj", "ball");
  const auto result = run_program(folder, "mesh check ball.obj --decimate 500 --out small.obj");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("500 asked for"), HasSubstr("after the repair, "),
                                HasSubstr(" after decimation\n")));
  const TriangleMesh small = import_and_check(folder / "small.obj").mesh;
  EXPECT_LE(small.triangles.size(), 500U);
  EXPECT_TRUE(is_closed(small));
}

TEST(CliMesh, NeverWritesOverItsInputAndWritesObjOnly) {
  const TemporaryFolder folder;
  write_file(folder / "cube.obj", kOpenCube);
  for (const char* line : {"mesh check cube.obj --out ./cube.obj", "mesh check cube.obj --out cube.stl"})
    EXPECT_EQ(run_program(folder, line).exit_code, 2) << line;
  EXPECT_EQ(read_file(folder / "cube.obj"), kOpenCube);
  EXPECT_FALSE(std::filesystem::exists(folder / "cube.stl"));
}

TEST(CliMesh, RefusesWhatContradictsItself) {
  const TemporaryFolder folder;
  write_file(folder / "cube.obj", kOpenCube);
  for (const char* line :
       {"mesh check cube.obj --size-mm 90 --unit mm", "mesh check cube.obj cube.obj --out a.obj",
        "mesh check", "mesh check cube.obj --unit furlong"}) {
    const auto result = run_program(folder, line);
    EXPECT_EQ(result.exit_code, 2) << line;
    EXPECT_THAT(result.err, Not(IsEmpty())) << line;
  }
}

}  // namespace
}  // namespace phalanx
