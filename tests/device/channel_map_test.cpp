// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/channel_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "phalanx/device/exoskeleton.h"
#include "support/count_allocations.h"
#include "support/simple_hand.h"
#include "two_joint_device.h"

namespace phalanx::test {
namespace {

constexpr int kMiddle = 2;
constexpr int kRing = 3;

std::size_t idx(int i) { return static_cast<std::size_t>(i); }
std::size_t joint(int digit, int i) { return idx(joint_index(digit, i)); }

/// Flexion -0.5 .. 2, abduction -0.6 .. 0.6; open at 0.1.
HandParameters hand() {
  HandParameters parameters = simple_parameters();
  parameters.open_angle.fill(0.1);
  return parameters;
}

DeviceChannel channel(ChannelKind kind, int index, double gain, double offset = 0.0) {
  return {.kind = kind, .index = index, .raw_min = 0, .raw_max = 4095, .gain = gain, .offset = offset};
}

Sample converted(const ChannelMap& map, std::initializer_list<std::int32_t> raw) {
  DeviceSample in;
  in.time_us = 1'234'567;
  std::copy(raw.begin(), raw.end(), in.raw.begin());
  Sample out;
  out.angle.fill(std::numeric_limits<double>::quiet_NaN());
  map.convert(in, out);
  return out;
}

std::string refusal(const std::vector<DeviceChannel>& channels, const JointFollowers& followers = {}) {
  try {
    const ChannelMap map(channels, followers, hand());
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ChannelMap, AnAngleIsGainTimesRawPlusOffset) {
  const ChannelMap map({channel(ChannelKind::kAngle, 4, 0.001, -0.25)}, {}, hand());
  const Sample sample = converted(map, {1000});
  EXPECT_DOUBLE_EQ(sample.angle[4], 0.75);
  EXPECT_DOUBLE_EQ(sample.time_s, 1.234567);
  for (std::size_t j = 0; j < kJoints; ++j) {
    if (j != 4) {
      EXPECT_EQ(sample.angle[j], 0.1) << "not measured: open";
    }
    EXPECT_TRUE(std::isnan(sample.measured_torque[j]));
  }
  EXPECT_EQ(map.angle_channel(4), 0);
  EXPECT_EQ(map.angle_channel(5), -1);
}

// A quarter of the way from -0.5 to 2 rad is 0.125 rad.
TEST(ChannelMap, ACurlBendsAllHingesOfItsDigit) {
  const ChannelMap map({channel(ChannelKind::kCurl, kIndex, 1.0 / 1000.0)}, {}, hand());
  const Sample sample = converted(map, {250});
  for (const int i : {0, 2, 3}) EXPECT_DOUBLE_EQ(sample.angle[joint(kIndex, i)], 0.125);
  EXPECT_EQ(sample.angle[joint(kIndex, 1)], 0.1) << "abduction";
  EXPECT_EQ(sample.angle[joint(kMiddle, 0)], 0.1);
  EXPECT_EQ(map.angle_channel(joint_index(kIndex, 0)), -1);
}

// From the middle 0 half of half of 1.2 rad to the other side.
TEST(ChannelMap, ASplaySetsTheAbductionAroundItsMiddle) {
  HandParameters skewed = hand();
  skewed.min_angle[joint(kRing, 1)] = -0.2;  // middle 0.2, half 0.4
  const ChannelMap map(
      {channel(ChannelKind::kSplay, kIndex, 0.001, -1.0), channel(ChannelKind::kSplay, kRing, 0.001, -1.0)},
      {}, skewed);
  const Sample sample = converted(map, {500, 1500});
  EXPECT_DOUBLE_EQ(sample.angle[joint(kIndex, 1)], -0.3);
  EXPECT_DOUBLE_EQ(sample.angle[joint(kRing, 1)], 0.4);
  EXPECT_EQ(sample.angle[joint(kRing, 0)], 0.1);
}

TEST(ChannelMap, CurlAndSplayOfOneDigitDoNotCollide) {
  EXPECT_EQ(refusal({channel(ChannelKind::kCurl, 1, 1.0), channel(ChannelKind::kSplay, 1, 1.0)}), "");
}

TEST(ChannelMap, CoupledJointsAndCopiedDigitsFollow) {
  JointFollowers followers;
  followers.coupled = {{.joint = 7, .of = 6, .ratio = 0.5, .offset = 0.05}};
  followers.copy[kMiddle] = {.of = kIndex, .gain = 2.0};
  const ChannelMap map({channel(ChannelKind::kAngle, 4, 0.001), channel(ChannelKind::kAngle, 6, 0.001)},
                       followers, hand());
  const Sample sample = converted(map, {300, 800});
  EXPECT_DOUBLE_EQ(sample.angle[7], 0.45);
  EXPECT_DOUBLE_EQ(sample.angle[8], 0.1 + 2.0 * 0.2);
  EXPECT_DOUBLE_EQ(sample.angle[9], 0.1);
  EXPECT_DOUBLE_EQ(sample.angle[10], 0.1 + 2.0 * 0.7);
  EXPECT_DOUBLE_EQ(sample.angle[11], 0.1 + 2.0 * 0.35) << "of the coupled joint";
  EXPECT_EQ(sample.angle[12], 0.1) << "the ring finger stays open";
}

TEST(ChannelMap, ACopiedDigitGoesAsFarAlongItsWayAsTheOther) {
  JointFollowers followers;
  followers.copy[kMiddle] = {
      .of = kIndex,
      .gain = 1.0,
      .way = {0.2, 0.0, 0.6, 0.1},
      .way_of = {0.4, 0.0, 0.8, 0.9},  // the last joint is not measured, and does not count
      .least_share = -0.5,
      .most_share = 1.25};
  const std::vector<DeviceChannel> channels = {channel(ChannelKind::kAngle, 4, 0.001),
                                               channel(ChannelKind::kAngle, 6, 0.001)};
  const ChannelMap map(channels, followers, hand());
  const auto expect_share = [](const Sample& sample, double share) {
    EXPECT_NEAR(sample.angle[8], 0.1 + share * 0.2, 1e-12);
    EXPECT_NEAR(sample.angle[9], 0.1, 1e-12);
    EXPECT_NEAR(sample.angle[10], 0.1 + share * 0.6, 1e-12);
    EXPECT_NEAR(sample.angle[11], 0.1 + share * 0.1, 1e-12);
  };
  expect_share(converted(map, {100, 100}), 0.0);
  expect_share(converted(map, {300, 500}), 0.5);
  expect_share(converted(map, {500, 400}), 0.5);  // as much along the way, and some aside
  expect_share(converted(map, {500, 900}), 1.0);
  expect_share(converted(map, {900, 1800}), 1.25);
  expect_share(converted(map, {-900, -1800}), -0.5);
  EXPECT_EQ(map.angle_origins()[8], AngleOrigin::kCompleted);
  EXPECT_EQ(map.angle_origins()[9], AngleOrigin::kFixed);
  // Joint by joint where the measured joints have no way.
  followers.copy[kMiddle].way_of = {0.0, 0.0, 0.01, 0.9};
  EXPECT_NEAR(converted(ChannelMap(channels, followers, hand()), {300, 500}).angle[10], 0.5, 1e-12);
  followers.copy[kMiddle].way[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal({channel(ChannelKind::kAngle, 4, 0.001)}, followers), "");
}

TEST(ChannelMap, AJointThatIsMeasuredDoesNotFollow) {
  JointFollowers followers;
  followers.coupled = {{.joint = 7, .of = 6, .ratio = 0.5, .offset = 0.0}};
  followers.copy[kMiddle] = {.of = kIndex, .gain = 1.0};
  const ChannelMap map({channel(ChannelKind::kAngle, 6, 0.001), channel(ChannelKind::kAngle, 7, 0.001),
                        channel(ChannelKind::kAngle, 10, 0.001)},
                       followers, hand());
  const Sample sample = converted(map, {1000, 200, 400});
  EXPECT_DOUBLE_EQ(sample.angle[7], 0.2);
  EXPECT_DOUBLE_EQ(sample.angle[10], 0.4);
  EXPECT_DOUBLE_EQ(sample.angle[11], 0.2);
}

// The index finger has a curl, a splay and no MCP channel of its own; the thumb has one angle, which its IP
// joint follows; the ring finger copies the index finger, the little finger the middle one, which has nothing.
TEST(ChannelMap, StatesTheOriginOfEachAngle) {
  using enum AngleOrigin;
  JointFollowers followers;
  followers.coupled = {{.joint = 3, .of = 2, .ratio = 0.7}, {.joint = 11, .of = 10, .ratio = 0.7}};
  followers.copy[kRing] = {.of = kIndex, .gain = 1.0};
  followers.copy[4] = {.of = kMiddle, .gain = 1.0};
  const ChannelMap map({channel(ChannelKind::kAngle, 2, 0.001), channel(ChannelKind::kCurl, kIndex, 0.001),
                        channel(ChannelKind::kSplay, kIndex, 0.001)},
                       followers, hand());
  AngleOrigins expected;
  expected.fill(kFixed);
  expected[2] = kMeasured;
  expected[3] = kCompleted;
  for (int i = 0; i < kJointsPerDigit; ++i) {
    expected[joint(kIndex, i)] = i == kAbductionJoint ? kMeasured : kCompleted;
    expected[joint(kRing, i)] = kCompleted;
  }
  EXPECT_EQ(map.angle_origins(), expected);
  EXPECT_EQ(converted(map, {1, 2, 3}).angle_origin, expected);
}

// A copy with gain 0 stays at the open hand; a joint with a channel of its own does not follow.
TEST(ChannelMap, AJointThatDoesNotFollowIsNotCompleted) {
  JointFollowers followers;
  followers.coupled = {{.joint = 7, .of = 6, .ratio = 0.7}};
  followers.copy[kMiddle] = {.of = kIndex, .gain = 0.0};
  const ChannelMap map({channel(ChannelKind::kAngle, 6, 0.001), channel(ChannelKind::kAngle, 7, 0.001)},
                       followers, hand());
  for (std::size_t j = 0; j < kJoints; ++j)
    EXPECT_EQ(map.angle_origins()[j], j == 6 || j == 7 ? AngleOrigin::kMeasured : AngleOrigin::kFixed) << j;
}

TEST(ChannelMap, TheOriginsOfASimulatedDeviceAreThoseOfItsJoints) {
  const AngleOrigins origins = sensed_origins(two_joint_device());
  for (std::size_t j = 0; j < kJoints; ++j) {
    const AngleOrigin other = j == 4 || j == 6 ? AngleOrigin::kMeasured : AngleOrigin::kFixed;
    EXPECT_EQ(origins[j], j == 7 ? AngleOrigin::kCompleted : other) << j;
  }
}

TEST(ChannelMap, TorqueAndForceArePassedOnAndMotorsAreNot) {
  const ChannelMap map({channel(ChannelKind::kTorque, 4, 1e-4), channel(ChannelKind::kForce, 1, 0.01),
                        channel(ChannelKind::kMotor, 0, 1e-6)},
                       {}, hand());
  const Sample sample = converted(map, {-1500, 300, 12345});
  EXPECT_DOUBLE_EQ(sample.measured_torque[4], -0.15);
  EXPECT_TRUE(std::isnan(sample.measured_torque[5]));
  EXPECT_DOUBLE_EQ(sample.measured_force[1], 3.0);
  EXPECT_TRUE(std::isnan(sample.measured_force[0]));
  for (const double angle : sample.angle) EXPECT_EQ(angle, 0.1);
  EXPECT_DOUBLE_EQ(map.value(2, 12345), 0.012345);
}

TEST(ChannelMap, FollowersOfADeviceFileAreItsOwn) {
  Exoskeleton exoskeleton;
  exoskeleton.coupled = {{.joint = 3, .of = 2, .ratio = 0.7, .offset = 0.0}};
  exoskeleton.controller.copy[4] = {.of = 1, .gain = 0.9};
  const JointFollowers followers = followers_of(exoskeleton);
  ASSERT_EQ(followers.coupled.size(), 1U);
  EXPECT_EQ(followers.coupled[0].ratio, 0.7);
  EXPECT_EQ(followers.copy[4].of, 1);
  EXPECT_EQ(followers.copy[3].of, -1);
}

TEST(ChannelMap, RefusesWhatItCannotMean) {
  using enum ChannelKind;
  const double nan = std::nan("");
  EXPECT_NE(refusal({channel(kAngle, 20, 1.0)}).find("channel 0 (angle 20)"), std::string::npos);
  EXPECT_NE(refusal({channel(kCurl, 5, 1.0)}), "");
  EXPECT_NE(refusal({channel(kForce, -1, 1.0)}), "");
  EXPECT_NE(refusal({channel(kAngle, 4, 0.0)}).find("gain"), std::string::npos);
  EXPECT_NE(refusal({channel(kAngle, 4, nan)}).find("gain"), std::string::npos);
  EXPECT_NE(refusal({channel(kAngle, 4, 1.0, nan)}).find("offset"), std::string::npos);
  DeviceChannel empty = channel(kAngle, 4, 1.0);
  empty.raw_max = empty.raw_min;
  EXPECT_NE(refusal({empty}).find("raw_min"), std::string::npos);
  const std::string twice = refusal({channel(kAngle, 6, 1.0), channel(kCurl, 1, 1.0)});
  EXPECT_NE(twice.find("channel 1 (curl 1)"), std::string::npos) << twice;
  EXPECT_NE(twice.find("index_pip_flexion"), std::string::npos) << twice;
  EXPECT_NE(refusal(std::vector<DeviceChannel>(33, channel(kMotor, 0, 1.0))).find("32"), std::string::npos);
  EXPECT_NE(refusal({}, {.coupled = {{.joint = 20, .of = 1}}, .copy = {}}), "");
  JointFollowers bad_copy;
  bad_copy.copy[2].of = 5;
  EXPECT_NE(refusal({}, bad_copy).find("middle"), std::string::npos);
  for (const double gain : {nan, std::numeric_limits<double>::infinity()}) {
    bad_copy = {};
    bad_copy.copy[2] = {.of = 4, .gain = gain};
    EXPECT_NE(refusal({}, bad_copy).find("middle"), std::string::npos);
  }
  for (const CoupledJoint& bad :
       {CoupledJoint{.joint = 7, .of = 20}, CoupledJoint{.joint = -1, .of = 6},
        CoupledJoint{.joint = 7, .of = -1}, CoupledJoint{.joint = 7, .of = 6, .ratio = nan},
        CoupledJoint{.joint = 7, .of = 6, .ratio = 1.0, .offset = nan}})
    EXPECT_NE(refusal({}, {.coupled = {bad}, .copy = {}}).find("coupled joint"), std::string::npos);
}

// What a device does not measure is not a number, whatever the sample held before.
TEST(ChannelMap, LeavesNothingOfTheSampleBefore) {
  const ChannelMap map({channel(ChannelKind::kAngle, 4, 0.001)}, {}, hand());
  Sample sample;
  sample.measured_torque.fill(0.5);
  sample.measured_force.fill(0.5);
  sample.angle.fill(0.5);
  map.convert(DeviceSample{}, sample);
  for (const double torque : sample.measured_torque) EXPECT_TRUE(std::isnan(torque));
  for (const double force : sample.measured_force) EXPECT_TRUE(std::isnan(force));
  for (std::size_t j = 0; j < kJoints; ++j) EXPECT_EQ(sample.angle[j], j == 4 ? 0.0 : 0.1);
}

TEST(ChannelMap, ConvertingAllocatesNothing) {
  JointFollowers followers;
  followers.copy[kMiddle] = {.of = kIndex, .gain = 1.0};
  const ChannelMap map({channel(ChannelKind::kCurl, kIndex, 1.0)}, followers, hand());
  const DeviceSample in{};
  Sample out;
  const std::size_t before = allocations_of_this_thread();
  for (int i = 0; i < 100; ++i) map.convert(in, out);
  EXPECT_EQ(allocations_of_this_thread(), before);
}

}  // namespace
}  // namespace phalanx::test
