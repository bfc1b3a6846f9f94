// SPDX-License-Identifier: Apache-2.0
// A patient's range, measured on a hand that reaches 40 degrees of PIP.
#include "phalanx/device/range_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "device/calibration/held_device.h"
#include "device/calibration/reaching_hand.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using Angles = std::array<double, kJointsPerDigit>;

constexpr Angles kStraight = {-5.0 * kDeg, 0.0, 2.0 * kDeg, 0.0};
constexpr Angles kBent = {60.0 * kDeg, 4.0 * kDeg, 100.0 * kDeg, 30.0 * kDeg};  // as far as it goes
constexpr double kReach = 40.0 * kDeg;

class RangeSessionTest : public ::testing::Test {
 protected:
  void pass(double seconds) {
    for (int i = 0; i < static_cast<int>(1000.0 * seconds); ++i) session.update(now += 1e-3);
  }
  void move_to(const Angles& angles, double hold = 1.0) {
    hand.intend(angles);
    pass(2.0 + hold);
  }
  [[nodiscard]] AngleRange reached(int joint) const { return *session.view().joints[idx(joint)].reached; }
  std::string refusal_of_accept() {
    try {
      session.accept();
    } catch (const CalibrationError& error) {
      return error.what();
    }
    return "";
  }

  test::ReachingHand hand{kReach};
  RangeSession session{hand, hand.info().channels, test::simple_parameters()};
  double now = 0.0;
};

TEST_F(RangeSessionTest, AHandThatReaches40DegreesIsMeasuredWithin3Degrees) {
  session.measure(now);
  move_to(kStraight);
  move_to(kBent);
  EXPECT_NEAR(reached(2).max, kReach, 3.0 * kDeg);
  EXPECT_NEAR(reached(2).min, 2.0 * kDeg, 3.0 * kDeg);
  EXPECT_NEAR(reached(0).max, 60.0 * kDeg, 3.0 * kDeg);
  EXPECT_LE(reached(2).max, kReach + 0.5 * kDeg) << "an angle that was not reached must not count";
  EXPECT_EQ(session.view().joints[2].limit.max, test::simple_parameters().max_angle[idx(joint_index(1, 2))]);
  session.accept();
  ASSERT_TRUE(session.at_end());
  ASSERT_TRUE(session.range());
  const MeasuredRange range = *session.range();
  EXPECT_EQ(range.serial, "0040");
  EXPECT_NEAR(range.joint[idx(joint_index(1, 2))]->max, kReach, 3.0 * kDeg);
  EXPECT_FALSE(range.joint[idx(joint_index(2, 2))]) << "the device has no middle finger";
}

// Every 100 ms a sample that is 60 deg wrong: it never becomes part of the range, and it ends the hold.
TEST_F(RangeSessionTest, AWrongSampleDoesNotWidenTheRange) {
  session.measure(now);
  move_to(kBent);
  const double before = reached(2).max;
  for (int i = 0; i < 20; ++i) {
    hand.disturb();
    pass(0.1);
  }
  EXPECT_LT(session.view().still_for, 0.2);
  EXPECT_NEAR(reached(2).max, before, 1.0 * kDeg);
}

TEST_F(RangeSessionTest, WhatWasNotHeldIsNotReached) {
  session.measure(now);
  EXPECT_THAT(refusal_of_accept(), HasSubstr("index_mcp_flexion: no position was held still"));
  move_to(kStraight);
  hand.intend(kBent);
  pass(0.5);  // on its way, 2 rad/s
  hand.intend(kStraight);
  pass(2.0);
  EXPECT_LT(reached(2).max, 6.0 * kDeg);
}

