// SPDX-License-Identifier: Apache-2.0
// Bad input, one test each: exit code 2, one line that names the place, the value and the remedy, and no
// output left behind.
#include <gmock/gmock.h>

#include <vector>

#include "apps/run_program.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::run_program;
using testing::TemporaryFolder;
using testing::write_file;

class CliBadInput : public ::testing::Test {
 protected:
  void refuses(const std::string& arguments, const std::vector<std::string>& words) {
    const auto result = run_program(folder, "simulate " + arguments + " --out out");
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_THAT(result.err, ::testing::StartsWith("phalanx: "));
    for (const std::string& word : words) EXPECT_THAT(result.err, HasSubstr(word));
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  }
  TemporaryFolder folder;
};

TEST_F(CliBadInput, MissingMeshFile) { refuses("--object nope.obj --object-size-mm 80", {"nope.obj"}); }

TEST_F(CliBadInput, MissingMotionFile) { refuses("--motion nope.csv", {"nope.csv"}); }

TEST_F(CliBadInput, EmptyMesh) {
  write_file(folder / "empty.obj", "o empty\n");
  refuses("--object empty.obj --object-size-mm 80", {"empty.obj"});
}

TEST_F(CliBadInput, BadIndex) {
  write_file(folder / "bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  refuses("--object bad.obj --object-size-mm 80", {"bad.obj"});
}

TEST_F(CliBadInput, NanVertex) {
  write_file(folder / "nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
  refuses("--object nan.obj --object-size-mm 80", {"nan.obj"});
}

TEST_F(CliBadInput, UnknownSceneKeyIsAnsweredWithTheNearest) {
  refuses("--set force.stifness_n_per_mm=1", {"force.stifness_n_per_mm", "force.stiffness_n_per_mm"});
  write_file(folder / "scene.toml", "rate_hertz = 200\n");
  refuses("./scene.toml", {"scene.toml", "rate_hertz", "rate_hz"});
}

TEST_F(CliBadInput, NegativeStiffness) {
  refuses("--set force.stiffness_n_per_mm=-1", {"force.stiffness_n_per_mm", "-1", ">= 0"});
}

TEST_F(CliBadInput, NanAngle) {
  write_file(folder / "m.csv", "time_s,index_mcp_flexion\n0,0\n0.1,nan\n");
  refuses("--motion m.csv", {"m.csv", "3", "index_mcp_flexion"});
}

TEST_F(CliBadInput, TimeRunningBackwardsSaysHowManyTrialsThereAre) {
  write_file(folder / "m.csv", "time_s,index_mcp_flexion\n0,0\n0.1,0.1\n0.05,0.2\n0.2,0.1\n");
  refuses("--motion m.csv", {"m.csv", "--trial"});
}

TEST_F(CliBadInput, RateZero) { refuses("--rate-hz 0", {"rate_hz", "0"}); }

TEST_F(CliBadInput, NegativeSeconds) { refuses("--seconds -1", {"seconds", "-1"}); }

TEST_F(CliBadInput, UnknownMappingIsAnsweredWithTheNearest) {
  write_file(folder / "m.csv", "time_s,index_mcp_flexion\n0,0\n0.1,0.1\n");
  refuses("--motion m.csv --mapping cyberglov", {"cyberglov", "cyberglove"});
}

TEST_F(CliBadInput, OutputFolderThatIsAFile) {
  write_file(folder / "taken", "");
  const auto result = run_program(folder, "simulate wave --out taken");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("taken"), HasSubstr("is a file")));
}

TEST_F(CliBadInput, FoldersAndDevicesAreCalledWhatTheyAre) {
  std::filesystem::create_directory(folder / "d");
  refuses("--motion d", {"motion file", "d is a folder"});
  refuses("./d", {"d is a folder"});
  refuses("--object d", {"object file", "d is a folder"});
  refuses("/dev/null", {"/dev/null is not a regular file"});
  refuses("--motion /dev/null", {"/dev/null is not a regular file"});
}

TEST_F(CliBadInput, NameThatIsNoUtf8) { refuses("--motion '\xff.csv'", {"--motion", "not valid UTF-8"}); }

TEST_F(CliBadInput, PictureOrPlotInAFolderThatCannotBeWritten) {
  write_file(folder / "taken", "");
  refuses("--picture taken/x.png", {"output folder 'taken' is a file"});
  refuses("--plot taken/x.svg", {"output folder 'taken' is a file"});
  if (!std::filesystem::exists("/proc/self")) return;
  refuses("--picture /proc/x.png", {"/proc"});  // not even root can
  refuses("--plot /proc/x.svg", {"/proc"});
}

}  // namespace
}  // namespace phalanx
