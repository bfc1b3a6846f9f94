// SPDX-License-Identifier: Apache-2.0
#include "station/safety.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "phalanx/core/random.h"
#include "station/fake_samples.h"

namespace phalanx {
namespace {

using test::Bench;
using test::kMcp;

TEST(Safety, TorqueRisesOverOneSecondAndNotFaster) {
  Bench bench;
  bench.snapshot.torque[kMcp] = 0.4;
  double before = 0.0;
  int until_full = 0;
  while (bench.safety.state() != SafetyState::kRunning) {
    const double torque = bench.step().torque[kMcp];
    EXPECT_LE(torque - before, 0.4 / 1000 + 1e-12);
    before = torque;
    ASSERT_LT(++until_full, 2000);
  }
  EXPECT_NEAR(until_full, 1000, 2);
  EXPECT_NEAR(bench.step().torque[kMcp], 0.4, 1e-9);
}

TEST(Safety, NothingLeavesBeforeTheDeviceIsReady) {
  Bench bench;
  bench.snapshot.torque[kMcp] = 0.4;
  bench.samples.sample.state = DeviceState::kConnecting;
  for (int i = 0; i < 300; ++i) {
    EXPECT_EQ(bench.step().torque[kMcp], 0.0);
    EXPECT_FALSE(bench.command.enable);
  }
  EXPECT_EQ(bench.safety.state(), SafetyState::kWaiting);
}

TEST(Safety, TenMillisecondsWithoutASampleAreAFaultAndFiveLaterTheTorqueIsZero) {
  Bench bench;
  bench.run_with(0.4);
  int silent = 0;
  while (bench.safety.state() != SafetyState::kFault) {
    bench.step(true);
    ASSERT_LT(++silent, 100);
  }
  EXPECT_GE(silent, 10);
  EXPECT_LE(silent, 11);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kNoSample);
  int falling = 1;
  while (bench.command.torque[kMcp] != 0.0) {
    bench.step(true);
    ASSERT_LT(++falling, 100);
  }
  EXPECT_LE(falling, 5);
  std::printf("no sample: fault after %d ms, zero %d ms later\n", silent, falling);
}

TEST(Safety, AtTwoHundredHertzTheFirstStepAfterTenMillisecondsSendsZero) {
  Bench bench({}, 5e-3);
  bench.run_with(0.4);
  int silent = 0;
  while (bench.command.torque[kMcp] != 0.0) {
    bench.step(true);
    ASSERT_LT(++silent, 100);
  }
  EXPECT_LE(silent, 3);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kNoSample);
}

TEST(Safety, AFaultStaysUntilAResetAndTheFirstOneIsNotHiddenByThoseThatFollow) {
  Bench bench;
  bench.run_with(0.4);
  bench.samples.sample.estop = true;
  bench.step();
  EXPECT_EQ(bench.safety.fault().fault, Fault::kEmergencyStop);
  bench.samples.sample.estop = false;
  for (int i = 0; i < 50; ++i) bench.step(true);  // and now the wire is cut as well
  EXPECT_EQ(bench.safety.fault().fault, Fault::kEmergencyStop);
  bench.safety.start();
  bench.steps(500);
  EXPECT_EQ(bench.command.torque[kMcp], 0.0);
  EXPECT_EQ(bench.safety.state(), SafetyState::kFault);
}

TEST(Safety, AResetIsRefusedWhileTheEmergencyStopIsPressedAndThenBringsAFreshRamp) {
  Bench bench;
  bench.run_with(0.4);
  bench.samples.sample.estop = true;
  bench.steps(20);
  EXPECT_FALSE(bench.safety.reset(Fault::kNone, bench.now));
  bench.samples.sample.estop = false;
  bench.steps(5);
  EXPECT_TRUE(bench.safety.reset(Fault::kNone, bench.now));
  bench.step();
  EXPECT_LE(bench.command.torque[kMcp], 0.4 / 1000 + 1e-12);
  bench.steps(500);
  EXPECT_NEAR(bench.command.torque[kMcp], 0.2, 0.002);
}

TEST(Safety, ADeviceThatIsSilentFromTheBeginningHasHalfASecond) {
  Bench bench;
  for (int i = 0; i < 490; ++i) bench.step(true);
  EXPECT_EQ(bench.safety.state(), SafetyState::kWaiting);
  for (int i = 0; i < 20; ++i) bench.step(true);
  EXPECT_EQ(bench.safety.state(), SafetyState::kFault);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kNoSample);
}

