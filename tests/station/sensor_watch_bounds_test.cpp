// SPDX-License-Identifier: Apache-2.0
// Each number that a sensor is judged by, from both sides, on samples that are written by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "station/fake_samples.h"
#include "station/sensor_watch.h"

namespace phalanx {
namespace {

using test::kMcp;
using test::kPip;

/// A watch alone, a sample a millisecond; the device renders what it is told in full.
class Watch {
 public:
  explicit Watch(std::vector<MotorWitness> witnesses = {},
                 const std::vector<DeviceChannel>& channels = test::two_joint_channels())
      : map_(channels, {}, test::ranged_hand()),
        watch(SafetySettings{}, map_, test::ranged_hand(), witnesses) {
    at(0.5, 0.5);
    sample.factor = 1.0;
  }
  void at(double mcp, double pip) {
    sample.raw[0] = static_cast<std::int32_t>(std::lround(mcp / test::kCount));
    sample.raw[1] = static_cast<std::int32_t>(std::lround(pip / test::kCount));
  }
  SensorFinding judge(std::uint64_t later_us = 1000) {
    sample.time_us += later_us;
    return watch.judge(sample, torque, force);
  }
  /// The first finding within so many samples.
  SensorFinding judge_many(int count) {
    for (int i = 0; i < count; ++i)
      if (const SensorFinding found = judge(); found.fault != Fault::kNone) return found;
    return {};
  }

 private:
  ChannelMap map_;

