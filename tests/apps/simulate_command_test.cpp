// SPDX-License-Identifier: Apache-2.0
// What `phalanx simulate` and its neighbours write.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "apps/run_program.h"
#include "phalanx/hand/joints.h"
#include "phalanx/record/ticks_csv.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::read_file;
using testing::run_program;
using testing::TemporaryFolder;
using testing::write_file;

std::ptrdiff_t lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

TEST(CliSimulate, PrintsATableWithoutOut) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "simulate index_ball");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, IsEmpty());  // no progress bar where there is no terminal
  for (const char* word :
       {"index proximal", "index-finger-phalanx-proximal", "peak force [N]", "index MCP flexion", "p99.9"}) {
    EXPECT_THAT(result.out, HasSubstr(word));
  }
}

TEST(CliSimulate, WritesEveryFileThatItPromises) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "simulate index_ball --seconds 1 --poses --out a/b --plot");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string ticks = read_file(folder / "a/b/ticks.csv");
  EXPECT_EQ(lines(ticks), 201);
  EXPECT_THAT(ticks, ::testing::StartsWith(ticks_csv_header() + "\n"));
  EXPECT_EQ(lines(read_file(folder / "a/b/poses.csv")), 1 + 200 * 2 * kSegments);
  EXPECT_THAT(read_file(folder / "a/b/plot.svg"), HasSubstr("</svg>"));
  EXPECT_THAT(read_file(folder / "a/b/object.obj"), HasSubstr("\nf "));
  for (int s = 0; s < kSegments; ++s) {
    EXPECT_TRUE(
        std::filesystem::exists(folder.path() / "a/b/hand" / (std::string(segment_name(s)) + ".obj")));
  }
  const auto summary = nlohmann::json::parse(read_file(folder / "a/b/summary.json"));
  EXPECT_EQ(summary["scene"], "index_ball");
  EXPECT_EQ(summary["ticks"], 200);
  EXPECT_EQ(summary["rate_hz"], 200.0);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "a")) {
    EXPECT_NE(entry.path().extension(), ".partial") << entry.path();
  }
}

TEST(CliSimulate, WritesTheSameTicksTwice) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_program(folder, "simulate press_teapot --quiet --out a").exit_code, 0);
  ASSERT_EQ(run_program(folder, "simulate press_teapot --quiet --out b").exit_code, 0);
  const std::string a = read_file(folder / "a/ticks.csv");
  EXPECT_GT(a.size(), 100'000U);
  EXPECT_EQ(a, read_file(folder / "b/ticks.csv"));
}

TEST(CliSimulate, LeavesNoFileOfAnEarlierRunThatItDoesNotWrite) {
  const TemporaryFolder folder;
  ASSERT_EQ(
      run_program(folder, "simulate wave --seconds 0.1 --poses --contacts --set contact.mode=sliding --out a")
          .exit_code,
      0);
  ASSERT_EQ(run_program(folder, "simulate wave --seconds 0.1 --out a").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "a/poses.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a/contacts.csv"));
}

TEST(CliSimulate, WritesTheContactPointsOfSlidingMode) {
  const TemporaryFolder folder;
  const auto result =
      run_program(folder, "simulate index_ball --quiet --set contact.mode=sliding --contacts --out a");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string contacts = read_file(folder / "a/contacts.csv");
  EXPECT_THAT(contacts, ::testing::StartsWith("tick,segment,px_m"));
  EXPECT_GT(lines(contacts), 50);
}

TEST(CliSimulate, OverridesRateSecondsAndSceneKeys) {
  const TemporaryFolder folder;
  const auto result = run_program(folder,
                                  "simulate index_ball --rate-hz 1000 --seconds 0.5 --set "
                                  "force.stiffness_n_per_mm=0.9 --set limits.fingertip_force_n=4 "
                                  "--quiet --out a");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, IsEmpty());
  const auto summary = nlohmann::json::parse(read_file(folder / "a/summary.json"));
  EXPECT_EQ(summary["ticks"], 500);
  EXPECT_EQ(summary["rate_hz"], 1000.0);
}

