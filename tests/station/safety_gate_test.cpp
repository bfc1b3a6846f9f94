// SPDX-License-Identifier: Apache-2.0
// The gate's states, stepped by hand: what wins where two faults come at once, what a reset waits for, where
// walls are withheld, and how slow a glove may be.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "phalanx/core/constants.h"
#include "station/fake_samples.h"
#include "station/safety.h"

namespace phalanx {
namespace {

using test::Bench;
using test::kMcp;
using test::kPip;

constexpr std::int32_t kOpenSensor = 32767;

std::size_t wall_of_digit(int digit, int k) { return static_cast<std::size_t>(segment_index(digit, k)); }

// ---- a reset before the torque is at rest ----

// 0.4 Nm in five steps of 1 ms: 0.32, 0.24, 0.16, 0.08, 0. The cause is gone from the second step on, and yet
// a reset is refused until nothing is sent any more.
TEST(SafetyGate, AResetIsRefusedUntilTheTorqueIsAtRest) {
  Bench bench;
  bench.run_with(0.4);
  bench.samples.sample.estop = true;
  for (int i = 1; i <= 4; ++i) {
    EXPECT_NEAR(bench.step().torque[kMcp], 0.4 - 0.08 * i, 1e-9) << i;
    bench.samples.sample.estop = false;
    if (i > 1) {
      EXPECT_TRUE(bench.safety.cause_gone(bench.now)) << i;
    }
    EXPECT_FALSE(bench.safety.at_rest()) << i;
    EXPECT_FALSE(bench.safety.reset(Fault::kNone, bench.now)) << i;
    EXPECT_FALSE(bench.safety.reset(Fault::kDeviceLost, bench.now))
        << "nor for a connection to be mended " << i;
    EXPECT_EQ(bench.safety.state(), SafetyState::kFault);
    EXPECT_EQ(bench.safety.fault().fault, Fault::kEmergencyStop);
    EXPECT_TRUE(bench.command.enable);
    EXPECT_TRUE(bench.command.fault);
  }
  EXPECT_EQ(bench.step().torque[kMcp], 0.0);
  EXPECT_FALSE(bench.command.enable);
  EXPECT_TRUE(bench.command.fault);
  EXPECT_TRUE(bench.safety.at_rest());
  EXPECT_TRUE(bench.safety.reset(Fault::kNone, bench.now));
  EXPECT_EQ(bench.safety.state(), SafetyState::kWaiting);
}

// At rest means every joint: the last of them, and one in the middle, fall with the first.
TEST(SafetyGate, AtRestMeansEveryJoint) {
  for (const std::size_t joint : {std::size_t{0}, std::size_t{7}, static_cast<std::size_t>(kJoints - 1)}) {
    Bench bench;
    bench.snapshot.torque[joint] = 0.3;
    bench.run_with(0.0);
    bench.samples.sample.estop = true;
    bench.step();
    bench.samples.sample.estop = false;
    bench.steps(3);
    EXPECT_FALSE(bench.safety.at_rest()) << joint;
    EXPECT_FALSE(bench.safety.reset(Fault::kNone, bench.now)) << joint;
    bench.step();
    EXPECT_TRUE(bench.safety.at_rest()) << joint;
  }
}

// A stop of 0.2 s ends where the torque itself is zero, not where the ramp's factor is: the rate limit of 1
// Nm/s takes 0.4 s for 0.4 Nm.
TEST(SafetyGate, AStopEndsWhereTheTorqueIsAtRest) {
  SafetySettings settings;
  settings.torque_rate = 1.0;
  Bench bench(settings);
  bench.run_with(0.4);
  bench.safety.stop();
  bench.steps(300);
  EXPECT_EQ(bench.safety.factor(), 0.0);
  EXPECT_NEAR(bench.command.torque[kMcp], 0.4 - 0.3, 2e-3);
  EXPECT_EQ(bench.safety.state(), SafetyState::kStopping);
  EXPECT_EQ(bench.safety.settings().torque_rate, 1.0);
  EXPECT_TRUE(bench.command.enable);
  bench.steps(110);
  EXPECT_EQ(bench.command.torque[kMcp], 0.0);
  EXPECT_EQ(bench.safety.state(), SafetyState::kStopped);
  EXPECT_FALSE(bench.command.enable);
}

// ---- two faults at once ----

// The third bad sample of a sensor brings the emergency stop as well: the stop is named, and a reset waits
// for both.
TEST(SafetyGate, TheEmergencyStopWinsOverASensorFaultOfTheSameSampleAndAResetWaitsForBoth) {
  Bench bench;
  bench.run_with(0.4);
  const std::int32_t good = bench.samples.sample.raw[1];
  bench.samples.sample.raw[1] = kOpenSensor;
  bench.steps(2);
  ASSERT_EQ(bench.safety.state(), SafetyState::kRunning);
  bench.samples.sample.estop = true;
  bench.step();
  EXPECT_EQ(bench.safety.state(), SafetyState::kFault);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kEmergencyStop);
  EXPECT_EQ(bench.safety.fault().channel, -1);
  EXPECT_TRUE(bench.safety.fault().from_device);
  EXPECT_NEAR(bench.command.torque[kMcp], 0.32, 1e-9) << "one ramp, not two";
  bench.steps(20);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kEmergencyStop);
  EXPECT_FALSE(bench.safety.reset(Fault::kNone, bench.now)) << "pressed, and a sensor is bad";
  bench.samples.sample.estop = false;
  bench.step();
  EXPECT_FALSE(bench.safety.reset(Fault::kNone, bench.now)) << "released, and a sensor is bad";
  bench.samples.sample.estop = true;
  bench.samples.sample.raw[1] = good;
  bench.step();
  EXPECT_FALSE(bench.safety.reset(Fault::kNone, bench.now)) << "pressed";
  bench.samples.sample.estop = false;
  bench.step();
  EXPECT_TRUE(bench.safety.reset(Fault::kNone, bench.now));
  EXPECT_EQ(bench.safety.state(), SafetyState::kWaiting);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kNone);
}

