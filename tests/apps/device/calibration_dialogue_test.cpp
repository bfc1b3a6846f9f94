// SPDX-License-Identifier: Apache-2.0
// The calibration's dialogue with a scripted wearer and a device that reads what the wearer does.
#include "device/calibration_dialogue.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "device/calibration/held_device.h"
#include "phalanx/core/constants.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

using test::HeldDevice;
using test::kGain;
using test::kOffset;
using ::testing::HasSubstr;

/// Goes into the pose that it is told, and answers as the script says, by the pose's name; else Enter.
class Wearer final : public CalibrationConsole {
 public:
  explicit Wearer(HeldDevice& device)
      : device_(device), poses_(calibration_poses(device.info().channels, test::simple_parameters())) {}

  void say(const std::string& line) override {
    said += line + "\n";
    for (const auto& [name, angle] : held) {
      if (line.find(fmt::format("] {}:", name)) == std::string::npos) continue;
      device_.held[1] = static_cast<std::int32_t>(std::lround((angle - kOffset[1]) / kGain[1]));
    }
    for (const auto& [name, answer] : script)
      if (line.find(fmt::format("] {}:", name)) != std::string::npos) pose_ = name;
    for (const CalibrationPose& pose : poses_) {
      if (line.find(fmt::format("] {}:", pose.name)) == std::string::npos) continue;
      pose_ = pose.name;
      device_.hold(pose);
      if (pose.name == cheats_in && cheats-- > 0) device_.held[1] += 400;
    }
  }
  std::optional<std::string> answer(const std::function<std::string()>& live) override {
    lived += live();
    if (ends_after-- == 0) return "q";
    if (said.ends_with("to give up.\n")) return at_the_end;
    return script.contains(pose_) ? script[pose_] : std::string();
  }

  std::map<std::string, std::optional<std::string>> script;
  std::string at_the_end;
  std::map<std::string, double>
      held;               ///< the angle of index_pip_flexion that is held, by the pose's name [rad]
  int ends_after = -1;    ///< answers until it ends; -1: never
  std::string cheats_in;  ///< the pose in which another angle is held, so many times
  int cheats = 1;
  std::string said;
  std::string lived;

 private:
  HeldDevice& device_;
  std::vector<CalibrationPose> poses_;
  std::string pose_;
};

