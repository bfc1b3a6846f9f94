// SPDX-License-Identifier: Apache-2.0
// `phalanx hand show|export|pictures` and the option --profile, as their users meet them.
#include <gmock/gmock.h>

#include <numbers>
#include <sstream>

#include "apps/run_program.h"
#include "phalanx/hand/joints.h"
#include "phalanx/mesh/import.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using testing::read_file;
using testing::run_program;
using testing::TemporaryFolder;
using testing::write_file;

TEST(CliHand, ShowSaysSizesRangesAndHowFarTheyAreFromThePublishedMeans) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "hand show --profile stiff-hand");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  // (184 - 193.8) / 9.8 = -1.0, (82 - 90.4) / 4.2 = -2.0;  the stated 41 mm: (41 - 39.78) / 4.94 = +0.2.
  for (const char* word :
       {"stiff hand: a right hand", "184.00 mm   -1.0 SD of men", "82.00 mm   -2.0 SD of men", "triangles: "})
    EXPECT_THAT(result.out, HasSubstr(word));
  EXPECT_THAT(result.out,
              ::testing::ContainsRegex("index-finger-phalanx-proximal +41\\.00 +\\+0\\.2 +21\\.00"));
  EXPECT_THAT(result.out, ::testing::ContainsRegex("index_pip_flexion +15\\.0 +60\\.0 +15\\.0"));
}

// The thumb's flexion goes from -13 to 63 degrees; half of it, backwards, is 6.5 to -31.5.
TEST(CliHand, ShowListsCoupledRotationsUnlessNoneAreWanted) {
  const TemporaryFolder folder;
  std::string hand = read_file(PHALANX_SOURCE_DIR "/assets/hands/adult.toml");
  const std::string shipped = "pronation = { per_flexion = 0.3026 }";
  hand.replace(hand.find(shipped), shipped.size(), "pronation = { per_flexion = -0.5 }");
  hand.resize(hand.find("[meshes]"));
  write_file(folder / "coupled.toml", hand);
  const auto shown = run_program(folder, "hand show --hand coupled.toml");
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out,
              ::testing::ContainsRegex("thumb pronation +thumb_cmc_flexion +-0\\.500 +6\\.5 +-31\\.5"));
  const auto none = run_program(folder, "hand show --hand coupled.toml --coupling none");
  ASSERT_EQ(none.exit_code, 0) << none.err;
  EXPECT_THAT(none.out, ::testing::Not(HasSubstr("coupled rotation")));
  ASSERT_EQ(run_program(folder, "hand export --hand coupled.toml --format urdf --out with.urdf").exit_code,
            0);
  ASSERT_EQ(
      run_program(folder, "hand export --hand coupled.toml --coupling none --format urdf --out without.urdf")
          .exit_code,
      0);
  EXPECT_THAT(read_file(folder / "with.urdf"), HasSubstr("<mimic joint=\"thumb_cmc_flexion\""));
  EXPECT_THAT(read_file(folder / "without.urdf"), ::testing::Not(HasSubstr("mimic")));
  EXPECT_EQ(run_program(folder, "hand show --coupling some").exit_code, 2);
}

TEST(CliHand, ExportWritesTheHandAndItsMeshesIntoAFolderWithASpace) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "hand export --profile large-man --format urdf --out 'my hand'");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("my hand/hand.urdf (large man, left hand"));
  EXPECT_THAT(read_file(folder / "my hand/hand.urdf"), HasSubstr("<robot name=\"large man\">"));
  for (int s = 0; s < kSegments; ++s) {
    const std::string name(segment_name(s));
    const auto file = folder.path() / "my hand" / "meshes" / (name + ".obj");
    ASSERT_TRUE(std::filesystem::exists(file)) << name;
    EXPECT_TRUE(is_closed(import_and_check(file).mesh)) << name;
  }
}

TEST(CliHand, ExportToAFileByNameWritesOverAnEarlierOne) {
  const TemporaryFolder folder;
  write_file(folder / "left.xml", "of an earlier run");
  const auto result = run_program(folder, "hand export --side left --format mjcf --out left.xml");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(read_file(folder / "left.xml"), HasSubstr("<mujoco model=\"adult\">"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "meshes" / "wrist.obj"));
}

TEST(CliHand, ExportOfTheSameHandTwiceIsTheSameToTheByte) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_program(folder, "hand export --format mjcf --out a").exit_code, 0);
  ASSERT_EQ(run_program(folder, "hand export --format mjcf --out b").exit_code, 0);
  EXPECT_EQ(read_file(folder / "a/hand.xml"), read_file(folder / "b/hand.xml"));
}

/// A file of two postures in which only the index finger differs.
std::string two_postures(const std::string& second) {
  std::string header = "time_s,posture", open = "1,open", bent = "2," + second;
  for (int j = 0; j < kJoints; ++j) {
    header += "," + std::string(joint_name(j));
    open += ",0";
    bent += j == 4 ? ",60" : ",0";
  }
  return header + "\n" + open + "\n" + bent + "\n";
}