TEST(Safety, ADeviceThatIsLatchedWhenWeComeIsAFaultThatSomebodyMustReset) {
  Bench bench;
  bench.samples.sample.state = DeviceState::kLatched;
  bench.samples.sample.fault = Fault::kStepTooOld;
  bench.steps(490);
  EXPECT_EQ(bench.safety.state(), SafetyState::kWaiting) << "it has 0.5 s";
  bench.steps(20);
  EXPECT_EQ(bench.safety.state(), SafetyState::kFault);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kStepTooOld);
  EXPECT_TRUE(bench.safety.fault().from_device);
}

TEST(Safety, StopRampsDownWithinTheRateLimitAndStaysDownUntilStart) {
  Bench bench;
  bench.run_with(0.5);
  bench.safety.stop();
  double before = bench.command.torque[kMcp];
  for (int i = 0; i < 250; ++i) {
    const double torque = bench.step().torque[kMcp];
    EXPECT_LE(std::abs(torque - before), bench.settings.torque_rate * bench.period + 1e-12);
    before = torque;
  }
  EXPECT_EQ(before, 0.0);
  EXPECT_EQ(bench.safety.state(), SafetyState::kStopped);
  bench.steps(100);
  EXPECT_EQ(bench.command.torque[kMcp], 0.0);
  bench.safety.start();
  bench.steps(500);
  EXPECT_NEAR(bench.command.torque[kMcp], 0.25, 0.002);
}

TEST(Safety, TorqueThatWouldPushAJointBeyondThePatientsRangeFadesToZeroAtItsEnd) {
  Bench bench;
  bench.run_with(0.4);
  const double end = test::ranged_hand().max_angle[kMcp];
  for (double angle = 0.5; angle < end; angle += 0.01) {
    bench.samples.at(angle, 0.5);
    bench.step();
  }
  bench.samples.at(end - 0.5 * bench.settings.range_taper, 0.5);
  bench.steps(100);
  EXPECT_NEAR(bench.command.torque[kMcp], 0.2, 2e-3);
  bench.samples.at(end, 0.5);
  bench.steps(100);
  EXPECT_NEAR(bench.command.torque[kMcp], 0.0, 1e-9);
  bench.snapshot.torque[kMcp] = -0.4;  // back into the range: in full
  bench.steps(200);
  EXPECT_NEAR(bench.command.torque[kMcp], -0.4, 1e-9);
}

TEST(Safety, MoreForceOnADigitThanIsAllowedIsAFaultAndFifteenNewtonWhateverTheSettings) {
  for (const auto& [allowed, good, bad] :
       {std::array{5.0, 5.4, 5.6}, {10.0, 10.9, 11.1}, {20.0, 14.9, 15.1}}) {
    SafetySettings settings;
    settings.fingertip_force = allowed;
    Bench bench(settings);
    bench.run_with(0.1);
    SegmentSnapshot& distal = bench.snapshot.segment[static_cast<std::size_t>(segment_index(1, 2))];
    SegmentSnapshot& middle = bench.snapshot.segment[static_cast<std::size_t>(segment_index(1, 1))];
    distal.normal = middle.normal = Vec3::UnitZ();
    distal.force = middle.force = 0.5 * good;
    bench.step();
    EXPECT_EQ(bench.safety.state(), SafetyState::kRunning) << allowed;
    middle.force = bad - 0.5 * good;
    bench.step();
    EXPECT_EQ(bench.safety.fault().fault, Fault::kForceCeiling) << allowed;
  }
}

TEST(Safety, ADeviceThatDoesNotActOnWhatItIsSentIsAFault) {
  Bench bench;
  bench.run_with(0.3);
  bench.obeys = false;
  bench.steps(199);
  EXPECT_EQ(bench.safety.state(), SafetyState::kRunning);
  bench.steps(2);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kNotActing);
}

TEST(Safety, ADeviceThatIsLatchedAndDoesNotSayWhyIsAFaultToo) {
  Bench bench;
  bench.run_with(0.3);
  bench.samples.sample.state = DeviceState::kLatched;
  bench.step();
  EXPECT_EQ(bench.safety.fault().fault, Fault::kDrive);
}

