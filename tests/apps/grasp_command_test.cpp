// SPDX-License-Identifier: Apache-2.0
// What `phalanx grasp` prints, writes and returns.
#include <gmock/gmock.h>

#include <filesystem>
#include <string>

#include "apps/run_program.h"
#include "phalanx/mesh/import.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::read_file;
using testing::run_program;
using testing::TemporaryFolder;

const char* const kTripod = "grasp --object sphere --type tripod --set objects.0.diameter_mm=50 ";

TEST(CliGrasp, WritesASceneInWhichThePlannedDigitsPress) {
  const TemporaryFolder folder;
  const auto planned = run_program(folder, std::string(kTripod) + "--out ball.toml");
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  EXPECT_THAT(planned.out, AllOf(HasSubstr("tripod grasp"), HasSubstr("wrench ball"),
                                 HasSubstr("thumb-phalanx-distal"), HasSubstr("wrote    ball.toml")));
  const auto checked = run_program(folder, "scene check ball.toml");
  EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
  const auto played = run_program(folder, "simulate ball.toml");
  ASSERT_EQ(played.exit_code, 0) << played.err;
  EXPECT_THAT(played.out,
              AllOf(HasSubstr("thumb distal"), HasSubstr("index distal"), HasSubstr("middle distal")));
}

TEST(CliGrasp, WritesTheSameForTheSameSeed) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_program(folder, std::string(kTripod) + "--quiet --out a.toml").exit_code, 0);
  const auto again = run_program(folder, std::string(kTripod) + "--quiet --out b.toml");
  EXPECT_THAT(again.out, IsEmpty());
  ASSERT_EQ(run_program(folder, std::string(kTripod) + "--seed 2 --quiet --out c.toml").exit_code, 0);
  EXPECT_EQ(read_file(folder / "a.toml"), read_file(folder / "b.toml"));
  EXPECT_NE(read_file(folder / "a.toml"), read_file(folder / "c.toml"));
}

TEST(CliGrasp, TakesAMeshFileAndALeftHand) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "meshes");
  write_obj(make_sphere(0.05, 600), folder / "meshes" / "ball.obj", "ball");
  const auto planned = run_program(folder,
                                   "grasp --object meshes/ball.obj --type pinch --set hand.side=left --set "
                                   "mirror=true --out scenes/left.toml");
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  const auto played = run_program(folder, "simulate scenes/left.toml");
  ASSERT_EQ(played.exit_code, 0) << played.err;
  EXPECT_THAT(played.out, AllOf(HasSubstr("thumb distal"), HasSubstr("index distal")));
}

// The handle of a hook is across the palm: around an upright one the wrist's pitch is 90 degrees.
TEST(CliGrasp, WritesAWristOfAnyOrientation) {
  const TemporaryFolder folder;
  const auto planned = run_program(folder,
                                   "grasp --object cylinder --type hook --set objects.0.diameter_mm=30 --set "
                                   "objects.0.length_mm=140 --out hook.toml");
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  const auto played = run_program(folder, "simulate hook.toml");
  ASSERT_EQ(played.exit_code, 0) << played.err;
  EXPECT_THAT(played.out, AllOf(HasSubstr("index "), HasSubstr("middle ")));
}

TEST(CliGrasp, NamesTheConditionIfThereIsNoGrasp) {
  const TemporaryFolder folder;
  const auto result = run_program(
      folder, "grasp --object sphere --type pinch --set objects.0.diameter_mm=400 --out none.toml");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("sphere: no pinch grasp by adult"),
                                HasSubstr("the digits reach the object"), HasSubstr("smaller")));
  EXPECT_FALSE(std::filesystem::exists(folder / "none.toml"));
}

TEST(CliGrasp, RefusesWhatItDoesNotKnow) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& arguments) {
    const auto result = run_program(folder, "grasp " + arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    return result.err;
  };
  EXPECT_THAT(error("--object spehre --type pinch"), HasSubstr("did you mean \"sphere\""));
  EXPECT_THAT(error("--object sphere --type pinhc"), HasSubstr("did you mean \"pinch\""));
  EXPECT_THAT(error("--object none.obj --type pinch"), HasSubstr("none.obj"));
  EXPECT_THAT(error("--object sphere --type pinch --object-size-mm 40"), HasSubstr("objects.0.diameter_mm"));
  EXPECT_THAT(error("--object sphere --type pinch --profile nobody"), HasSubstr("nobody"));
  EXPECT_THAT(error("--object sphere --type pinch --set motion.name=wave"), HasSubstr("motion.name"));
  EXPECT_THAT(error("--object sphere --type pinch --set hand.position_mm=[0,0,0]"), HasSubstr("wrist"));
  write_obj(make_sphere(80.0, 400), folder / "in_mm.obj", "in_mm");
  EXPECT_THAT(error("--object in_mm.obj --type pinch"), HasSubstr("objects.0.unit=mm"));
  EXPECT_THAT(error("--object in_mm.obj --type pinch --object-size-mm 0"), HasSubstr("--object-size-mm 0"));
  EXPECT_THAT(error("--type pinch"), HasSubstr("--object"));
}

}  // namespace
}  // namespace phalanx