TEST(CliSimulate, PlaysAMotionFileAndOneTrialOfMany) {
  const TemporaryFolder folder;
  write_file(folder / "m.csv", "time_s,index_mcp_flexion\n0,0\n0.5,0.1\n0,0.2\n1,0.3\n");
  const auto result = run_program(folder, "simulate wave --motion m.csv --trial 2 --quiet --out a");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string ticks = read_file(folder / "a/ticks.csv");
  EXPECT_EQ(lines(ticks), 201);
}

// The index finger begins pressed into the ball: without a lead-in it has no force, and the warning names it.
TEST(CliSimulate, LeadsARecordingInFromTheOpenHand) {
  const TemporaryFolder folder;
  write_file(folder / "m.csv", "time_s,index_mcp_flexion,index_pip_flexion\n0,0.9,0.9\n1,0.9,0.9\n");
  const std::string command = "simulate index_ball --motion m.csv";
  ASSERT_EQ(run_program(folder, command + " --quiet --out a").exit_code, 0);
  const auto inside = nlohmann::json::parse(read_file(folder / "a/summary.json"));
  EXPECT_EQ(inside["status_ticks"]["start_inside"], 200);
  EXPECT_THAT(inside["warnings"].dump(), ::testing::HasSubstr("200 ticks: index (200 ticks) started inside"));
  EXPECT_EQ(inside["peak_total_force"]["force_n"], 0.0);
  ASSERT_EQ(run_program(folder, command + " --lead-in 0.5 --quiet --out b").exit_code, 0);
  const auto led = nlohmann::json::parse(read_file(folder / "b/summary.json"));
  EXPECT_EQ(led["ticks"], 300);
  EXPECT_EQ(led["status_ticks"]["start_inside"], 0);
  EXPECT_GT(led["peak_total_force"]["force_n"], 1.0);
  const auto refused = run_program(folder, "simulate index_ball --lead-in 0.5");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, ::testing::HasSubstr("--lead-in 0.5"));
}

TEST(CliSimulate, TakesAnObjectFromAFile) {
  const TemporaryFolder folder;
  write_file(folder / "tetra.obj",
             "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const auto result = run_program(
      folder, "simulate index_ball --seconds 0.1 --object tetra.obj --object-size-mm 40 --quiet --out a");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto summary = nlohmann::json::parse(read_file(folder / "a/summary.json"));
  EXPECT_EQ(summary["triangles"]["object"], 4);
}

TEST(CliSimulate, NamesTheNearestSegmentAndTheRemediesIfNoneTouchedTheObject) {
  const TemporaryFolder folder;
  const std::string command = "simulate index_ball --seconds 0.1";
  const auto result = run_program(folder, command + " --set objects.0.position_mm=[0,0,400]");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out,
              ::testing::ContainsRegex("no segment touched the object: the nearest was the [a-zA-Z ]+, "
                                       "[0-9.]+ mm away; move the object"));
  EXPECT_THAT(result.out, HasSubstr("(--set objects.0.position_mm=[x,y,z])"));
  EXPECT_THAT(result.out, HasSubstr("(--set motion.closure=0.8)\n"));
  EXPECT_THAT(run_program(folder, command + " --set objects=[]").out,
              HasSubstr("no segment touched the object\n"));
}

TEST(CliSimulate, WarnsOfKeysOfDeviceAndPatientWhichOnlyTheClosedLoopReads) {
  const TemporaryFolder folder;
  const std::string command = "simulate index_ball --seconds 0.1";
  const auto result = run_program(folder, command + " --set device.file=light --set patient.press_n=3");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out,
              HasSubstr("warning  --set device.file=light: device.file has no effect in simulate; "));
  EXPECT_THAT(result.out, HasSubstr("warning  --set patient.press_n=3: patient.press_n has no effect"));
  EXPECT_THAT(run_program(folder, "simulate first_touch --seconds 0.1").out, Not(HasSubstr("no effect")));
}

