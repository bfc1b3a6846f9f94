// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/motion_file.h"

#include <fmt/format.h>
#include <rapidcheck.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include "phalanx/scene/mapping_file.h"
#include "scene/expect_error.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPip = 6;  // index_pip_flexion

Motion parse_csv(const std::string& text, std::optional<int> trial = {}) {
  return parse_motion(text, "m.csv", {}, trial);
}

void expect_motion_refused(const std::string& text, const std::vector<std::string>& words,
                           std::optional<int> trial = {}) {
  SCOPED_TRACE(text.substr(0, 200));
  expect_scene_error([&] { static_cast<void>(parse_csv(text, trial)); }, words);
}

SensorMapping pip_from(const std::string& source) {
  SensorMapping mapping;
  mapping.name = "test";
  mapping.joints.resize(1);
  mapping.joints[0].joint = static_cast<int>(kPip);
  mapping.joints[0].source = source;
  mapping.joints[0].sign = -1.0;
  return mapping;
}

TEST(MotionFile, MayNameAnyJointsInAnyOrder) {
  const Motion motion = parse_csv("index_pip_flexion,time_s,thumb_ip_flexion\n0.5,1.0,0.1\n0.7,1.5,0.2\n");
  EXPECT_EQ(motion.time_s, (std::vector<double>{1.0, 1.5}));
  EXPECT_EQ(motion.angle[1][kPip], 0.7);
  EXPECT_EQ(motion.angle[1][3], 0.2);
}