TEST(CliHand, PicturesShowEachPostureAndTheSheet) {
  const TemporaryFolder folder;
  write_file(folder / "two.csv", two_postures("bent"));
  const auto result =
      run_program(folder, "hand pictures two.csv --side left --out drawn --width 64 --columns 2");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "wrote    drawn/NAME.png of 2 postures, and all of them on drawn/postures.png\n");
  for (const char* name : {"drawn/open.png", "drawn/bent.png", "drawn/postures.png"})
    EXPECT_THAT(read_file(folder / name), ::testing::StartsWith("\x89PNG")) << name;
  EXPECT_NE(read_file(folder / "drawn/open.png"), read_file(folder / "drawn/bent.png"));
  ASSERT_EQ(run_program(folder, "hand pictures two.csv --out right --width 64").exit_code, 0);
  EXPECT_NE(read_file(folder / "drawn/open.png"), read_file(folder / "right/open.png"));
}

TEST(CliHand, RefusesInOneLineAndWritesNothing) {
  const TemporaryFolder folder;
  write_file(folder / "wide.toml", "name = \"w\"\nhandedness = \"right\"\nhand_length_mm = 300\n");
  write_file(folder / "taken", "a file");
  const auto refuses = [&](const std::string& arguments, const std::vector<std::string>& words) {
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    for (const std::string& word : words) EXPECT_THAT(result.err, HasSubstr(word)) << arguments;
    EXPECT_FALSE(std::filesystem::exists(folder / "out")) << arguments;
  };
  refuses("hand export --profile wide.toml --format urdf --out out",
          {"wide.toml:3: hand_length_mm = 300", "141.7 to 233 mm", "Gordon"});
  refuses("hand export --profile large-man --side left --format urdf --out out",
          {"the profile says which hand"});
  refuses("hand export --hand nobody --format urdf --out out", {"hand \"nobody\"", "adult"});
  refuses("hand export --format urdf --out out.xml", {"must end in .urdf"});
  refuses("hand export --format urdf --out taken", {"is a file"});
  std::filesystem::create_directories(folder.path() / "is/hand.urdf");
  refuses("hand export --format urdf --out is", {"is/hand.urdf' is a folder"});
  std::filesystem::create_directories(folder.path() / "full");
  write_file(folder / "full/meshes", "in the way");
  write_file(folder / "full/hand.urdf", "of an earlier run");
  refuses("hand export --format urdf --out full", {"full/meshes' is a file"});
  EXPECT_EQ(read_file(folder / "full/hand.urdf"), "of an earlier run") << "nothing was touched";
  refuses("hand export --format sdf --out out", {"--format"});
  refuses("hand export --format urdf", {"--out"});
  refuses("hand export --format urdf --out ''", {"--out \"\": the value is empty"});
  write_file(folder / "sheet.csv", two_postures("postures"));
  refuses("hand pictures sheet.csv --out out", {"posture \"postures\"", "rename it"});
  refuses("hand pictures nobody --out out", {"posture \"nobody\"", "adult"});
  refuses("hand pictures adult", {"--out"});
  refuses("hand pictures adult --out out --width 63", {"--width"});
  refuses("hand shwo", {"did you mean 'show'"});
  refuses("simulate wave --profile smal-woman", {"profile \"smal-woman\"", "did you mean \"small-woman\""});
  refuses("simulate wave --profile large-man --set hand.side=left", {"hand.side", "the profile states this"});
}

TEST(CliHand, SimulateWithAProfileMovesWithinItsRange) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "simulate wave --profile stiff-hand --seconds 2 --out out");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::istringstream ticks(read_file(folder / "out/ticks.csv"));
  std::string line;
  std::getline(ticks, line);
  std::vector<std::string> columns;
  std::istringstream header(line);
  for (std::string cell; std::getline(header, cell, ',');) columns.push_back(cell);
  const auto column =
      std::find(columns.begin(), columns.end(), "index_pip_flexion_hcp_rad") - columns.begin();
  ASSERT_LT(static_cast<std::size_t>(column), columns.size()) << line.substr(0, 400);
  int rows = 0;
  while (std::getline(ticks, line)) {
    std::istringstream row(line);
    std::string cell;
    for (std::ptrdiff_t i = 0; i <= column; ++i) std::getline(row, cell, ',');
    EXPECT_GE(std::stod(cell), 15.0 * std::numbers::pi / 180.0 - 1e-12);
    EXPECT_LE(std::stod(cell), 60.0 * std::numbers::pi / 180.0 + 1e-12);
    ++rows;
  }
  EXPECT_EQ(rows, 400);
}

}  // namespace
}  // namespace phalanx