TEST_F(RangeSessionTest, ADigitCanBeRepeatedOrLeftOut) {
  EXPECT_THAT(refusal_of_accept(), HasSubstr("no range is being measured"));
  session.measure(now);
  move_to(kBent);
  session.measure(now);
  move_to(kStraight);
  EXPECT_NEAR(reached(2).max, reached(2).min, 3.0 * kDeg) << "what came after the hand had stretched";
  session.skip();
  EXPECT_TRUE(session.at_end());
  EXPECT_FALSE(session.range());
  EXPECT_FALSE(session.view().finished);
  session.back();
  session.measure(now);
  move_to(kBent);
  session.accept();
  EXPECT_TRUE(session.view().finished);
  EXPECT_THROW(session.go_to(1), CalibrationError);
}

TEST_F(RangeSessionTest, NeedsAJointToMeasure) {
  test::HeldDevice motors;
  motors.keep_only_motors();
  EXPECT_THROW(RangeSession(motors, motors.info().channels, test::simple_parameters()), CalibrationError);
}

// What is shown at the end is what the file will hold.
TEST(RangeSession, ADigitThatWasMeasuredAndNotAcceptedIsNotAmongTheResults) {
  test::HeldDevice device;
  std::vector<DeviceChannel> channels = device.info().channels;
  channels.resize(2);
  channels[0] = {.kind = ChannelKind::kAngle, .index = joint_index(1, 0), .raw_max = 4095, .gain = 1e-3};
  channels[1] = {.kind = ChannelKind::kAngle, .index = joint_index(2, 2), .raw_max = 4095, .gain = 1e-3};
  RangeSession session(device, channels, test::simple_parameters());
  double now = 0.0;
  const auto measure = [&] {
    session.measure(now);
    for (int i = 0; i < 2000; ++i) session.update(now += 1e-3);
  };
  device.held[0] = device.held[1] = 500;
  measure();
  ASSERT_TRUE(session.view().joints.at(0).reached);
  session.go_to(1);  // the index finger is not accepted
  measure();
  session.accept();
  ASSERT_TRUE(session.at_end());
  const auto shown = session.view().joints;
  ASSERT_EQ(shown.size(), 1U);
  EXPECT_EQ(shown[0].joint, joint_index(2, 2));
  EXPECT_FALSE(session.range()->joint[idx(joint_index(1, 0))]);
  EXPECT_TRUE(session.range()->joint[idx(joint_index(2, 2))]);
}

TEST(MeasuredRange, BelongsToOneDeviceAndOneCalibration) {
  const MeasuredRange range{.device = "reaching", .serial = "0040", .calibration = "2026-05-04T09:30:00Z"};
  DeviceInfo device;
  device.name = "reaching";
  device.serial = "0040";
  EXPECT_NO_THROW(check_range(range, device, "2026-05-04T09:30:00Z"));
  const auto refusal = [&](const std::string& calibration) -> std::string {
    try {
      check_range(range, device, calibration);
    } catch (const CalibrationError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal("2026-06-04T09:30:00Z"), HasSubstr("measure the range again"));
  EXPECT_THAT(refusal(""), HasSubstr("in use is none"));
  device.serial = "0041";
  EXPECT_THAT(refusal("2026-05-04T09:30:00Z"), HasSubstr("reaching 0041"));
}

TEST(MeasuredRange, OfAJointHoldsForThoseThatFollowIt) {
  JointRanges ranges{};
  ranges[6] = AngleRange{.min = 0.1, .max = 0.7};
  ranges[8] = AngleRange{.min = 0.0, .max = 0.2};
  const std::vector<CoupledJoint> coupled = {{.joint = 7, .of = 6, .ratio = -0.5, .offset = 0.1},
                                             {.joint = 8, .of = 6, .ratio = 1.0, .offset = 0.0},
                                             {.joint = 11, .of = 10, .ratio = 1.0, .offset = 0.0}};
  const JointRanges with = with_followers(ranges, coupled);
  EXPECT_NEAR(with[7]->min, -0.25, 1e-12);
  EXPECT_NEAR(with[7]->max, 0.05, 1e-12);
  EXPECT_EQ(with[8]->max, 0.2) << "its own";
  EXPECT_FALSE(with[11]);
}

}  // namespace
}  // namespace phalanx