// A device that has latched for the same sensor says so in that sample too: still the stop.
TEST(SafetyGate, TheEmergencyStopWinsOverTheDevicesLatchAndASensorFaultOverThatLatch) {
  for (const bool estop : {true, false}) {
    Bench bench;
    bench.run_with(0.4);
    bench.samples.sample.raw[1] = kOpenSensor;
    bench.steps(2);
    bench.samples.sample.estop = estop;
    bench.samples.sample.state = DeviceState::kLatched;
    bench.samples.sample.fault = Fault::kStepTooOld;
    bench.step();
    EXPECT_EQ(bench.safety.fault().fault, estop ? Fault::kEmergencyStop : Fault::kSensorRange);
    EXPECT_EQ(bench.safety.fault().channel, estop ? -1 : 1);
    EXPECT_EQ(bench.safety.fault().from_device, estop);
  }
}

// Two samples since the last step: what the older one says came first.
TEST(SafetyGate, OfTwoSamplesOfOneStepTheOlderNamesTheFault) {
  Bench bench;
  bench.run_with(0.4);
  bench.samples.sample.raw[1] = kOpenSensor;
  bench.steps(2);
  std::array<DeviceSample, 2> both = {bench.samples.next(bench.now), {}};
  bench.samples.sample.estop = true;
  both[1] = bench.samples.next(bench.now);
  bench.safety.observe(both, Fault::kNone, false, bench.now);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kSensorRange);
  EXPECT_EQ(bench.safety.fault().channel, 1);
}

// A second fault within the ramp does not begin it anew: 0.32, 0.24, 0.16, 0.08, 0 all the same.
TEST(SafetyGate, ASecondFaultDoesNotBeginTheRampAnew) {
  Bench bench;
  bench.run_with(0.4);
  bench.samples.sample.estop = true;
  const double began = bench.now;
  for (int i = 1; i <= 5; ++i) {
    if (i == 3) bench.snapshot.status = Status::kCommandNotFinite;
    EXPECT_NEAR(bench.step().torque[kMcp], 0.4 - 0.08 * i, 1e-9) << i;
  }
  EXPECT_EQ(bench.safety.fault().fault, Fault::kEmergencyStop);
  EXPECT_NEAR(bench.safety.fault().time, began + 1e-3, 1e-12);
}

// ---- walls at the ends of the patient's range ----

/// Steps the joint to an angle, no faster than a hand.
void move_to(Bench& bench, int joint, double angle) {
  double mcp = test::kCount * bench.samples.sample.raw[0];
  double pip = test::kCount * bench.samples.sample.raw[1];
  double& moves = joint == kMcp ? mcp : pip;
  while (moves != angle) {
    moves += std::clamp(angle - moves, -0.01, 0.01);
    bench.samples.at(mcp, pip);
    bench.step();
  }
}