struct Scene {
  Calibration run() {
    return calibrate_by_poses(device, clock, hand, wearer,
                              {.measure_for = 0.01, .limits = {}, .plan = plan, .earlier = earlier});
  }
  std::string refusal() {
    try {
      static_cast<void>(run());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  CalibrationPlan plan = {};
  std::optional<Calibration> earlier = {};
  Clock clock;
  HandParameters hand = test::simple_parameters();
  HeldDevice device;
  Wearer wearer{device};
};

TEST(CalibrationDialogue, FindsTheGainsOfEveryChannelAndCommandsNothing) {
  Scene scene;
  const Calibration found = scene.run();
  EXPECT_EQ(found.device, "held");
  EXPECT_EQ(found.serial, "0042");
  ASSERT_EQ(found.channels.size(), 2U) << "a motor has no pose";
  for (std::size_t c = 0; c < 2; ++c) {
    // A count of rounding over a span of 2000 counts or more.
    EXPECT_NEAR(found.channels[c].channel.gain, kGain[c], 2e-3 * std::abs(kGain[c]));
    EXPECT_NEAR(found.channels[c].channel.offset, kOffset[c], 5e-3);
    EXPECT_EQ(found.channels[c].poses.size(), 4U) << "open hand, fist, two end stops";
  }
  EXPECT_EQ(scene.device.commands, 0) << "torque must never be enabled";
  EXPECT_THAT(scene.wearer.said, HasSubstr("angle of index_pip_flexion"));
  EXPECT_THAT(scene.wearer.said, HasSubstr("On the jig: the fist"));
  EXPECT_THAT(scene.wearer.lived, HasSubstr("raw"));
}

TEST(CalibrationDialogue, RefusesAPoseThatWasNotTheOneAsked) {
  Scene scene;
  scene.wearer.cheats_in = "fist";
  EXPECT_THAT(scene.refusal(), HasSubstr("nothing was written"));
  EXPECT_THAT(scene.wearer.said, HasSubstr("refused: angle of index_pip_flexion"));
}

TEST(CalibrationDialogue, MeasuresAPoseAgainThatWasRefused) {
  Scene scene;
  scene.wearer.cheats_in = "fist";
  scene.wearer.at_the_end = std::string("2");
  EXPECT_NEAR(scene.run().channels[1].channel.gain, kGain[1], 2e-3 * kGain[1]);
}

TEST(CalibrationDialogue, SkipsAPose) {
  Scene scene;
  scene.wearer.script["fist"] = std::string("s");
  const Calibration found = scene.run();
  EXPECT_EQ(found.channels[0].poses.size(), 3U);
}

// Of the finger's two angles only one is calibrated; the other one keeps what an earlier calibration found.
TEST(CalibrationDialogue, TakesTheAnglesOfAGoniometer) {
  Scene first;
  Calibration before = first.run();
  before.date = "2026-05-04T09:30:00Z";
  Scene scene;
  scene.plan = {.method = CalibrationMethod::kGoniometer, .joints = {joint_index(1, 2)}};
  scene.earlier = before;
  scene.wearer.script["index_pip_flexion first"] = std::string("10");
  scene.wearer.script["index_pip_flexion second"] = std::string("index_pip_flexion=40");
  scene.wearer.script["index_pip_flexion third"] = std::string("s");
  scene.wearer.held = {{"index_pip_flexion first", 10.0 * kDeg}, {"index_pip_flexion second", 40.0 * kDeg}};
  const Calibration found = scene.run();
  ASSERT_EQ(found.channels.size(), 2U);
  EXPECT_EQ(found.channels[0].channel.gain, before.channels[0].channel.gain);
  EXPECT_EQ(found.channels[0].date, before.date);
  EXPECT_EQ(found.channels[0].method, CalibrationMethod::kJig);
  EXPECT_NEAR(found.channels[1].channel.gain, kGain[1], 1e-2 * kGain[1]);
  EXPECT_NEAR(found.channels[1].channel.offset, kOffset[1], 2e-2);
  EXPECT_EQ(found.channels[1].method, CalibrationMethod::kGoniometer);
}

TEST(CalibrationDialogue, SaysWhichAngleIsMissingOrNoAngle) {
  for (const auto& [typed, reason] : {std::pair{"", "the angle of index_pip_flexion is not entered"},
                                      {"far", "'far' is no angle"},
                                      {"400", "400.0 deg is beyond what a hand can do"},
                                      {"nose=3", "'nose=3' is no angle"}}) {
    Scene scene;
    scene.plan = {.method = CalibrationMethod::kGoniometer, .joints = {joint_index(1, 2)}};
    scene.wearer.script["index_pip_flexion first"] = std::string(typed);
    scene.wearer.ends_after = 5;
    EXPECT_THAT(scene.refusal(), HasSubstr("nothing was written"));
    EXPECT_THAT(scene.wearer.said, HasSubstr(reason));
  }
}

TEST(CalibrationDialogue, EndsWithoutAResultWhenItIsTold) {
  Scene scene;
  scene.wearer.script["fist"] = std::string("q");
  EXPECT_THAT(scene.refusal(), HasSubstr("nothing was written"));
  Scene ended;
  ended.wearer.script["open hand"] = std::nullopt;
  EXPECT_THAT(ended.refusal(), HasSubstr("nothing was written"));
}

TEST(CalibrationDialogue, SaysThatTheDeviceIsSilentOrLost) {
  Scene silent;
  silent.device.silent = true;
  EXPECT_THAT(silent.refusal(), HasSubstr("no sample"));
  Scene lost;
  lost.device.fault = Fault::kDeviceLost;
  EXPECT_THAT(lost.refusal(), HasSubstr(std::string(fault_meaning(Fault::kDeviceLost))));
}

}  // namespace
}  // namespace phalanx