 public:
  SensorWatch watch;
  DeviceSample sample;
  JointArray torque{};
  DigitArray force{};
};

TEST(SensorWatchBounds, TheEndsOfASensorsRawRangeAreGood) {
  std::vector<DeviceChannel> channels = test::two_joint_channels();
  channels[0].raw_min = -3000;
  channels[0].raw_max = 15000;
  for (const auto& [end, beyond] : {std::pair{-3000, -3001}, std::pair{15000, 15001}}) {
    Watch bench({}, channels);
    bench.sample.raw[0] = end;
    EXPECT_EQ(bench.judge_many(10).fault, Fault::kNone) << end;
    EXPECT_TRUE(bench.watch.all_good());
    bench.sample.raw[0] = beyond;
    EXPECT_EQ(bench.judge_many(2).fault, Fault::kNone);
    EXPECT_FALSE(bench.watch.all_good());
    EXPECT_EQ(bench.judge().fault, Fault::kSensorRange);
  }
}

// What says how far a whole digit is closed or spread is judged as a joint's angle is.
TEST(SensorWatchBounds, AnOpenSensorOfADigitsCurlOrSplayIsFoundToo) {
  std::vector<DeviceChannel> channels = test::two_joint_channels();
  for (const ChannelKind kind : {ChannelKind::kCurl, ChannelKind::kSplay})
    channels.push_back(
        {.kind = kind, .index = 2, .raw_min = 0, .raw_max = 4095, .gain = 1.0 / 4095.0, .offset = 0.0});
  for (const int channel : {6, 7}) {
    Watch bench({}, channels);
    EXPECT_EQ(bench.judge_many(10).fault, Fault::kNone) << channel;
    bench.sample.raw[static_cast<std::size_t>(channel)] = 5000;
    EXPECT_EQ(bench.judge_many(2).fault, Fault::kNone) << channel;
    EXPECT_FALSE(bench.watch.all_good()) << channel;
    const SensorFinding found = bench.judge();
    EXPECT_EQ(found.fault, Fault::kSensorRange) << channel;
    EXPECT_EQ(found.channel, channel);
  }
}

// A channel whose gain overflows: 1e305 rad a count, 10,000 counts. It is no angle beyond the range, but none
// at all.
TEST(SensorWatchBounds, WhatIsNoNumberIsSaidToBeNone) {
  std::vector<DeviceChannel> channels = test::two_joint_channels();
  channels[0].gain = 1e305;
  Watch bench({}, channels);
  bench.sample.raw[0] = 10000;
  EXPECT_EQ(bench.judge_many(2).fault, Fault::kNone);
  EXPECT_FALSE(bench.watch.all_good());
  EXPECT_EQ(bench.judge().fault, Fault::kSampleNotFinite);
}

TEST(SensorWatchBounds, OfTwoSensorsThatAreBadAtOnceTheFirstIsNamed) {
  Watch bench;
  bench.sample.raw[0] = bench.sample.raw[1] = 32767;
  EXPECT_EQ(bench.judge_many(2).fault, Fault::kNone);
  EXPECT_EQ(bench.judge().channel, 0);
}

// The range of -0.3 .. 1.5 rad and 20 degrees beyond, 0.34907 rad: -0.64907 .. 1.84907.
TEST(SensorWatchBounds, AJointMayBeTwentyDegreesBeyondThePatientsRangeBothWays) {
  for (const auto& [good, bad] : {std::pair{-0.6490, -0.6492}, std::pair{1.8490, 1.8492}}) {
    Watch bench;
    bench.at(good, 0.5);
    EXPECT_EQ(bench.judge_many(10).fault, Fault::kNone) << good;
    bench.at(bad, 0.5);
    EXPECT_EQ(bench.judge_many(2).fault, Fault::kNone) << bad;
    const SensorFinding found = bench.judge();
    EXPECT_EQ(found.fault, Fault::kOutOfRange) << bad;
    EXPECT_EQ(found.channel, 0);
  }
}

// 40 rad/s over a millisecond and 2 degrees: 0.04 + 0.03491 = 0.0749 rad; over 5 ms 0.2349 rad.
TEST(SensorWatchBounds, AJumpIsWhatNoHandDoesInTheTimeBeyondTwoDegrees) {
  for (const double sign : {1.0, -1.0}) {
    Watch bench;
    bench.judge();
    bench.at(0.5 + sign * 0.0748, 0.5);
    bench.judge();
    EXPECT_TRUE(bench.watch.all_good());
    bench.at(0.5, 0.5);
    bench.judge(5000);
    bench.at(0.5 + sign * 0.0750, 0.5);
    bench.judge();
    EXPECT_FALSE(bench.watch.all_good());
  }
  Watch slow;
  slow.judge();
  slow.at(0.5 + 0.2348, 0.5);
  slow.judge(5000);
  EXPECT_TRUE(slow.watch.all_good());
}

TEST(SensorWatchBounds, AClockThatStandsStillIsABadOneAndOneGoodSampleForgivesIt) {
  Watch bench;
  bench.judge();
  EXPECT_EQ(bench.judge(0).fault, Fault::kNone);
  EXPECT_FALSE(bench.watch.all_good()) << "a reset waits";
  EXPECT_EQ(bench.judge(0).fault, Fault::kNone);
  EXPECT_EQ(bench.judge(1).fault, Fault::kNone);
  EXPECT_TRUE(bench.watch.all_good());
  EXPECT_EQ(bench.judge(0).fault, Fault::kNone);
  EXPECT_EQ(bench.judge(0).fault, Fault::kNone);
  EXPECT_EQ(bench.judge(0).fault, Fault::kClockBackwards);
}

// ---- a sensor that stands still ----

/// Motor 0 winds 10 mm a radian of the joint of the first channel and 5 mm a radian of that of the second.
Watch one_tendon_over(int first, int second) {
  MotorWitness witness{.channel = 2, .arm = {}, .slack = 0.0};
  witness.arm[static_cast<std::size_t>(first)] = 0.01;
  witness.arm[static_cast<std::size_t>(second)] = 0.005;
  std::vector<DeviceChannel> channels = test::two_joint_channels();
  channels[0].index = first;
  channels[1].index = second;
  return Watch({witness}, channels);
}

// The second joint bends by 0.5 rad and winds 2.5 mm, which explains the motor although the first joint's
// sensor rests. Then the motor winds 0.5 mm that no sensor sees: 0.05 rad of the first joint.
TEST(SensorWatchBounds, AMotorsMotionThatAnotherJointExplainsIsNotAStuckSensor) {
  for (const auto& [first, second] :
       {std::pair{static_cast<int>(kMcp), static_cast<int>(kPip)}, {1, 0}, {kJoints - 2, kJoints - 1}}) {
    Watch bench = one_tendon_over(first, second);
    const auto wind = [&](double by_first, double by_second) {
      bench.sample.raw[2] =
          static_cast<std::int32_t>(std::lround((0.01 * by_first + 0.005 * by_second) / 1e-6));
    };
    wind(0.5, 0.5);
    bench.judge();
    for (int i = 1; i <= 2000; ++i) {
      const double bent = 0.5 + 0.5 * i / 2000.0;
      bench.at(0.5, bent);
      wind(0.5, bent);
      ASSERT_EQ(bench.judge().fault, Fault::kNone) << i << ", joint " << second;
    }
    wind(0.55, 1.0);
    const SensorFinding found = bench.judge();
    EXPECT_EQ(found.fault, Fault::kStuckSensor) << first;
    EXPECT_EQ(found.channel, 0) << first;
  }
}

// The other way round: the knuckle, whose channel is the first, bends by 0.5 rad and winds 5 mm, which would
// be 1 rad of the middle joint, whose sensor rests.
TEST(SensorWatchBounds, AMotionThatTheFirstChannelExplainsIsNotAnothersStuckSensor) {
  Watch bench = one_tendon_over(kMcp, kPip);
  for (int i = 0; i <= 2000; ++i) {
    const double mcp = 0.5 + 0.5 * i / 2000.0;
    bench.at(mcp, 0.5);
    bench.sample.raw[2] = static_cast<std::int32_t>(std::lround((0.01 * mcp + 0.005 * 0.5) / 1e-6));
    ASSERT_EQ(bench.judge().fault, Fault::kNone) << i;
  }
}

// 2 mm of slack over 10 mm are 0.2 rad, and 10 counts 0.001 rad: 2.00 mm are believed, 2.02 mm are not.
TEST(SensorWatchBounds, AMotorMayTakeUpItsSlackBeforeASensorIsStuck) {
  MotorWitness witness{.channel = 2, .arm = {}, .slack = 2e-3};
  witness.arm[kMcp] = -0.01;
  for (const double way : {1.0, -1.0}) {
    Watch bench({witness});
    bench.judge_many(600);
    bench.sample.raw[2] = static_cast<std::int32_t>(way * 2000);
    EXPECT_EQ(bench.judge_many(600).fault, Fault::kNone);
    bench.sample.raw[2] = static_cast<std::int32_t>(way * 2020);
    EXPECT_EQ(bench.judge().fault, Fault::kStuckSensor);
  }
}

// A device that has been on for 10 s, its motor wound by 5 mm, 0.5 rad: the knuckle reads zero counts in the
// first sample as in all others, and the motor rests. Then it winds 20 um: 0.002 rad, 20 counts.
TEST(SensorWatchBounds, ASensorThatReadsZeroCountsFromTheFirstSampleOnIsNotStuck) {
  MotorWitness witness{.channel = 2, .arm = {}, .slack = 0.0};
  witness.arm[kMcp] = 0.01;
  Watch bench({witness});
  bench.sample.time_us = 10'000'000;
  bench.at(0.0, 0.5);
  bench.sample.raw[2] = 5000;
  EXPECT_EQ(bench.judge_many(1000).fault, Fault::kNone);
  bench.sample.raw[2] = 5020;
  EXPECT_EQ(bench.judge().fault, Fault::kStuckSensor);
}

// By hand: arms of -20 and 10 mm, at most 0.5 Nm: 0.5 / 0.02 = 25 N, below the motor's 40 N, and a bias of 3
// N: 28 N. Over 7000 N/m that is 4 mm, both ways 8 mm, and 1 mm of backlash. A motor of 15 N: 18 N, 5.143 mm
// + 1 mm.
TEST(SensorWatchBounds, ATendonsSlackIsItsStretchBothWaysAndItsPlay) {
  Exoskeleton exoskeleton;
  exoskeleton.motors.resize(3);
  for (ExoMotor& motor : exoskeleton.motors) {
    motor.arm[kMcp] = -0.02;
    motor.arm[kPip] = 0.01;
    motor.force_limit = 40.0;
    motor.bias = 3.0;
    motor.tendon_stiffness = 7000.0;
    motor.backlash = 1e-3;
  }
  exoskeleton.motors[1].force_limit = 15.0;
  exoskeleton.motors[2].arm = {};
  std::vector<DeviceChannel> channels(5);
  for (int m = 0; m < 4; ++m)
    channels[static_cast<std::size_t>(m) + 1] = {.kind = ChannelKind::kMotor, .index = m};
  const std::vector<MotorWitness> witnesses = motor_witnesses(exoskeleton, channels, 0.5);
  ASSERT_EQ(witnesses.size(), 2U) << "one motor moves nothing, and of one the device file says nothing";
  EXPECT_EQ(witnesses[0].channel, 1);
  EXPECT_EQ(witnesses[1].channel, 2);
  EXPECT_NEAR(witnesses[0].slack, 2.0 * 28.0 / 7000.0 + 1e-3, 1e-12);
  EXPECT_NEAR(witnesses[1].slack, 2.0 * 18.0 / 7000.0 + 1e-3, 1e-12);
  EXPECT_EQ(witnesses[0].arm[kMcp], -0.02);
}

TEST(SensorWatchBounds, AMotorThatIsTheFirstChannelIsAWitnessToo) {
  Exoskeleton exoskeleton;
  exoskeleton.motors.resize(1);
  exoskeleton.motors[0].arm[kMcp] = 0.01;
  exoskeleton.motors[0].tendon_stiffness = 7000.0;
  const std::vector<DeviceChannel> channels = {{.kind = ChannelKind::kMotor}};
  const std::vector<MotorWitness> witnesses = motor_witnesses(exoskeleton, channels, 0.5);
  ASSERT_EQ(witnesses.size(), 1U);
  EXPECT_EQ(witnesses[0].channel, 0);
}

// ---- linkages ----

/// r = 10 mm + 10 mm/rad q, so e = 10 q + 5 q^2 [mm].
JointLinkage bent(int joint) {
  return {.joint = joint, .min_angle = -0.3, .max_angle = 1.5, .polynomial = {0.010, 0.010}};
}

std::vector<MotorWitness> bent_witness() {
  Exoskeleton exoskeleton;
  exoskeleton.motors.resize(1);
  exoskeleton.motors[0].tendon_stiffness = 1e9;
  exoskeleton.motors[0].force_limit = 1.0;
  add_linkage(exoskeleton.motors[0], bent(kMcp));
  return motor_witnesses(
      exoskeleton, {{.kind = ChannelKind::kAngle, .index = kMcp}, {}, {.kind = ChannelKind::kMotor}}, 0.5);
}

// A joint that moves with its motor along the curve is believed. One that stands still while the motor winds
// what 20 counts of it unwind is stuck.
TEST(SensorWatchBounds, AMotorWithALinkageImpliesTheAngleOfItsExcursion) {
  const std::vector<MotorWitness> witnesses = bent_witness();
  ASSERT_EQ(witnesses.size(), 1U);
  EXPECT_DOUBLE_EQ(witnesses[0].least_arm[kMcp], 0.007);
  const auto wind = [](Watch& bench, double q) {
    bench.sample.raw[2] = static_cast<std::int32_t>(std::lround((0.010 * q + 0.005 * q * q) / 1e-6));
  };
  Watch follows(witnesses);
  wind(follows, 0.5);
  EXPECT_EQ(follows.judge_many(10).fault, Fault::kNone);
  for (int i = 0; i < 600; ++i) {
    const double q = 0.5 + 0.001 * i;
    follows.at(q, 0.5);
    wind(follows, q);
    ASSERT_EQ(follows.judge().fault, Fault::kNone) << q;
  }
  Watch stuck(witnesses);
  wind(stuck, 0.5);
  EXPECT_EQ(stuck.judge_many(10).fault, Fault::kNone);
  wind(stuck, 0.5005);  // 5 counts of the joint's sensor: not enough
  EXPECT_EQ(stuck.judge_many(600).fault, Fault::kNone);
  wind(stuck, 0.502);
  EXPECT_EQ(stuck.judge_many(600).fault, Fault::kStuckSensor);
}

// At -0.3 rad the arm is 7 mm, its least: 0.14 Nm need 20 N, which stretch the tendon by 20 / 7000 = 2.86 mm
// at a healthy joint that stands still. With the largest arm, 25 mm, it would be 0.8 mm.
TEST(SensorWatchBounds, TheSlackOfALinkageIsThatOfItsLeastArm) {
  Exoskeleton exoskeleton;
  exoskeleton.motors.resize(1);
  exoskeleton.motors[0].tendon_stiffness = 7000.0;
  exoskeleton.motors[0].force_limit = 40.0;
  add_linkage(exoskeleton.motors[0], bent(kMcp));
  const std::vector<MotorWitness> witnesses = motor_witnesses(
      exoskeleton, {{.kind = ChannelKind::kAngle, .index = kMcp}, {}, {.kind = ChannelKind::kMotor}}, 0.14);
  ASSERT_EQ(witnesses.size(), 1U);
  EXPECT_NEAR(witnesses[0].slack, 2.0 * 20.0 / 7000.0, 1e-12);
  Watch bench(witnesses);
  bench.at(-0.3, 0.5);
  bench.sample.raw[2] = -2550;  // 10 q + 5 q^2 [mm] at -0.3 rad
  EXPECT_EQ(bench.judge_many(10).fault, Fault::kNone);
  bench.sample.raw[2] += 2857;
  EXPECT_EQ(bench.judge_many(1000).fault, Fault::kNone);
}

// ---- torque and force that disagree ----

// -0.4 Nm commanded: 0.15 + 0.5 x 0.4 = 0.35 Nm are believed, either way round.
TEST(SensorWatchBounds, TorqueMayDisagreeByItsBoundOfEitherSign) {
  for (const double sign : {1.0, -1.0}) {
    Watch bench;
    bench.torque[kMcp] = sign * 0.4;
    bench.sample.raw[4] = static_cast<std::int32_t>(sign * 510);
    EXPECT_EQ(bench.judge_many(500).fault, Fault::kNone) << "0.349 Nm less";
    bench.sample.raw[4] = static_cast<std::int32_t>(sign * 7490);
    EXPECT_EQ(bench.judge_many(500).fault, Fault::kNone) << "0.349 Nm more";
    bench.sample.raw[4] = static_cast<std::int32_t>(sign * 490);
    const SensorFinding found = bench.judge_many(500);
    EXPECT_EQ(found.fault, Fault::kTorqueDisagrees) << "0.351 Nm less";
    EXPECT_EQ(found.channel, 4);
  }
}

// 0.2 s without a break: 0.19 s twice, with one sample between that agrees, are forgiven.
TEST(SensorWatchBounds, TorqueThatAgreesOnceHasItsWholeTimeAgain) {
  Watch bench;
  bench.torque[kMcp] = 0.4;
  for (int round = 0; round < 5; ++round) {
    bench.sample.raw[4] = 0;
    EXPECT_EQ(bench.judge_many(190).fault, Fault::kNone) << round;
    bench.sample.raw[4] = 4000;
    EXPECT_EQ(bench.judge().fault, Fault::kNone);
  }
  bench.sample.raw[4] = 0;
  EXPECT_EQ(bench.judge_many(200).fault, Fault::kNone);
  EXPECT_EQ(bench.judge_many(2).fault, Fault::kTorqueDisagrees)
      << "0.2 s after the first, or a rounding later";
}

// A device that has been on for 10 s, and disagrees from the first sample on: 0.2 s from there.
TEST(SensorWatchBounds, TorqueThatDisagreesFromTheFirstSampleOnHasItsWholeTimeToo) {
  Watch bench;
  bench.sample.time_us = 10'000'000 - 1000;
  bench.torque[kMcp] = 0.4;
  bench.sample.raw[4] = 0;
  EXPECT_EQ(bench.judge_many(200).fault, Fault::kNone);
  EXPECT_EQ(bench.judge_many(2).fault, Fault::kTorqueDisagrees);
}

// A device that still ramps renders its factor of what it is told.
TEST(SensorWatchBounds, MeasuredTorqueAndForceAreHeldAgainstTheDevicesOwnFactor) {
  Watch bench;
  bench.sample.factor = 0.1;
  bench.torque[kMcp] = 2.0;
  bench.force[1] = 10.0;
  bench.sample.raw[4] = 2000;  // 0.2 Nm
  bench.sample.raw[5] = 1000;  // 1 N
  EXPECT_EQ(bench.judge_many(500).fault, Fault::kNone);
  bench.sample.raw[4] = 20000;  // 2 Nm
  EXPECT_EQ(bench.judge_many(500).channel, 4);
  Watch tip;
  tip.sample.factor = 0.1;
  tip.force[1] = 10.0;
  tip.sample.raw[5] = 3400;  // 1 N and 2 + 0.5 N are 3.5 N
  EXPECT_EQ(tip.judge_many(500).fault, Fault::kNone);
  tip.sample.raw[5] = 3600;
  EXPECT_EQ(tip.judge_many(500).channel, 5);
}

}  // namespace
}  // namespace phalanx