// The range is -0.3 .. 1.5 rad and torque fades over its last 3 degrees, 0.05236 rad. Within these the
// device's own walls would push on where the gate tapers, so that none of the digit is sent, though the step
// asks for no torque.
TEST(SafetyGate, WallsOfADigitWithAJointInsideTheTaperAreNotSent) {
  for (const int joint : {kMcp, kPip}) {
    for (const bool upper : {true, false}) {
      Bench bench;
      bench.run_with(0.0);
      ASSERT_EQ(bench.safety.state(), SafetyState::kRunning);
      bench.snapshot.wall_valid_for = 0.014;
      for (int k = 0; k < kSegmentsPerDigit; ++k) bench.snapshot.wall[wall_of_digit(1, k)].active = true;
      bench.snapshot.wall[wall_of_digit(2, 1)].active = true;
      const double end = upper ? 1.5 : -0.3;
      const double inward = upper ? -1.0 : 1.0;
      const auto sent = [&] {
        int count = 0;
        for (int k = 0; k < kSegmentsPerDigit; ++k)
          count += bench.command.wall[wall_of_digit(1, k)].active ? 1 : 0;
        return count;
      };
      move_to(bench, joint, end + inward * (bench.settings.range_taper + 0.001));
      EXPECT_EQ(sent(), 3) << joint << upper << ": in front of the taper";
      move_to(bench, joint, end + inward * (bench.settings.range_taper - 0.001));
      EXPECT_EQ(sent(), 0) << joint << upper << ": just inside of it";
      EXPECT_EQ(bench.command.wall_valid_for, 0.014);
      EXPECT_TRUE(bench.command.wall[wall_of_digit(2, 1)].active) << "another digit is not at its end";
      move_to(bench, joint, end);
      EXPECT_EQ(sent(), 0) << joint << upper << ": at the end";
      EXPECT_EQ(bench.command.torque[static_cast<std::size_t>(joint)], 0.0);
    }
  }
}

// Torque that points back into the range is not tapered; the walls are withheld all the same, for nothing
// bounds the direction of their forces there.
TEST(SafetyGate, WallsInsideTheTaperAreNotSentEitherWhereTheTorquePointsInward) {
  Bench bench;
  bench.run_with(-0.2);
  bench.snapshot.wall_valid_for = 0.014;
  bench.snapshot.wall[wall_of_digit(1, 2)].active = true;
  move_to(bench, kMcp, 1.49);
  bench.steps(50);
  EXPECT_NEAR(bench.command.torque[kMcp], -0.2, 1e-12);
  EXPECT_FALSE(bench.command.wall[wall_of_digit(1, 2)].active);
}

// 0.3 Nm at once is more than the 0.01 Nm that the rate limit lets through in a step, so that the gate
// changes the torque of this joint, and only of this one.
TEST(SafetyGate, WallsOfADigitAreNotSentWhicheverOfItsJointsTheGateHasChanged) {
  for (int joint = 0; joint < kJoints; ++joint) {
    const int digit = digit_of_joint(joint);
    Bench bench;
    bench.run_with(0.0);
    bench.snapshot.wall_valid_for = 0.014;
    for (int k = 0; k < kSegmentsPerDigit; ++k) bench.snapshot.wall[wall_of_digit(digit, k)].active = true;
    bench.step();
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      EXPECT_TRUE(bench.command.wall[wall_of_digit(digit, k)].active) << joint;
    bench.snapshot.torque[static_cast<std::size_t>(joint)] = 0.3;
    bench.step();
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      EXPECT_FALSE(bench.command.wall[wall_of_digit(digit, k)].active) << joint;
  }
}

TEST(SafetyGate, WallsAreSentOnlyInFullOperation) {
  Bench bench;
  bench.snapshot.wall_valid_for = 0.014;
  bench.snapshot.wall[wall_of_digit(1, 2)].active = true;
  while (bench.safety.state() != SafetyState::kRunning) {
    bench.step();
    if (bench.safety.state() == SafetyState::kRunning) break;
    ASSERT_EQ(bench.command.wall_valid_for, 0.0);
    ASSERT_LT(bench.now, 2.0);
  }
  EXPECT_EQ(bench.command.wall_valid_for, 0.014);
  bench.samples.sample.estop = true;
  bench.step();
  EXPECT_EQ(bench.command.wall_valid_for, 0.0);
}

// ---- gloves ----

/// A device of its own rate, stepped every millisecond.
class SlowBench {
 public:
  explicit SlowBench(const DeviceInfo& info)
      : map_(test::two_joint_channels(), {}, test::ranged_hand()),
        safety({}, map_, info, test::ranged_hand(), {}, 1e-3),
        every_(static_cast<int>(std::lround(1000.0 / info.rate_hz))) {}