TEST(CliSimulate, WarnsOfAnObjectWithAHole) {
  const TemporaryFolder folder;
  const std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n";
  write_file(folder / "open.obj", faces);
  write_file(folder / "closed.obj", faces + "f 1 4 3\n");
  const auto simulated = [&](const std::string& file) {
    return run_program(folder, "simulate index_ball --seconds 0.1 --object-size-mm 40 --object " + file).out;
  };
  EXPECT_THAT(simulated("open.obj"), HasSubstr("warning  the mesh is open"));
  EXPECT_THAT(simulated("open.obj"), ::testing::ContainsRegex("see `phalanx mesh check .*open.obj`"));
  EXPECT_THAT(simulated("closed.obj"), Not(HasSubstr("warning  the mesh")));
}

// The scene's ball has a diameter; the file in its place has a unit and no diameter.
TEST(CliSimulate, TakesWhatSetSaysOfTheFileInTheObjectsPlace) {
  const TemporaryFolder folder;
  write_file(folder / "tetra.obj",
             "v 0 0 0\nv 7 0 0\nv 0 7 0\nv 0 0 7\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const std::string command = "simulate index_ball --seconds 0.1 --object tetra.obj --quiet --out a";
  const auto refused = run_program(folder, command);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, ::testing::HasSubstr("type --set objects.0.unit=cm\n"));
  const auto result =
      run_program(folder, command + " --set objects.0.unit=cm --set objects.0.position_mm=[1,2,-500]");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(read_file(folder / "a/object.obj"), ::testing::HasSubstr("0.001 0.002 -0.5\n"));
  EXPECT_EQ(run_program(folder, command + " --set objects.0.diameter_mm=3").exit_code, 2);
}

TEST(CliSimulate, RendersAPicture) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_program(folder, "simulate index_ball --seconds 1 --quiet --picture a.png").exit_code, 0);
  EXPECT_THAT(read_file(folder / "a.png"), ::testing::StartsWith("\x89PNG"));
}

TEST(CliSimulate, RefusesAMomentThatIsNotPlayedBeforeItWrites) {
  const TemporaryFolder folder;
  const auto late = run_program(folder, "simulate wave --seconds 1 --picture a.png --at 1");
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_THAT(late.err, HasSubstr("--at 1: the motion is played from 0 to 0.995 s"));
  for (const char* at : {"-0.1", "nan", "inf"})
    EXPECT_EQ(run_program(folder, std::string("simulate wave --picture a.png --at ") + at).exit_code, 2)
        << at;
  EXPECT_THAT(run_program(folder, "simulate wave --at 1").err, HasSubstr("--at needs --picture"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

// ticks.csv has more than 1,000 blocks of 512 or 1,024 bytes; the meshes have less.
TEST(CliSimulate, FailsWithOneWhenAFileCannotBeWritten) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "simulate wave --quiet --out a", ".out", "ulimit -f 1000");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("ticks.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a/summary.json"));
}

TEST(CliSimulate, TakesNumbersHoweverShortTheyAreWritten) {
  const TemporaryFolder folder;
  for (const char* seconds : {"1e-9", "1e-1", ".1", "1"}) {
    const auto result =
        run_program(folder, std::string("simulate wave --quiet --rate-hz 1e2 --seed 7 --seconds ") + seconds);
    EXPECT_EQ(result.exit_code, 0) << seconds << ": " << result.err;
  }
}

TEST(CliScene, ListsChecksAndDocumentsScenes) {
  const TemporaryFolder folder;
  EXPECT_THAT(run_program(folder, "scene list").out, HasSubstr("grasp_teapot"));
  EXPECT_THAT(run_program(folder, "scene keys").out, HasSubstr("force.stiffness_n_per_mm"));
  const auto check = run_program(folder, "scene check index_ball wave");
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("index_ball: good"));
  EXPECT_EQ(run_program(folder, "scene check nope").exit_code, 2);
}

TEST(CliExperiment, WritesItsTable) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "experiment s1-fig8 --out a");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("whole finger"));
  EXPECT_THAT(run_program(folder, "experiment --help").out,
              HasSubstr("which joints carry torque (about 1 s)"));
  EXPECT_EQ(lines(read_file(folder / "a/s1-fig8.csv")), 8);
  EXPECT_EQ(nlohmann::json::parse(read_file(folder / "a/summary.json"))["situations"].size(), 7U);
}

}  // namespace
}  // namespace phalanx