TEST(MotionFile, SkipsCommentsAndCountsTheirLines) {
  const Motion motion = parse_csv("# recorded\ntime_s,index_pip_flexion\n0,1\n#0,3\n1,2\n");
  EXPECT_EQ(motion.time_s, (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(motion.angle[1][kPip], 2.0);
  expect_motion_refused("# recorded\ntime_s,index_pip_flexion\n0,x\n", {"m.csv:3"});
}

TEST(MotionFile, LeavesJointsWithoutAColumnAtTheOpenHand) {
  JointArray open{};
  open.fill(0.25);
  const Motion motion = parse_motion("time_s,index_pip_flexion\n0,1\n", "m.csv", {}, {}, open);
  EXPECT_EQ(motion.angle[0][0], 0.25);
  EXPECT_EQ(motion.angle[0][kPip], 1.0);
}

/// The PIP joint from column "a" with its sign, and the DIP joint at half the PIP's angle plus 0.1.
SensorMapping pip_and_dip() {
  SensorMapping mapping = pip_from("a");
  mapping.joints.insert(mapping.joints.begin(), {.joint = static_cast<int>(kPip) + 1,
                                                 .gain = 0.5,
                                                 .offset = 0.1,
                                                 .clamp_min = 0.0,
                                                 .clamp_max = 0.45,
                                                 .clamped = true,
                                                 .completed_from = static_cast<int>(kPip)});
  return mapping;
}

// 0.5 * 0.6 + 0.1 = 0.4; 0.5 * 1.0 + 0.1 = 0.6, which is clamped to 0.45. The completed joint is stated first.
TEST(MotionFile, CompletesAJointFromTheMappedAngleOfAnother) {
  const Motion motion = parse_motion("time_s,a\n0,-0.6\n1,-1\n", "m.csv", pip_and_dip());
  EXPECT_DOUBLE_EQ(motion.angle[0][kPip], 0.6);
  EXPECT_DOUBLE_EQ(motion.angle[0][kPip + 1], 0.4);
  EXPECT_DOUBLE_EQ(motion.angle[1][kPip + 1], 0.45);
}

TEST(MotionFile, StatesTheOriginOfEachAngle) {
  const Motion mapped = parse_motion("time_s,a\n0,-0.6\n", "m.csv", pip_and_dip());
  const Motion plain = parse_csv("time_s,index_pip_flexion,index_dip_flexion\n0,0.6,0.4\n");
  for (std::size_t j = 0; j < kJoints; ++j) {
    const AngleOrigin other = j == kPip ? AngleOrigin::kMeasured : AngleOrigin::kFixed;
    EXPECT_EQ(mapped.angle_origin[j], j == kPip + 1 ? AngleOrigin::kCompleted : other) << j;
    EXPECT_EQ(plain.angle_origin[j], j == kPip + 1 ? AngleOrigin::kMeasured : other) << j;
  }
  SensorMapping computed = pip_from("a");
  computed.joints[0].computed = true;
  EXPECT_EQ(parse_motion("time_s,a\n0,-0.6\n", "m.csv", computed).angle_origin[kPip],
            AngleOrigin::kCompleted);
  EXPECT_EQ(led_in(mapped, JointArray{}, 0.5).angle_origin, mapped.angle_origin);
}

TEST(MotionFile, RefusesACompletedAngleOfMoreThanAFullTurn) {
  SensorMapping mapping = pip_and_dip();
  mapping.joints[0].clamped = false;
  mapping.joints[0].gain = 20.0;
  expect_scene_error([&] { static_cast<void>(parse_motion("time_s,a\n0,-0.1\n1,-0.5\n", "m.csv", mapping)); },
                     {"m.csv:3", "index_pip_flexion = 0.5 rad", "index_dip_flexion = 10.1 rad", "full turn"});
}

TEST(MotionFile, MayComeFromAnySpreadsheet) {
  const Motion motion =
      parse_csv("\xEF\xBB\xBF\"time_s\" , \"index_pip_flexion\"\r\n 0 , +1e-1 \r\n\r\n1,.5\r\n");
  EXPECT_EQ(motion.angle[0][kPip], 0.1);
  EXPECT_EQ(motion.angle[1][kPip], 0.5);
}

TEST(MotionFile, GoesThroughItsMapping) {
  const Motion motion = parse_motion("time_s,other,pip\n0,9,-0.5\n1,9,-0.75\n", "m.csv", pip_from("pip"));
  EXPECT_EQ(motion.angle[1][kPip], 0.75);
}

TEST(MotionFile, WithoutTheColumnThatTheMappingNeeds) {
  expect_scene_error(
      [] { static_cast<void>(parse_motion("time_s,index_pipp\n0,1\n", "m.csv", pip_from("index_pip"))); },
      {"m.csv:1", "\"index_pip\"", "index_pip_flexion", "nearest column is \"index_pipp\""});
}

TEST(MotionFile, WithoutTime) {
  expect_motion_refused("time,index_pip_flexion\n0,1\n", {"m.csv:1", "column \"time_s\" is missing"});
  expect_motion_refused("time_s;index_pip_flexion\n0;1\n", {"\"time_s\" is missing", "separated by commas"});
}

TEST(MotionFile, WithoutAnyJoint) {
  expect_motion_refused("time_s\n0\n", {"m.csv:1", "no column is a joint"});
}

TEST(MotionFile, WithAnUnknownColumn) {
  expect_motion_refused(
      "time_s,index_pip_flection\n0,1\n",
      {"m.csv:1", "\"index_pip_flection\"", "did you mean \"index_pip_flexion\"?", "mapping"});
}

TEST(MotionFile, WithAColumnTwice) {
  expect_motion_refused("time_s,index_pip_flexion,index_pip_flexion\n0,1,1\n",
                        {"m.csv:1", "\"index_pip_flexion\" appears twice"});
}

TEST(MotionFile, WithTextInANumber) {
  expect_motion_refused("time_s,index_pip_flexion\n0,1\n1,bent\n",
                        {"m.csv:3", "column \"index_pip_flexion\"", "\"bent\" is not a number"});
  expect_motion_refused("time_s,index_pip_flexion\n0,1x\n", {"m.csv:2", "\"1x\" is not a number"});
  expect_motion_refused("time_s,index_pip_flexion\n0,\n", {"m.csv:2", "\"\" is not a number"});
}

TEST(MotionFile, WithNanOrInfinity) {
  expect_motion_refused("time_s,index_pip_flexion\n0,nan\n",
                        {"m.csv:2", "column \"index_pip_flexion\"", "nan", "not a finite number"});
  expect_motion_refused("time_s,index_pip_flexion\n0,-inf\n", {"m.csv:2", "not a finite number"});
  expect_motion_refused("time_s,index_pip_flexion\nnan,0\n",
                        {"m.csv:2", "column \"time_s\"", "not a finite number"});
  expect_motion_refused("time_s,index_pip_flexion\n0,1e999\n", {"m.csv:2", "1e999"});
}

TEST(MotionFile, InDegrees) {
  expect_motion_refused("time_s,index_pip_flexion\n0,45\n",
                        {"m.csv:2", "index_pip_flexion = 45 rad", "in degrees", "gain = 0.01745"});
}

TEST(MotionFile, WithARaggedRow) {
  expect_motion_refused("time_s,index_pip_flexion\n0,1\n1\n", {"m.csv:3", "1 cells, the header 2"});
  expect_motion_refused("time_s,index_pip_flexion\n0,1,2\n", {"m.csv:2", "3 cells, the header 2"});
}

TEST(MotionFile, ThatIsEmpty) {
  expect_motion_refused("", {"m.csv", "the file is empty"});
  expect_motion_refused("\n \n", {"the file is empty"});
  expect_motion_refused("time_s,index_pip_flexion\n", {"header but no rows"});
}

TEST(MotionFile, ThatIsMissing) {
  expect_scene_error([] { static_cast<void>(load_motion("/nowhere/m.csv")); },
                     {"/nowhere/m.csv", "there is no file"});
}

TEST(MotionFile, WithATimeTwice) {
  expect_motion_refused("time_s,index_pip_flexion\n0,1\n0,2\n",
                        {"m.csv:3", "column \"time_s\"", "0 s appears twice"});
}

TEST(MotionFile, WithAHugeLine) {
  expect_motion_refused("time_s,index_pip_flexion\n0," + std::string(70'000, '1') + "\n",
                        {"m.csv:2", "more than 65536"});
  expect_motion_refused(std::string(70'000, 'x'), {"m.csv:1", "more than 65536"});
}

TEST(MotionFile, WithACellThatIsShownInFortyPrintableCharacters) {
  const auto expect_shown = [](const std::string& cell, const std::string& shown) {
    expect_motion_refused("time_s,index_pip_flexion\n0," + cell + "\n",
                          {": \"" + shown + "\" is not a number"});
  };
  expect_shown(std::string(40, 'x'), std::string(40, 'x'));
  expect_shown(std::string(41, 'x'), std::string(40, 'x') + "...");
  expect_shown("be\x1F nt\x7F~", "be? nt?~");
  expect_shown("\"\"", "");
  expect_shown("\"", "\"");
}

// 2 pi in binary, and the next number.
TEST(MotionFile, MayTurnAJointByAFullTurnAndNoFurther) {
  EXPECT_EQ(parse_csv("time_s,index_pip_flexion\n0,6.283185307179586\n").angle[0][kPip],
            2.0 * std::numbers::pi);
  for (const char* angle : {"6.283185307179587", "-6.283185307179587"})
    expect_motion_refused("time_s,index_pip_flexion\n0," + std::string(angle) + "\n",
                          {"m.csv:2", "more than a full turn"});
}

// The first trial has a time twice.
TEST(MotionFile, IsReadThoughAnotherTrialThanTheChosenOneIsBroken) {
  const std::string text = "time_s,index_pip_flexion\n0,0.1\n0,0.2\n-1,0.3\n";
  EXPECT_EQ(parse_csv(text, 2).time_s, (std::vector<double>{-1.0}));
  expect_motion_refused(text, {"m.csv:3", "appears twice"}, 1);
}

constexpr const char* kThreeTrials = "time_s,index_pip_flexion\n4,0.1\n5,0.2\n4.5,0.3\n5,0.4\n6,0.5\n0,0.6\n";

TEST(MotionFile, WhoseTimeRunsBackwardsNamesItsTrials) {
  expect_motion_refused(kThreeTrials,
                        {"m.csv:4", "column \"time_s\"", "from 5 s to 4.5 s", "3 trials", "--trial N"});
}

TEST(MotionFile, PlaysTheTrialThatIsChosen) {
  EXPECT_EQ(parse_csv(kThreeTrials, 1).time_s, (std::vector<double>{4.0, 5.0}));
  EXPECT_EQ(parse_csv(kThreeTrials, 2).time_s, (std::vector<double>{4.5, 5.0, 6.0}));
  EXPECT_EQ(parse_csv(kThreeTrials, 2).angle[2][kPip], 0.5);
  EXPECT_EQ(parse_csv(kThreeTrials, 3).time_s, (std::vector<double>{0.0}));
}

TEST(MotionFile, HasNoTrialBeyondItsLast) {
  expect_motion_refused(kThreeTrials, {"no trial 4", "holds 3"}, 4);
  expect_motion_refused(kThreeTrials, {"trial 0", "counted from 1"}, 0);
}

/// `time_s` and all 20 joints, with as many digits as the numbers need.
std::string written(const Motion& motion) {
  std::string text = "time_s";
  for (int joint = 0; joint < kJoints; ++joint) text += fmt::format(",{}", joint_name(joint));
  text += '\n';
  for (std::size_t i = 0; i < motion.time_s.size(); ++i)
    text += fmt::format("{},{}\n", motion.time_s[i], fmt::join(motion.angle[i], ","));
  return text;
}

TEST(MotionFile, ReadsBackWhatWasWrittenBitForBit) {
  const auto file = fs::temp_directory_path() / ("phalanx_motion_" + std::to_string(getpid()) + ".csv");
  EXPECT_TRUE(rc::check([&](std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1.0p-53; };
    Motion motion;
    double time = 100.0 * uniform();
    for (int k = 0; k < 20; ++k) {
      motion.time_s.push_back(time += 1e-3 + uniform());
      motion.angle.emplace_back();
      for (double& angle : motion.angle.back()) angle = 6.0 * uniform() - 3.0;
    }
    std::ofstream(file, std::ios::binary) << written(motion);
    const Motion back = load_motion(file);
    RC_ASSERT(back.time_s == motion.time_s);
    RC_ASSERT(back.angle == motion.angle);
  }));
  fs::remove(file);
}

// A recording of the project's own: a hand that opens and closes, in the glove's columns and signs.
TEST(MotionFile, PlaysAGlovesRecordingThroughItsMapping) {
  const auto folder = fs::path(PHALANX_SOURCE_DIR) / "assets/motions";
  const SensorMapping mapping = load_mapping_file("cyberglove");
  expect_scene_error([&] { static_cast<void>(load_motion(folder / "glove_two_trials.csv", mapping)); },
                     {"2 trials", "--trial N"});
  const Motion motion = load_motion(folder / "glove_two_trials.csv", mapping, 2);
  EXPECT_NO_THROW(check_motion(motion));
  EXPECT_GT(motion.duration(), 1.0);
  EXPECT_NEAR(motion.at(0.0)[kPip], 0.1, 0.15);
  EXPECT_GT(motion.at(0.5 * motion.duration())[kPip], 0.9);
}

// The same recording with the DIP joints completed: 2/3 of the PIP joints, which are clamped to 100 degrees.
TEST(MotionFile, PlaysAGlovesRecordingWithCompletedJoints) {
  const auto file = fs::path(PHALANX_SOURCE_DIR) / "assets/motions/glove_two_trials.csv";
  const Motion plain = load_motion(file, load_mapping_file("cyberglove"), 1);
  const Motion motion = load_motion(file, load_mapping_file("cyberglove-completed"), 1);
  ASSERT_EQ(motion.angle.size(), plain.angle.size());
  for (std::size_t i = 0; i < motion.angle.size(); ++i) {
    for (std::size_t j = 0; j < kJoints; ++j) {
      const bool dip = j > 3 && j % kJointsPerDigit == 3;
      EXPECT_NEAR(motion.angle[i][j], dip ? 2.0 / 3.0 * plain.angle[i][j - 1] : plain.angle[i][j], 1e-15);
      EXPECT_EQ(motion.angle_origin[j], dip ? AngleOrigin::kCompleted : AngleOrigin::kMeasured);
    }
  }
}

}  // namespace
}  // namespace phalanx