  /// One step; a sample comes where it is due and the device is not mute.
  void step(bool mute = false) {
    now_ += 1e-3;
    samples_.sample.time_us += 1000;
    samples_.sample.state = command.enable && acts ? DeviceState::kActive : DeviceState::kReady;
    if (++step_ % every_ == 0 && !mute) {
      ++samples_.sample.sequence;
      samples_.sample.received = now_;
      const DeviceSample sample = samples_.sample;
      safety.observe(std::span(&sample, 1), Fault::kNone, false, now_);
    } else {
      safety.observe({}, Fault::kNone, false, now_);
    }
    safety.command(Snapshot{}, samples_.sample, now_, command);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  /// Milliseconds of silence after a sample that it takes to a fault.
  int silent_until_fault() {
    while (step_ % every_ != 0) step();
    int count = 0;
    while (safety.state() != SafetyState::kFault && count < 1000) {
      step(true);
      ++count;
    }
    return count;
  }
  [[nodiscard]] double now() const { return now_; }

 private:
  ChannelMap map_;

 public:
  Safety safety;
  DeviceCommand command;
  bool acts = true;

 private:
  test::FakeSamples samples_;
  int every_;
  int step_ = 0;
  double now_ = 0.0;
};

DeviceInfo device_of(double rate_hz, bool renders_torque) {
  DeviceInfo info;
  info.rate_hz = rate_hz;
  info.renders_torque = renders_torque;
  return info;
}

// Five periods of 100 Hz are 50 ms, of 40 Hz 125 ms; a glove of 1 kHz has the 10 ms of every device. What
// renders torque has these at any rate.
TEST(SafetyGate, AGloveIsStaleAfterFiveOfItsPeriods) {
  struct Case {
    double rate_hz;
    bool renders_torque;
    int expected;
  };
  for (const Case& c : {Case{100.0, false, 50}, {40.0, false, 125}, {1000.0, false, 10}, {200.0, true, 10}}) {
    SlowBench bench(device_of(c.rate_hz, c.renders_torque));
    bench.steps(1200);
    ASSERT_EQ(bench.safety.state(), SafetyState::kRunning) << c.rate_hz;
    EXPECT_EQ(bench.silent_until_fault(), c.expected) << c.rate_hz;
    EXPECT_EQ(bench.safety.fault().fault, Fault::kNoSample);
  }
}

// A simulated device's time is the number of steps: 5 s of the clock in one step are a period of silence. The
// reset forgets a silence of 0.6 s, so that the next one has its half a second.
TEST(SafetyGate, TheSilenceOfASimulatedDeviceIsCountedInStepsAndAResetForgetsIt) {
  DeviceInfo info = device_of(1000.0, true);
  info.simulated = true;
  SlowBench bench(info);
  bench.steps(1200);
  ASSERT_EQ(bench.safety.state(), SafetyState::kRunning);
  bench.safety.observe({}, Fault::kNone, false, bench.now() + 5.0);
  EXPECT_EQ(bench.safety.state(), SafetyState::kRunning);
  bench.step();
  EXPECT_EQ(bench.silent_until_fault(), 10);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kNoSample);
  for (int i = 0; i < 600; ++i) bench.step(true);
  ASSERT_TRUE(bench.safety.reset(Fault::kNone, bench.now()));
  for (int i = 0; i < 490; ++i) bench.step(true);
  EXPECT_EQ(bench.safety.state(), SafetyState::kWaiting);
  for (int i = 0; i < 20; ++i) bench.step(true);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kNoSample);
}

TEST(SafetyGate, ASimulatedDeviceThatIsSilentFromTheBeginningHasHalfASecondToo) {
  DeviceInfo info = device_of(1000.0, true);
  info.simulated = true;
  SlowBench bench(info);
  for (int i = 0; i < 490; ++i) bench.step(true);
  EXPECT_EQ(bench.safety.state(), SafetyState::kWaiting);
  for (int i = 0; i < 20; ++i) bench.step(true);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kNoSample);
}

// Enabled commands and a device that stays at rest: 0.2 s for a motor, five periods for a slow glove.
TEST(SafetyGate, AGloveMayTakeFiveOfItsPeriodsToActOnWhatItIsSent) {
  for (const auto& [rate_hz, least] : {std::pair{10.0, 0.5}, std::pair{100.0, 0.2}}) {
    SlowBench bench(device_of(rate_hz, false));
    bench.steps(1500);
    ASSERT_EQ(bench.safety.state(), SafetyState::kRunning) << rate_hz;
    bench.acts = false;
    const double begin = bench.now();
    while (bench.safety.state() != SafetyState::kFault && bench.now() < begin + 2.0) bench.step();
    EXPECT_EQ(bench.safety.fault().fault, Fault::kNotActing) << rate_hz;
    EXPECT_NEAR(bench.safety.fault().time - begin, least + 0.5 / rate_hz, 0.5 / rate_hz + 2e-3) << rate_hz;
  }
}