TEST(Safety, AFaultNamesItsStepAndTheSensorThatTheDeviceNames) {
  Bench bench;
  bench.run_with(0.3);
  bench.samples.sample.state = DeviceState::kLatched;
  bench.samples.sample.fault = Fault::kSensorRange;
  bench.samples.sample.fault_channel = 3;
  bench.step();
  const std::uint64_t tick = bench.command.tick;
  bench.steps(5);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kSensorRange);
  EXPECT_EQ(bench.safety.fault().channel, 3);
  EXPECT_GT(tick, 1000U);
  EXPECT_EQ(bench.safety.fault().tick, tick);
}

TEST(Safety, AStopRightAfterAResetDoesNotBringTheOldFaultBack) {
  Bench bench;
  bench.run_with(0.3);
  bench.samples.sample.state = DeviceState::kLatched;
  bench.samples.sample.fault = Fault::kStepTooOld;
  bench.steps(20);
  ASSERT_TRUE(bench.safety.reset(Fault::kNone, bench.now));
  bench.steps(20);
  bench.safety.stop();
  bench.steps(20);  // the device has not answered yet
  EXPECT_EQ(bench.safety.state(), SafetyState::kStopped);
  bench.steps(600);  // and it never does
  EXPECT_EQ(bench.safety.fault().fault, Fault::kStepTooOld);
}

TEST(Safety, AStopIsNotForgottenByAFaultAndItsReset) {
  Bench bench;
  bench.run_with(0.3);
  bench.safety.stop();
  bench.steps(300);
  bench.samples.sample.estop = true;
  bench.steps(20);
  bench.safety.stop();
  bench.samples.sample.estop = false;
  bench.steps(5);
  ASSERT_TRUE(bench.safety.reset(Fault::kNone, bench.now));
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(bench.step().torque[kMcp], 0.0);
  EXPECT_EQ(bench.safety.state(), SafetyState::kStopped);
  bench.safety.start();
  bench.steps(500);
  EXPECT_NEAR(bench.command.torque[kMcp], 0.15, 0.002);
}

TEST(Safety, StartWaitsForTheDevice) {
  Bench bench;
  bench.samples.sample.state = DeviceState::kConnecting;
  bench.snapshot.torque[kMcp] = 0.3;
  bench.steps(20);
  bench.safety.stop();
  bench.steps(20);
  bench.safety.start();
  for (int i = 0; i < 300; ++i) EXPECT_EQ(bench.step().torque[kMcp], 0.0);
  bench.samples.sample.state = DeviceState::kReady;
  bench.steps(300);
  EXPECT_GT(bench.command.torque[kMcp], 0.05);
}

TEST(Safety, AResetIsGrantedWhereTheConnectionItselfIsInFaultAndGivesItTimeToMend) {
  Bench bench;
  bench.run_with(0.3);
  bench.samples.sample.estop = true;
  bench.steps(20);
  for (int i = 0; i < 50; ++i) bench.step(true, Fault::kControllerRestarted);  // the e-stop cuts the supply
  bench.samples.sample.estop = false;
  EXPECT_FALSE(bench.safety.reset(Fault::kNone, bench.now));
  EXPECT_TRUE(bench.safety.reset(Fault::kControllerRestarted, bench.now));
  for (int i = 0; i < 100; ++i) bench.step(true, Fault::kControllerRestarted);
  EXPECT_EQ(bench.safety.state(), SafetyState::kWaiting);
  bench.steps(500);
  EXPECT_EQ(bench.safety.state(), SafetyState::kStarting);
}

TEST(Safety, ALateStepDoesNotMakeTheFaultsRampLonger) {
  Bench bench;
  bench.run_with(0.4);
  bench.samples.sample.estop = true;
  bench.step();
  bench.now += 8e-3;
  EXPECT_EQ(bench.step().torque[kMcp], 0.0);
}

TEST(Safety, WallsOfADigitWhoseTorqueTheGateHasChangedAreNotSent) {
  Bench bench;
  bench.run_with(0.4);
  bench.snapshot.wall_valid_for = 0.014;
  bench.snapshot.wall[static_cast<std::size_t>(segment_index(1, 2))].active = true;
  bench.snapshot.wall[static_cast<std::size_t>(segment_index(0, 2))].active = true;
  bench.step();
  EXPECT_TRUE(bench.command.wall[static_cast<std::size_t>(segment_index(1, 2))].active);
  bench.snapshot.torque[kMcp] = 0.7;  // above the limit
  bench.step();
  EXPECT_FALSE(bench.command.wall[static_cast<std::size_t>(segment_index(1, 2))].active);
  EXPECT_TRUE(bench.command.wall[static_cast<std::size_t>(segment_index(0, 2))].active);
  bench.safety.stop();
  bench.step();
  EXPECT_EQ(bench.command.wall_valid_for, 0.0);
}

