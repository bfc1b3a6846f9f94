// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/calibration_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "phalanx/device/calibration.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

// Flexion joints of the simple hand go from -0.5 to 2, abduction from -0.6 to 0.6; the open hand is 0.
const HandParameters& hand() {
  static const HandParameters parameters = test::simple_parameters();
  return parameters;
}

const CalibrationPose* find(const std::vector<CalibrationPose>& poses, const std::string& name) {
  const auto found =
      std::find_if(poses.begin(), poses.end(), [&](const CalibrationPose& p) { return p.name == name; });
  return found == poses.end() ? nullptr : &*found;
}

std::vector<DeviceChannel> every_joint() {
  std::vector<DeviceChannel> channels;
  for (int j = 0; j < kJoints; ++j) channels.push_back({.kind = ChannelKind::kAngle, .index = j});
  return channels;
}

TEST(CalibrationPoses, SayWhatIsKnownOfAngles) {
  const auto channels = every_joint();
  const auto poses = calibration_poses(channels, hand());
  const CalibrationPose* open = find(poses, "open hand");
  const CalibrationPose* fist = find(poses, "fist");
  const CalibrationPose* spread = find(poses, "spread");
  ASSERT_TRUE(open && fist && spread);
  for (int j = 0; j < kJoints; ++j) {
    const auto c = static_cast<std::size_t>(j);
    const bool abduction = j % kJointsPerDigit == 1;
    EXPECT_EQ(open->value[c], 0.0);
    EXPECT_EQ(fist->value[c].has_value(), !abduction && digit_of_joint(j) != 0) << joint_name(j);
    EXPECT_EQ(fist->value[c].value_or(2.0), 2.0);
    EXPECT_EQ(spread->value[c].has_value(), abduction && digit_of_joint(j) != 2) << joint_name(j);
    EXPECT_EQ(spread->value[c].value_or(0.6), 0.6);
  }
}

TEST(CalibrationPoses, LeadEveryChannelToBothOfItsEndStops) {
  const auto channels = every_joint();
  const auto poses = calibration_poses(channels, hand());
  EXPECT_EQ(poses.size(), 3U + 2U * kJoints);
  std::set<std::string> names;
  for (const CalibrationPose& pose : poses) {
    EXPECT_FALSE(pose.instruction.empty());
    names.insert(pose.name);
  }
  EXPECT_EQ(names.size(), poses.size()) << "a message must tell which";
  for (std::size_t c = 0; c < channels.size(); ++c) {
    double low = 10.0;
    double high = -10.0;
    for (const CalibrationPose& pose : poses) {
      if (!pose.value[c]) continue;
      low = std::min(low, *pose.value[c]);
      high = std::max(high, *pose.value[c]);
    }
    EXPECT_EQ(low, hand().min_angle[c]);
    EXPECT_EQ(high, hand().max_angle[c]);
  }
}

// The open hand of the simple hand is (0 + 0.5) / 2.5 = 0.2 of a curl, and the middle of a splay.
TEST(CalibrationPoses, SayWhatIsKnownOfCurlsAndSplays) {
  const std::vector<DeviceChannel> channels = {{.kind = ChannelKind::kCurl, .index = 0},
                                               {.kind = ChannelKind::kCurl, .index = 1},
                                               {.kind = ChannelKind::kSplay, .index = 1}};
  const auto poses = calibration_poses(channels, hand());
  EXPECT_EQ(poses.size(), 3U + 6U);
  const CalibrationPose* open = find(poses, "open hand");
  ASSERT_TRUE(open);
  EXPECT_NEAR(*open->value[0], 0.2, 1e-12);
  EXPECT_NEAR(*open->value[2], 0.0, 1e-12);
  const CalibrationPose* fist = find(poses, "fist");
  ASSERT_TRUE(fist);
  EXPECT_FALSE(fist->value[0]) << "where the thumb is in a fist, nobody knows";
  EXPECT_EQ(fist->value[1], 1.0);
  EXPECT_FALSE(fist->value[2]);
}