// ---- how it begins, and what a fault names ----

// Nine late steps in a row from the very first on are not ten.
TEST(SafetyGate, BeginsAtRestAndWithNothingCounted) {
  Bench bench;
  EXPECT_EQ(bench.safety.state(), SafetyState::kWaiting);
  EXPECT_TRUE(bench.safety.at_rest());
  EXPECT_EQ(bench.safety.factor(), 0.0);
  EXPECT_EQ(bench.safety.late_in_a_row(), 0);
  for (int i = 1; i <= 9; ++i) {
    EXPECT_EQ(bench.step(false, Fault::kNone, true).tick, static_cast<std::uint64_t>(i));
    EXPECT_EQ(bench.safety.late_in_a_row(), i);
  }
  EXPECT_EQ(bench.safety.fault().fault, Fault::kNone);
}

// 0.5 s from the first look, also where the clock stood at 0 then.
TEST(SafetyGate, SilenceIsCountedFromAClockThatBeginsAtZeroToo) {
  Bench bench;
  for (const double now : {0.0, 0.3}) bench.safety.observe({}, Fault::kNone, false, now);
  EXPECT_EQ(bench.safety.state(), SafetyState::kWaiting);
  bench.safety.observe({}, Fault::kNone, false, 0.5);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kNoSample);
}

void push_index(Bench& bench, int k, double force) {
  SegmentSnapshot& segment = bench.snapshot.segment[wall_of_digit(1, k)];
  segment.normal = Vec3::UnitZ();
  segment.force = force;
}

// A fault that no sensor caused names no channel, and a fault that the host found is not attributed to the
// device. 6 N exceed the limit of one segment, and 4 N on each of two segments that of their digit.
TEST(SafetyGate, AFaultThatIsNotOneSensorsNamesNoChannelAndIsTheHosts) {
  struct Case {
    Fault fault;
    void (*cause)(Bench&);
  };
  const Case cases[] = {
      {Fault::kNoSample,
       [](Bench& b) {
         for (int i = 0; i < 20; ++i) b.step(true);
       }},
      {Fault::kControllerRestarted, [](Bench& b) { b.step(false, Fault::kControllerRestarted); }},
      {Fault::kOverload,
       [](Bench& b) {
         for (int i = 0; i < 10; ++i) b.step(false, Fault::kNone, true);
       }},
      {Fault::kNotActing,
       [](Bench& b) {
         b.obeys = false;
         b.steps(300);
       }},
      {Fault::kForceCeiling,
       [](Bench& b) {
         push_index(b, 2, 6.0);
         b.step();
       }},
      {Fault::kForceCeiling,
       [](Bench& b) {
         push_index(b, 1, 4.0);
         push_index(b, 2, 4.0);
         b.step();
       }},
      {Fault::kCommandNotFinite,
       [](Bench& b) {
         b.snapshot.status = Status::kCommandNotFinite;
         b.step();
       }},
      {Fault::kCommandNotFinite,
       [](Bench& b) {
         b.snapshot.torque[kMcp] = std::numeric_limits<double>::quiet_NaN();
         b.step();
       }},
      {Fault::kClockBackwards,
       [](Bench& b) {
         for (int i = 0; i < 3; ++i) {
           b.samples.sample.time_us -= 5000;
           b.step();
         }
       }},
  };
  for (const Case& c : cases) {
    Bench bench;
    bench.run_with(0.1);
    c.cause(bench);
    EXPECT_EQ(bench.safety.fault().fault, c.fault) << fault_name(c.fault);
    EXPECT_EQ(bench.safety.fault().channel, -1) << fault_name(c.fault);
    EXPECT_FALSE(bench.safety.fault().from_device) << fault_name(c.fault);
  }
}

// ---- what a reset and a start find ----

// Two bad samples are no fault, and yet no time to begin.
TEST(SafetyGate, ASensorThatIsBadAtTheBeginningIsWaitedFor) {
  Bench bench;
  const std::int32_t good = bench.samples.sample.raw[1];
  bench.samples.sample.raw[1] = kOpenSensor;
  bench.steps(2);
  EXPECT_EQ(bench.safety.state(), SafetyState::kWaiting);
  EXPECT_FALSE(bench.command.enable);
  bench.samples.sample.raw[1] = good;
  bench.step();
  EXPECT_EQ(bench.safety.state(), SafetyState::kStarting);
}

