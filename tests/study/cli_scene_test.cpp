// SPDX-License-Identifier: Apache-2.0
// `phalanx scene list` and `phalanx scene pictures`.
#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "study/run_program.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using testing::read_file;
using testing::run_program;
using ::testing::StartsWith;
using testing::TemporaryFolder;

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

TEST(CliScenePictures, DrawsEachSceneAndTheSheet) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "scene pictures pinch_peg wave --out drawn --width 64 --columns 2");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* name : {"drawn/pinch_peg.png", "drawn/wave.png", "drawn/scenes.png"})
    EXPECT_THAT(read_file(folder / name), StartsWith("\x89PNG")) << name;
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
