// SPDX-License-Identifier: Apache-2.0
#include "station/sensor_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "station/fake_samples.h"

namespace phalanx {
namespace {

using test::Bench;
using test::kMcp;

/// Steps until there is a fault. @returns how many it took; 0: none within `most`.
int steps_to_fault(Bench& bench, int most = 2000) {
  for (int i = 1; i <= most; ++i) {
    bench.step();
    if (bench.safety.state() == SafetyState::kFault) return i;
  }
  return 0;
}

TEST(SensorWatch, AnOpenOrShortedSensorIsAFaultAtTheThirdSample) {
  for (const std::int32_t raw : {32767, -32768}) {
    Bench bench;
    bench.run_with(0.2);
    bench.samples.sample.raw[1] = raw;
    EXPECT_EQ(steps_to_fault(bench), 3);
    EXPECT_EQ(bench.safety.fault().fault, Fault::kSensorRange);
    EXPECT_EQ(bench.safety.fault().channel, 1);
  }
}

TEST(SensorWatch, TwoBadSamplesAreForgiven) {
  Bench bench;
  bench.run_with(0.2);
  for (int i = 0; i < 20; ++i) {
    const auto good = bench.samples.sample.raw[0];
    bench.samples.sample.raw[0] = 32767;
    bench.steps(2);
    bench.samples.sample.raw[0] = good;
    bench.step();
  }
  EXPECT_EQ(bench.safety.state(), SafetyState::kRunning);
}

TEST(SensorWatch, AJumpOfFiftyDegreesIsAFaultAtTheThirdSample) {
  Bench bench;
  bench.run_with(0.2);
  bench.samples.at(0.5 + 50.0 * std::numbers::pi / 180.0, 0.5);
  EXPECT_EQ(steps_to_fault(bench), 3);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kJump);
  EXPECT_EQ(bench.safety.fault().channel, 0);
}

TEST(SensorWatch, AFastHandIsNotAJumpAlsoWhenSamplesAreLost) {
  Bench bench;
  bench.run_with(0.0);
  const double begin = bench.now;
  for (int i = 0; i < 60; ++i) {  // up to 30 rad/s to and fro, two of three samples lost
    bench.samples.at(0.5 + 0.6 * std::abs(std::sin(50.0 * (bench.now - begin))), 0.5);
    const bool lost = i % 3 != 0;
    if (lost) bench.samples.sample.time_us += 1000;
    bench.step(lost);
  }
  EXPECT_NE(bench.safety.state(), SafetyState::kFault);
}

TEST(SensorWatch, AJointFarBeyondThePatientsRangeIsAFaultAtTheThirdSample) {
  Bench bench;
  bench.run_with(0.0);
  double angle = 0.5;
  while (angle < 1.8 && bench.safety.state() != SafetyState::kFault) {  // 1.5 rad and 20 degrees are 1.849
    bench.samples.at(angle += 0.01, 0.5);
    bench.step();
  }
  EXPECT_EQ(bench.safety.state(), SafetyState::kRunning);
  bench.samples.at(1.86, 0.5);
  EXPECT_EQ(steps_to_fault(bench), 3);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kOutOfRange);
}

TEST(SensorWatch, AClockThatRunsBackwardsIsAFaultAtTheThirdSample) {
  Bench bench;
  bench.run_with(0.2);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(bench.safety.state(), SafetyState::kRunning) << i;
    bench.samples.sample.time_us -= 5000;
    bench.step();
  }
  EXPECT_EQ(bench.safety.fault().fault, Fault::kClockBackwards);
}

TEST(SensorWatch, AClockThatHasGoneBackAndGoesOnFromThereCanBeReset) {
  Bench bench;
  bench.run_with(0.2);
  for (int i = 0; i < 3; ++i) {
    bench.samples.sample.time_us -= 5000;
    bench.step();
  }
  ASSERT_EQ(bench.safety.fault().fault, Fault::kClockBackwards);
  bench.samples.sample.time_us = 0;
  bench.steps(20);
  EXPECT_TRUE(bench.safety.reset(Fault::kNone, bench.now));
}

TEST(SensorWatch, ASensorThatStandsStillWhileItsMotorWindsIsAFaultAfterHalfASecond) {
  Bench bench;
  bench.run_with(0.1);
  bench.samples.at(0.51, 0.5);  // the last motion that the sensor sees
  bench.step();
  int steps = 0;
  while (bench.safety.state() != SafetyState::kFault && steps < 2000) {
    ++steps;
    bench.samples.sample.raw[2] += 1;  // 1 um a ms over an arm of 10 mm: 0.1 rad/s
    bench.samples.sample.raw[1] += steps % 2 == 0 ? 1 : -1;
    bench.step();
  }
  EXPECT_EQ(bench.safety.fault().fault, Fault::kStuckSensor);
  EXPECT_EQ(bench.safety.fault().channel, 0);
  EXPECT_GE(steps, 499);
  EXPECT_LE(steps, 502);
}

TEST(SensorWatch, AHandThatRestsIsNotAStuckSensor) {
  Bench bench;
  bench.run_with(0.1);
  bench.steps(3000);
  bench.samples.sample.raw[2] += 9;  // 9e-4 rad, 9 counts
  bench.steps(3000);
  EXPECT_EQ(bench.safety.state(), SafetyState::kRunning);
}

TEST(SensorWatch, AMeasuredTorqueThatIsNotTheCommandedOneIsAFaultAfterItsTime) {
  Bench bench;
  bench.run_with(0.4);
  EXPECT_EQ(bench.safety.state(), SafetyState::kRunning);
  bench.torque_follows = false;
  bench.samples.sample.raw[4] = 0;  // the motor does nothing: 0.4 Nm off, 0.35 are believed
  const int steps = steps_to_fault(bench);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kTorqueDisagrees);
  EXPECT_GE(steps, 200);
  EXPECT_LE(steps, 202);
}

TEST(SensorWatch, AMeasuredFingertipForceThatIsNotTheCommandedOneIsAFaultAfterItsTime) {
  Bench bench;
  SegmentSnapshot& distal = bench.snapshot.segment[static_cast<std::size_t>(segment_index(1, 2))];
  distal.normal = Vec3::UnitZ();
  distal.force = 4.0;
  bench.samples.sample.raw[5] = 1000;  // 1 N of 4 N: 3 N off, 2 + 2 N are believed
  bench.run_with(0.1);
  EXPECT_EQ(bench.safety.state(), SafetyState::kRunning);
  bench.samples.sample.raw[5] = -500;
  const int steps = steps_to_fault(bench);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kTorqueDisagrees);
  EXPECT_EQ(bench.safety.fault().channel, 5);
  EXPECT_GE(steps, 200);
  EXPECT_LE(steps, 202);
}

}  // namespace
}  // namespace phalanx