// Where samples stopped coming there is nothing to judge: the reset itself asks for them again.
TEST(SafetyGate, AResetAfterSilenceIsGrantedWithoutASample) {
  Bench bench;
  bench.run_with(0.3);
  for (int i = 0; i < 30; ++i) bench.step(true);
  ASSERT_EQ(bench.safety.fault().fault, Fault::kNoSample);
  EXPECT_TRUE(bench.safety.reset(Fault::kNone, bench.now));
  EXPECT_EQ(bench.safety.state(), SafetyState::kWaiting);
}

// After another fault silence is a reason to refuse: nothing says that the cause is gone. 10 ms are still
// believed.
TEST(SafetyGate, AResetAfterAnEmergencyStopWaitsForSamples) {
  Bench bench;
  bench.run_with(0.3);
  bench.samples.sample.estop = true;
  bench.steps(10);
  bench.samples.sample.estop = false;
  bench.step();
  EXPECT_TRUE(bench.safety.cause_gone(bench.now));
  for (int i = 0; i < 9; ++i) bench.step(true);
  EXPECT_TRUE(bench.safety.cause_gone(bench.now));
  for (int i = 0; i < 2; ++i) bench.step(true);
  EXPECT_FALSE(bench.safety.cause_gone(bench.now));
  EXPECT_FALSE(bench.safety.reset(Fault::kNone, bench.now));
  bench.step();
  EXPECT_TRUE(bench.safety.reset(Fault::kNone, bench.now));
}

// A controller that has restarted begins its clock at 0. After the reset the first sample is compared with
// none.
TEST(SafetyGate, AResetForgetsTheSamplesOfBefore) {
  Bench bench;
  bench.run_with(0.3);
  for (int i = 0; i < 10; ++i) bench.step(true, Fault::kControllerRestarted);
  ASSERT_EQ(bench.safety.fault().fault, Fault::kControllerRestarted);
  ASSERT_TRUE(bench.safety.reset(Fault::kControllerRestarted, bench.now));
  bench.samples.sample.time_us = 0;
  bench.samples.at(1.2, 0.1);
  bench.step();
  EXPECT_EQ(bench.safety.state(), SafetyState::kStarting) << "its first sample will do";
  bench.steps(4);
  EXPECT_EQ(bench.safety.state(), SafetyState::kStarting);
}

TEST(SafetyGate, AResetCountsLateStepsFromZero) {
  Bench bench;
  bench.run_with(0.3);
  for (int i = 0; i < 20; ++i) bench.step(false, Fault::kNone, true);
  ASSERT_EQ(bench.safety.fault().fault, Fault::kOverload);
  ASSERT_TRUE(bench.safety.reset(Fault::kNone, bench.now));
  EXPECT_EQ(bench.safety.late_in_a_row(), 0);
  for (int i = 0; i < 9; ++i) bench.step(false, Fault::kNone, true);
  EXPECT_EQ(bench.safety.state(), SafetyState::kStarting);
  bench.step(false, Fault::kNone, true);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kOverload);
}

// A start within the stop's ramp turns it round; after it, the device must be ready again first.
TEST(SafetyGate, AStartTurnsAStopRoundWhileItsRampLastsAndWaitsForTheDeviceAfterIt) {
  SafetySettings settings;
  settings.torque_rate = 1.0;
  Bench bench(settings);
  bench.run_with(0.4);
  bench.safety.stop();
  bench.steps(100);
  ASSERT_GT(bench.safety.factor(), 0.0);
  bench.safety.start();
  EXPECT_EQ(bench.safety.state(), SafetyState::kStarting);
  bench.steps(1000);
  bench.safety.stop();
  bench.steps(250);
  ASSERT_EQ(bench.safety.factor(), 0.0);
  ASSERT_EQ(bench.safety.state(), SafetyState::kStopping) << "the torque is on its way";
  bench.safety.start();
  EXPECT_EQ(bench.safety.state(), SafetyState::kWaiting);
}

TEST(SafetyGate, AFaultLeavesNoFactorOnTheStepsTorque) {
  Bench bench;
  bench.run_with(0.3);
  EXPECT_EQ(bench.safety.factor(), 1.0);
  bench.samples.sample.estop = true;
  bench.step();
  EXPECT_EQ(bench.safety.factor(), 0.0);
}

// ---- what goes out and what is judged ----

