// SPDX-License-Identifier: Apache-2.0
// `phalanx scene list`, `phalanx scene check`, `phalanx scene grasps` and `phalanx scene pictures`.
#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "apps/run_program.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::read_file;
using testing::run_program;
using ::testing::StartsWith;
using testing::TemporaryFolder;
using testing::write_file;

TEST(CliSceneList, ShowsEverySceneOnceByNameWithItsLineInOneColumn) {
  const TemporaryFolder folder;
  std::istringstream out(run_program(folder, "scene list").out);
  std::vector<std::string> names;
  std::size_t column = 0;
  for (std::string line; std::getline(out, line);) {
    const std::size_t space = line.find(' ');
    ASSERT_NE(space, std::string::npos) << line;
    names.push_back(line.substr(0, space));
    const std::size_t text = line.find_first_not_of(' ', space);
    ASSERT_NE(text, std::string::npos) << line;
    if (names.size() == 1) column = text;
    EXPECT_EQ(text, column) << line;
  }
  EXPECT_GE(names.size(), 19U);
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
}

TEST(CliSceneCheck, SaysEverythingThatIsWrongALineEach) {
  const TemporaryFolder folder;
  write_file(folder / "bad.toml",
             "rate_hertz = 200\nseconds = -1\n[force]\nlaw = \"hook\"\n[[objects]]\nkind = \"spere\"\n"
             "size_mm = 3\n[[objects]]\nkind = \"box\"\nsize_mm = 3\n[[objects]]\nkind = \"torus\"\n"
             "ring_diameter_mm = 10\ntube_diameter_mm = 20\n[device]\nmass = 1\n[patient]\nmass = 1\n");
  write_file(folder / "broken.toml", "a = \n");
  write_file(folder / "flat.toml", "objects = 3\nforce = 1\n");
  const auto result =
      run_program(folder, "scene check ./bad.toml wave ./broken.toml ./flat.toml ./none.toml");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, StartsWith("wave: good"));
  std::vector<std::string> lines;
  std::istringstream err(result.err);
  for (std::string line; std::getline(err, line);) lines.push_back(line);
  EXPECT_THAT(lines,
              ::testing::UnorderedElementsAre(
                  HasSubstr("bad.toml:1: rate_hertz = 200"), HasSubstr("bad.toml:2: seconds = -1"),
                  HasSubstr("bad.toml:4: force.law = "), HasSubstr("bad.toml:6: objects.0.kind = "),
                  HasSubstr("bad.toml:10: objects.1.size_mm"),
                  HasSubstr("bad.toml:14: objects.2.tube_diameter_mm = 20"),
                  HasSubstr("bad.toml:16: device.mass = 1"), HasSubstr("bad.toml:18: patient.mass = 1"),
                  HasSubstr("broken.toml:1: not valid TOML"), HasSubstr("flat.toml:1: objects = 3"),
                  HasSubstr("flat.toml:2: force = 1"), HasSubstr("there is no file")));
  for (const std::string& line : lines) EXPECT_THAT(line, StartsWith("phalanx: "));
}

TEST(CliSceneGrasps, TabulatesScenesAndHands) {
  const TemporaryFolder folder;
  const auto result =
      run_program(folder, "scene grasps pinch_ball tripod_ball --profile small-woman --out tables/held.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("| small woman, right |"), HasSubstr("| `pinch_ball` | pinch | TI 0."),
                    HasSubstr("| `tripod_ball` | tripod | TIM 0.")));
  EXPECT_THAT(read_file(folder / "tables/held.csv"),
              AllOf(StartsWith("scene,hand,type,digits,palm,closure_margin,holds,problem\n"),
                    HasSubstr("pinch_ball,\"small woman, right\",pinch,TI,0,0.")));
}

TEST(CliSceneGrasps, SaysWhyThereIsNoGrasp) {
  const TemporaryFolder folder;
  write_file(folder / "huge.toml",
             "[grasp]\ntype = 'pinch'\n[[objects]]\nkind = 'sphere'\ndiameter_mm = 400\n");
  const auto result = run_program(folder, "scene grasps ./huge.toml");
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("| no grasp |"), HasSubstr("the digits reach the object")));
  EXPECT_EQ(run_program(folder, "scene grasps nope").exit_code, 2);
  const auto nobody = run_program(folder, "scene grasps --profile nobody pinch_ball");
  EXPECT_EQ(nobody.exit_code, 2);
  EXPECT_THAT(nobody.err, HasSubstr("profile \"nobody\""));
}

TEST(CliScenePictures, DrawsEachSceneAndTheSheet) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "scene pictures pinch_peg wave --out drawn --width 64 --columns 2");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* name : {"drawn/pinch_peg.png", "drawn/wave.png", "drawn/scenes.png"})
    EXPECT_THAT(read_file(folder / name), StartsWith("\x89PNG")) << name;
  EXPECT_EQ(result.out, "wrote    drawn/NAME.png of 2 scenes, and all of them on drawn/scenes.png\n");
}

TEST(CliScenePictures, RefusesWhatItCannotDrawBeforeItWrites) {
  const TemporaryFolder folder;
  const auto nobody = run_program(folder, "scene pictures nope --out drawn");
  EXPECT_EQ(nobody.exit_code, 2);
  EXPECT_THAT(nobody.err, HasSubstr("nope"));
  EXPECT_FALSE(std::filesystem::exists(folder / "drawn"));
  EXPECT_EQ(run_program(folder, "scene pictures wave").exit_code, 2);
  EXPECT_EQ(run_program(folder, "scene pictures wave --out drawn --columns 0").exit_code, 2);
}

}  // namespace
}  // namespace phalanx
