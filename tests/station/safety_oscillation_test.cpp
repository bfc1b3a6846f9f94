// SPDX-License-Identifier: Apache-2.0
// What the gate does about a force that oscillates: fade, return, fault; and on which devices.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "station/fake_samples.h"
#include "station/safety.h"

namespace phalanx {
namespace {

using test::Bench;
using test::kMcp;

constexpr int kTip = 5;  ///< the index finger's distal segment

/// A bench whose index fingertip feels 2 N, or swings between 0 and 4 N, with the torque of a 50 mm arm.
struct Oscillator : Bench {
  explicit Oscillator(const DeviceInfo& device = info()) : Bench({}, 1e-3, device) {
    snapshot.segment[kTip].normal = Vec3::UnitZ();
  }

  const DeviceCommand& step_with(double swing, double frequency = 8.0) {
    const double force = 2.0 + 0.5 * swing * std::sin(2.0 * std::numbers::pi * frequency * now);
    snapshot.segment[kTip].force = force;
    snapshot.torque[kMcp] = 0.05 * force;
    return step();
  }
  void steady(double seconds) {
    for (int i = 0; i < std::lround(seconds / period); ++i) step_with(0.0);
  }
  /// Swings until the gate leaves kStarting and kRunning. @returns how long that took [s]; 2 s at most
  double swing_until_it_acts() {
    const double begin = now;
    while (now < begin + 2.0) {
      step_with(4.0);
      if (safety.state() != SafetyState::kRunning && safety.state() != SafetyState::kStarting) break;
    }
    return now - begin;
  }
  /// Steps with a steady force until the state is reached. @returns how long that took [s]; 5 s at most
  double steady_until(SafetyState state) {
    const double begin = now;
    while (safety.state() != state && now < begin + 5.0) step_with(0.0);
    return now - begin;
  }
};

// 8 Hz: the fourth leg is counted after at most 2.5 periods, 312 ms.
TEST(SafetyOscillation, TheFirstOneFadesTheTorqueWithinTheStopRampAndItReturnsByItself) {
  Oscillator bench;
  bench.steady(1.3);
  ASSERT_EQ(bench.safety.state(), SafetyState::kRunning);
  EXPECT_LT(bench.swing_until_it_acts(), 0.32);
  EXPECT_EQ(bench.safety.state(), SafetyState::kStopping);
  EXPECT_TRUE(bench.safety.oscillates());
  // It goes on swinging: the fade does not wait for it to end.
  for (int i = 0; i < 201; ++i) bench.step_with(4.0);
  EXPECT_EQ(bench.command.torque[kMcp], 0.0);
  EXPECT_TRUE(bench.safety.at_rest());
  EXPECT_EQ(bench.safety.fault().fault, Fault::kNone);
  // The verdict holds for 0.5 s after the last leg, which the fade itself counted. The start ramp takes 1 s.
  const double waited = bench.steady_until(SafetyState::kStarting);
  EXPECT_GT(waited, 0.2);
  EXPECT_LT(waited, 0.51);
  EXPECT_FALSE(bench.safety.oscillates());
  EXPECT_NEAR(bench.steady_until(SafetyState::kRunning), 1.0, 2e-3);
  bench.steady(0.01);
  EXPECT_NEAR(bench.command.torque[kMcp], 0.1, 1e-9);
}

TEST(SafetyOscillation, ASecondOneWithinTenSecondsIsAFaultAndZeroWithinFiveMilliseconds) {
  for (const double after : {0.3, 8.0}) {
    Oscillator bench;
    bench.steady(1.3);
    bench.swing_until_it_acts();
    bench.steady_until(SafetyState::kStarting);
    bench.steady(after);
    bench.swing_until_it_acts();
    ASSERT_EQ(bench.safety.state(), SafetyState::kFault) << after;
    EXPECT_EQ(bench.safety.fault().fault, Fault::kOscillation);
    EXPECT_EQ(bench.safety.fault().channel, -1);
    EXPECT_FALSE(bench.safety.fault().from_device);
    for (int i = 0; i < 5; ++i) bench.step_with(4.0);
    EXPECT_EQ(bench.command.torque[kMcp], 0.0);
    EXPECT_TRUE(bench.command.fault);
    bench.steady(5.0);
    EXPECT_EQ(bench.command.torque[kMcp], 0.0) << "only a reset brings the torque back";
  }
}

// 10 s from both sides: the oscillation is seen within 0.32 s after it begins, as above.
TEST(SafetyOscillation, LaterThanTenSecondsAfterTheReturnItFadesOnceMore) {
  for (const auto& [after, expected] :
       {std::pair{9.65, SafetyState::kFault}, std::pair{10.01, SafetyState::kStopping}}) {
    Oscillator bench;
    bench.steady(1.3);
    bench.swing_until_it_acts();
    bench.steady_until(SafetyState::kStarting);
    bench.steady(after);
    bench.swing_until_it_acts();
    EXPECT_EQ(bench.safety.state(), expected) << after;
  }
}

TEST(SafetyOscillation, TheTenSecondsAreNotPutOffByAnotherStart) {
  Oscillator bench;
  bench.steady(1.3);
  bench.swing_until_it_acts();
  bench.steady_until(SafetyState::kStarting);
  const double returned = bench.now;
  bench.steady(6.0);
  bench.safety.stop();
  bench.steady_until(SafetyState::kStopped);
  bench.safety.start();
  bench.steady_until(SafetyState::kRunning);
  bench.steady(returned + 10.01 - bench.now);
  bench.swing_until_it_acts();
  EXPECT_EQ(bench.safety.state(), SafetyState::kStopping);
}

TEST(SafetyOscillation, TheyBeginWithTheResumeAfterAStopThatKeptTheTorqueAway) {
  Oscillator bench;
  bench.steady(1.3);
  bench.swing_until_it_acts();
  bench.safety.stop();
  bench.steady(11.0);
  ASSERT_EQ(bench.safety.state(), SafetyState::kStopped);
  bench.safety.start();
  bench.steady_until(SafetyState::kRunning);
  bench.swing_until_it_acts();
  EXPECT_EQ(bench.safety.fault().fault, Fault::kOscillation);
}

TEST(SafetyOscillation, AfterTheFaultsResetAnotherOneIsAFaultAtOnce) {
  Oscillator bench;
  bench.steady(1.3);
  bench.swing_until_it_acts();
  bench.steady_until(SafetyState::kStarting);
  bench.swing_until_it_acts();
  ASSERT_EQ(bench.safety.fault().fault, Fault::kOscillation);
  bench.steady(0.1);
  ASSERT_TRUE(bench.safety.reset(Fault::kNone, bench.now));
  bench.steady_until(SafetyState::kRunning);
  ASSERT_EQ(bench.safety.state(), SafetyState::kRunning);
  bench.swing_until_it_acts();
  EXPECT_EQ(bench.safety.fault().fault, Fault::kOscillation);
}

TEST(SafetyOscillation, ResumeDoesNotCutTheFadeShort) {
  Oscillator bench;
  bench.steady(1.3);
  bench.swing_until_it_acts();
  bench.safety.start();
  double before = bench.safety.factor();
  for (int i = 0; i < 201; ++i) {
    bench.step_with(4.0);
    EXPECT_LE(bench.safety.factor(), before);
    before = bench.safety.factor();
  }
  EXPECT_EQ(bench.command.torque[kMcp], 0.0);
  EXPECT_LT(bench.steady_until(SafetyState::kRunning), 2.0) << "the resume is not forgotten";
}

TEST(SafetyOscillation, AStopDuringTheFadeStays) {
  Oscillator bench;
  bench.steady(1.3);
  bench.swing_until_it_acts();
  bench.safety.stop();
  bench.steady(3.0);
  EXPECT_EQ(bench.safety.state(), SafetyState::kStopped);
  EXPECT_EQ(bench.command.torque[kMcp], 0.0);
  bench.safety.start();
  bench.steady(1.1);
  EXPECT_EQ(bench.safety.state(), SafetyState::kRunning);
}

// The start ramp is no time in which a hand may be shaken: the swing counts as it leaves.
TEST(SafetyOscillation, CountsWhatLeavesAlsoWhileTheTorqueRises) {
  Oscillator bench;
  bench.steady(0.3);
  ASSERT_EQ(bench.safety.state(), SafetyState::kStarting);
  bench.swing_until_it_acts();
  EXPECT_EQ(bench.safety.state(), SafetyState::kStopping);
  EXPECT_LT(bench.safety.factor(), 0.7);
}

// 0.5 N from peak to peak is the observer's bound.
TEST(SafetyOscillation, ASwingOfLessThanHalfANewtonIsNone) {
  for (const auto& [swing, acts] : {std::pair{0.49, false}, std::pair{0.52, true}}) {
    Oscillator bench;
    bench.steady(1.3);
    bool acted = false;
    for (int i = 0; i < 2000; ++i) {
      bench.step_with(swing);
      acted = acted || bench.safety.state() != SafetyState::kRunning;
    }
    EXPECT_EQ(acted, acts) << swing;
  }
}

TEST(SafetyOscillation, OnlyASimulatedDeviceOrOneWithoutMotorsMayGoOn) {
  DeviceInfo simulated = Bench::info();
  simulated.simulated = true;
  DeviceInfo glove = Bench::info();
  glove.renders_torque = false;
  for (const DeviceInfo& device : {simulated, glove}) {
    Oscillator bench(device);
    bench.steady(1.3);
    for (int i = 0; i < 3000; ++i) bench.step_with(4.0);
    EXPECT_EQ(bench.safety.state(), SafetyState::kRunning);
    EXPECT_FALSE(bench.safety.oscillates());
  }
}

}  // namespace
}  // namespace phalanx