TEST(SafetyGate, ACommandNamesTheSampleThatItsStepUsedAndTheHandThatIsShown) {
  Bench bench;
  bench.snapshot.gdp_angle[kPip] = 0.25;
  bench.step();
  EXPECT_EQ(bench.command.sample_time_us, bench.samples.sample.time_us);
  DeviceSample used = bench.samples.sample;
  used.time_us -= 400;
  bench.safety.command(bench.snapshot, used, bench.now, bench.command);
  EXPECT_EQ(bench.command.sample_time_us, used.time_us);
  EXPECT_EQ(bench.command.hcp_angle, bench.snapshot.hcp_angle);
  EXPECT_EQ(bench.command.gdp_angle[kPip], 0.25);
}

// A digit is stopped where one of its segments touches, while torque may flow; never while we wait or in
// fault.
TEST(SafetyGate, ADigitIsStoppedOnlyWhileTheDeviceIsCommanded) {
  for (int segment = 0; segment < kDigits * kSegmentsPerDigit; ++segment) {
    const int touched = segment / kSegmentsPerDigit;
    const auto digit = static_cast<std::size_t>(touched);
    const auto other = static_cast<std::size_t>((touched + 1) % kDigits);
    Bench bench;
    bench.snapshot.segment[wall_of_digit(touched, segment % kSegmentsPerDigit)].contact = true;
    bench.samples.sample.state = DeviceState::kConnecting;
    bench.steps(5);
    ASSERT_EQ(bench.safety.state(), SafetyState::kWaiting);
    EXPECT_FALSE(bench.command.stopped[digit]) << segment;
    bench.samples.sample.state = DeviceState::kReady;
    bench.steps(5);
    EXPECT_TRUE(bench.command.stopped[digit]) << segment;
    EXPECT_FALSE(bench.command.stopped[other]) << segment;
    bench.snapshot.torque[kMcp] = 0.3;
    bench.steps(1200);
    bench.samples.sample.estop = true;
    bench.step();
    EXPECT_TRUE(bench.command.enable) << "the fault's ramp";
    EXPECT_FALSE(bench.command.stopped[digit]) << segment;
  }
}

// Two forces of 6 N against each other add up to nothing, and 5.5 N are allowed for each.
TEST(SafetyGate, EachSegmentsForceIsJudgedBesideTheSum) {
  Bench bench;
  bench.run_with(0.1);
  SegmentSnapshot& distal = bench.snapshot.segment[wall_of_digit(1, 2)];
  SegmentSnapshot& middle = bench.snapshot.segment[wall_of_digit(1, 1)];
  distal.normal = Vec3::UnitZ();
  middle.normal = -Vec3::UnitZ();
  distal.force = middle.force = 5.4;
  bench.samples.sample.raw[5] = 0;
  bench.step();
  EXPECT_EQ(bench.safety.state(), SafetyState::kRunning);
  distal.force = middle.force = 5.6;
  bench.step();
  EXPECT_EQ(bench.safety.fault().fault, Fault::kForceCeiling);
}

// 1.1 x 5 N are 5.5 N, on every segment of every digit.
TEST(SafetyGate, TheForceOnEverySegmentOfEveryDigitIsJudged) {
  for (int digit = 0; digit < kDigits; ++digit) {
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      Bench bench;
      bench.run_with(0.1);
      SegmentSnapshot& segment = bench.snapshot.segment[wall_of_digit(digit, k)];
      segment.normal = Vec3::UnitZ();
      segment.force = 5.4;
      bench.step();
      EXPECT_EQ(bench.safety.state(), SafetyState::kRunning) << digit << k;
      segment.force = 5.6;
      bench.step();
      EXPECT_EQ(bench.safety.fault().fault, Fault::kForceCeiling) << digit << k;
    }
  }
}

// In the start ramp a fingertip feels its part of the step's force: 8 N at a factor below 0.3 are at most 2.4
// N, of which none at all is believed (2 + 1.2 N). Against 8 N in full it would not be (2 + 4 N).
TEST(SafetyGate, MeasuredFingertipForceIsHeldAgainstWhatTheRampLetsThrough) {
  SafetySettings settings;
  settings.fingertip_force = 10.0;
  Bench bench(settings);
  SegmentSnapshot& distal = bench.snapshot.segment[wall_of_digit(1, 2)];
  distal.normal = Vec3::UnitZ();
  distal.force = 8.0;
  bench.steps(290);
  EXPECT_EQ(bench.safety.state(), SafetyState::kStarting);
  bench.steps(1500);
  EXPECT_EQ(bench.safety.fault().fault, Fault::kTorqueDisagrees) << "in full it is a fault";
}

