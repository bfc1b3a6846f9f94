// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/posture_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/scene/mapping_file.h"
#include "phalanx/scene/motion_file.h"
#include "scene/expect_error.h"

namespace phalanx {
namespace {

/// A header with all joints, and the rows: each a name and the angle of the first joint [deg].
std::string postures_csv(const std::string& rows, const std::string& columns = "time_s,posture") {
  std::string text = "# made for a test\n" + columns;
  for (int j = 0; j < kJoints; ++j) text += "," + std::string(joint_name(j));
  return text + "\n" + rows;
}

std::string zeros() {
  std::string text;
  for (int j = 1; j < kJoints; ++j) text += ",0";
  return text + "\n";
}

void expect_postures_refused(const std::string& text, const std::vector<std::string>& words) {
  expect_scene_error([&] { static_cast<void>(parse_postures(text, "p.csv")); }, words);
}

TEST(PostureFile, HasNamesAndAnglesInDegrees) {
  const auto postures = parse_postures(
      postures_csv("1,flat-hand,0" + zeros() + "# between\n\n2,thumb_1,30" + zeros()), "p.csv");
  ASSERT_EQ(postures.size(), 2U);
  EXPECT_EQ(postures[0].name, "flat-hand");
  EXPECT_EQ(postures[1].name, "thumb_1");
  EXPECT_NEAR(postures[1].angle[0], 30.0 * kDeg, 1e-15);
  EXPECT_EQ(postures[1].angle[1], 0.0);
}

TEST(PostureFile, RefusesNamesThatAreNoFileNames) {
  const std::vector<std::string> names = {"", "two words", "../up", "Fist", std::string(65, 'a')};
  for (const std::string& name : names)
    expect_postures_refused(postures_csv("1," + name + ",0" + zeros()),
                            {"p.csv:3", "posture", "small letters"});
  expect_postures_refused(postures_csv("1,a,0" + zeros() + "2,a,0" + zeros()),
                          {"p.csv:4", "posture \"a\" appears twice"});
  expect_postures_refused(postures_csv("1,0" + zeros(), "time_s"), {"p.csv:2", "\"posture\" is missing"});
  expect_postures_refused("time_s,posture,index_pip_flexion\n1,a,0\n", {"thumb_cmc_flexion", "is missing"});
}

TEST(PostureFile, RefusesNumbersInItsOwnWords) {
  expect_postures_refused("", {"\"posture\" is missing", "time_s"});
  expect_postures_refused(postures_csv("2,a,0" + zeros() + "1,b,0" + zeros()),
                          {"p.csv:4", "time_s = 1 does not increase"});
  expect_postures_refused(postures_csv("1,a,400" + zeros()),
                          {"p.csv:3", "thumb_cmc_flexion = 400", "full turn"});
}

TEST(PostureFile, IsFoundByNameAndNamesTheNearest) {
  EXPECT_FALSE(load_postures("adult").empty());
  expect_scene_error([] { static_cast<void>(load_postures("adul")); },
                     {"posture \"adul\"", "did you mean \"adult\"?"});
}

// A scene plays the shipped files.
TEST(PostureFile, IsAMotionWithTheMappingDegrees) {
  for (const std::string name : {"adult", "small-woman", "large-man"}) {
    const auto postures = load_postures(name);
    const Motion motion =
        load_motion(std::filesystem::path(PHALANX_SOURCE_DIR) / "assets/postures" / (name + ".csv"),
                    load_mapping_file("degrees"));
    ASSERT_EQ(motion.angle.size(), postures.size()) << name;
    for (std::size_t i = 0; i < postures.size(); ++i) EXPECT_EQ(motion.angle[i], postures[i].angle) << i;
  }
}

}  // namespace
}  // namespace phalanx