// The step has set what was not finite to zero, and says so by its status alone.
TEST(Safety, AStepThatSaysItWasNotFiniteIsAFaultThoughAllThatItSendsIsFinite) {
  Bench bench;
  bench.run_with(0.3);
  bench.snapshot.status = Status::kCommandNotFinite;
  bench.step();
  EXPECT_EQ(bench.safety.fault().fault, Fault::kCommandNotFinite);
}

TEST(Safety, AStepThatIsNotFiniteIsAFaultAndWhatLeavesIsFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Bench bench;
    bench.run_with(0.3);
    bench.snapshot.torque[kMcp] = bad;
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(std::isfinite(bench.step().torque[kMcp]));
    EXPECT_EQ(bench.safety.fault().fault, Fault::kCommandNotFinite);
    EXPECT_EQ(bench.command.torque[kMcp], 0.0);
  }
}

TEST(Safety, LateStepsAreCountedAndTenInARowAreAFault) {
  Bench bench;
  bench.run_with(0.3);
  for (int i = 0; i < 9; ++i) bench.step(false, Fault::kNone, true);
  bench.step(false, Fault::kNone, false);
  for (int i = 0; i < 9; ++i) bench.step(false, Fault::kNone, true);
  EXPECT_EQ(bench.safety.state(), SafetyState::kRunning);
  bench.step(false, Fault::kNone, true);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kOverload);
}

TEST(Safety, WhateverTheStepSaysTheCommandIsFiniteLimitedAndRateLimited) {
  constexpr std::uint64_t kSeed = 20261121;
  std::printf("seed %llu\n", static_cast<unsigned long long>(kSeed));
  Random random(kSeed);
  Bench bench;
  bench.steps(1300);
  JointArray before = bench.command.torque;
  for (int i = 0; i < 20000; ++i) {
    for (double& torque : bench.snapshot.torque)
      torque = random.between(-1e3, 1e3) * std::pow(10.0, random.between(-6, 2));
    bench.samples.at(0.5 + 0.02 * random.between(-1, 1), 0.5);
    if (i % 700 == 0) bench.safety.stop();
    if (i % 700 == 300) bench.safety.start();
    bench.step();
    for (std::size_t j = 0; j < before.size(); ++j) {
      ASSERT_LE(std::abs(bench.command.torque[j]), bench.settings.joint_torque);
      ASSERT_LE(std::abs(bench.command.torque[j] - before[j]),
                bench.settings.torque_rate * bench.period + 1e-12);
    }
    before = bench.command.torque;
  }
  EXPECT_NE(bench.safety.state(), SafetyState::kFault);
}

TEST(SafetyStates, HaveTheNamesThatLogsAndPagesShow) {
  EXPECT_EQ(safety_state_name(SafetyState::kWaiting), "waiting");
  EXPECT_EQ(safety_state_name(SafetyState::kStarting), "starting");
  EXPECT_EQ(safety_state_name(SafetyState::kRunning), "running");
  EXPECT_EQ(safety_state_name(SafetyState::kStopping), "stopping");
  EXPECT_EQ(safety_state_name(SafetyState::kStopped), "stopped");
  EXPECT_EQ(safety_state_name(SafetyState::kFault), "fault");
}

TEST(SafetySettings, AStationRefusesLimitsThatAreOffAndForcesThatNobodyAnswersFor) {
  LimitParameters limits;
  EXPECT_NO_THROW(static_cast<void>(make_safety_settings(limits, "")));
  limits.fingertip_force = 6.0;
  EXPECT_THROW(static_cast<void>(make_safety_settings(limits, "")), std::invalid_argument);
  EXPECT_NO_THROW(static_cast<void>(make_safety_settings(limits, "Dr Who")));
  limits.fingertip_force = 11.0;
  EXPECT_THROW(static_cast<void>(make_safety_settings(limits, "Dr Who")), std::invalid_argument);
  limits = {};
  limits.torque_rate_enabled = false;
  EXPECT_THROW(static_cast<void>(make_safety_settings(limits, "Dr Who")), std::invalid_argument);
  limits = {};
  limits.joint_torque = 3.0;
  EXPECT_THROW(static_cast<void>(make_safety_settings(limits, "Dr Who")), std::invalid_argument);
}

}  // namespace
}  // namespace phalanx