// 0.15 s of rest twice, with a step between in which the device acts, are not 0.2 s.
TEST(SafetyGate, ADeviceThatActsAgainHasItsWholeTimeAgain) {
  Bench bench;
  bench.run_with(0.1);
  for (int round = 0; round < 4; ++round) {
    bench.obeys = false;
    bench.steps(150);
    bench.obeys = true;
    bench.steps(2);
  }
  EXPECT_EQ(bench.safety.state(), SafetyState::kRunning);
}

// 0.7 Nm against a limit of 0.5 Nm, either way.
TEST(SafetyGate, TorqueIsLimitedBothWays) {
  for (const double sign : {1.0, -1.0}) {
    Bench bench;
    bench.run_with(sign * 0.7);
    EXPECT_NEAR(bench.command.torque[kMcp], sign * 0.5, 1e-12);
  }
}

// An angle that is not a number has no place in the range: what leaves for that joint is zero, and the others
// go on.
TEST(SafetyGate, WhatLeavesIsFiniteAlsoWhereTheShownAngleIsNot) {
  Bench bench;
  bench.run_with(0.2);
  bench.snapshot.torque[0] = 0.2;
  bench.snapshot.hcp_angle[0] = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 5; ++i) {
    bench.step();
    EXPECT_EQ(bench.command.torque[0], 0.0);
    EXPECT_NEAR(bench.command.torque[kMcp], 0.2, 1e-12);
  }
}

// A device that fades acts: it holds a step that is old.
TEST(SafetyGate, ADeviceThatFadesActs) {
  Bench bench;
  bench.run_with(0.1);
  for (const DeviceState state : {DeviceState::kFading, DeviceState::kStarting}) {
    bench.samples.sample.state = state;
    bench.steps(500);
    EXPECT_EQ(bench.safety.state(), SafetyState::kRunning);
  }
}

// ---- settings ----

TEST(SafetyGateSettings, AllowTheLargestOfEachAndRefuseMore) {
  struct Case {
    double LimitParameters::* limit;
    double most;
    const char* name;
  };
  for (const Case& c : {Case{&LimitParameters::fingertip_force, 10.0, "fingertip_force"},
                        {&LimitParameters::joint_torque, 2.0, "joint_torque"},
                        {&LimitParameters::torque_rate, 100.0, "torque_rate"}}) {
    LimitParameters limits;
    limits.*c.limit = c.most;
    EXPECT_NO_THROW(static_cast<void>(make_safety_settings(limits, "Dr A"))) << c.name;
    limits.*c.limit = 1.001 * c.most;
    try {
      static_cast<void>(make_safety_settings(limits, "Dr A"));
      ADD_FAILURE() << c.name << " is allowed";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(c.name), std::string::npos) << error.what();
    }
  }
  LimitParameters limits;
  limits.fingertip_force = 5.0;
  EXPECT_NO_THROW(static_cast<void>(make_safety_settings(limits, ""))) << "5 N need no clinician";
  limits.joint_speed = kInfinity;
  EXPECT_THROW(static_cast<void>(make_safety_settings(limits, "Dr A")), std::invalid_argument);
}

TEST(SafetyGateSettings, RefuseEveryLimitThatIsOffByItsName) {
  struct Case {
    bool LimitParameters::* enabled;
    const char* key;
  };
  for (const Case& c : {Case{&LimitParameters::fingertip_force_enabled, "limits.fingertip_force_n"},
                        {&LimitParameters::joint_torque_enabled, "limits.joint_torque_nm"},
                        {&LimitParameters::torque_rate_enabled, "limits.torque_rate_nm_per_s"}}) {
    LimitParameters limits;
    limits.*c.enabled = false;
    try {
      static_cast<void>(make_safety_settings(limits, "Dr A"));
      ADD_FAILURE() << c.key << " may be off";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(c.key), std::string::npos) << error.what();
    }
  }
}

TEST(SafetyGateSettings, AreTheScenesLimits) {
  LimitParameters limits;
  limits.fingertip_force = 4.0;
  limits.joint_torque = 0.3;
  limits.torque_rate = 7.0;
  limits.joint_speed = 25.0;
  const SafetySettings settings = make_safety_settings(limits, "");
  EXPECT_EQ(settings.fingertip_force, 4.0);
  EXPECT_EQ(settings.joint_torque, 0.3);
  EXPECT_EQ(settings.torque_rate, 7.0);
  EXPECT_EQ(settings.joint_speed, 25.0);
}

}  // namespace
}  // namespace phalanx