TEST(CalibrationPoses, LeaveOutWhatNoChannelNeeds) {
  const std::vector<DeviceChannel> thumb = {{.kind = ChannelKind::kAngle, .index = joint_index(0, 2)},
                                            {.kind = ChannelKind::kMotor, .index = 0},
                                            {.kind = ChannelKind::kForce, .index = 0}};
  const auto poses = calibration_poses(thumb, hand());
  ASSERT_EQ(poses.size(), 3U) << "open hand and two end stops";
  for (const CalibrationPose& pose : poses) {
    EXPECT_FALSE(pose.value[1]);
    EXPECT_FALSE(pose.value[2]);
  }
  EXPECT_TRUE(calibration_poses(std::vector<DeviceChannel>{thumb[1]}, hand()).empty());
}

// The flexion of the thumb's CMC joint is no bending of the thumb: it takes the thumb across the palm.
TEST(CalibrationPoses, AskForOppositionAtTheThumbsFirstJoint) {
  const auto poses = calibration_poses(every_joint(), hand());
  const CalibrationPose* largest = find(poses, "thumb_cmc_flexion largest");
  const CalibrationPose* next = find(poses, "thumb_mcp_flexion largest");
  ASSERT_TRUE(largest && next);
  EXPECT_NE(largest->instruction.find("across the palm"), std::string::npos) << largest->instruction;
  EXPECT_EQ(next->instruction, "On the jig: the middle joint of the thumb bent, at the angle that is shown.");
}

// What a patient can reach is not assumed: no angle is known before a person enters it.
TEST(CalibrationPoses, OfAGoniometerKnowNoAngle) {
  const auto channels = every_joint();
  const auto poses = calibration_poses(channels, hand(), {.method = CalibrationMethod::kGoniometer});
  EXPECT_EQ(poses.size(), 3U * kJoints);
  for (const CalibrationPose& pose : poses) {
    EXPECT_EQ(std::count(pose.concerns.begin(), pose.concerns.end(), true), 1) << pose.name;
    for (const auto& value : pose.value) EXPECT_FALSE(value) << pose.name;
  }
}

TEST(CalibrationPoses, OfStopsAreThoseThatTheDeviceStates) {
  const auto channels = every_joint();
  const int pip = joint_index(1, 2);
  const auto poses = calibration_poses(
      channels, hand(),
      {.method = CalibrationMethod::kStops, .stops = {{.joint = pip, .min = -0.1, .max = 1.7}}});
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].value[static_cast<std::size_t>(pip)], 1.7);
  EXPECT_EQ(poses[1].value[static_cast<std::size_t>(pip)], -0.1);
  EXPECT_NE(poses[0].instruction.find("No hand in the device"), std::string::npos);
}

TEST(CalibrationPoses, AreOfTheChosenJointsOnly) {
  const auto channels = every_joint();
  const int pip = joint_index(1, 2);
  const auto poses = calibration_poses(channels, hand(), {.joints = {pip}});
  EXPECT_EQ(poses.size(), 4U) << "open hand, fist and two of the joint";
  for (const CalibrationPose& pose : poses)
    for (std::size_t c = 0; c < channels.size(); ++c)
      EXPECT_EQ(pose.value[c].has_value(), channels[c].index == pip) << pose.name;
}

// Counts that a device with these gains would send at the poses give the gains back.
TEST(CalibrationPoses, AreEnoughForAFitOfEveryChannel) {
  auto channels = every_joint();
  for (DeviceChannel& c : channels) c.raw_max = 4095;
  HandParameters possible = hand();
  possible.min_angle.fill(-0.2);
  possible.max_angle.fill(0.4);
  const auto poses = calibration_poses(channels, possible);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    std::vector<PoseReading> readings;
    for (const CalibrationPose& pose : poses)
      if (pose.value[c])
        readings.push_back(
            {.pose = pose.name, .value = *pose.value[c], .raw = 2000.0 - 500.0 * *pose.value[c]});
    const ChannelFit fit = fit_channel(channels[c], readings, possible);
    EXPECT_NEAR(fit.gain, -1.0 / 500.0, 1e-12);
    EXPECT_NEAR(fit.offset, 4.0, 1e-9);
  }
}

}  // namespace
}  // namespace phalanx
