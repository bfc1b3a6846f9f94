// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/simulated_controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulation/squeezing_device.h"
#include "support/count_allocations.h"

namespace phalanx::test {
namespace {

constexpr int kHolding = 4000;  ///< ticks until the patient has pressed and holds; he lets go at 4300

SimulatedController controller_of(const SimulatedDeviceSettings& settings = squeezing_settings()) {
  return {settings, "test", 100};
}

// The patient is meant to reach 3 N at rest on a wall of 500 N/m: g f = (-0.15, -0.06) Nm.
TEST(SimulatedController, ASqueezeIsFeltAtTheJoints) {
  SimulatedController controller = controller_of();
  MemoryHost host(controller);
  ASSERT_TRUE(host.open());
  host.run(200);
  EXPECT_EQ(host.torque(kMcp), 0.0) << "nothing is touched yet";
  host.run(kHolding - 200);
  EXPECT_EQ(host.sample().state, PHX_STATE_ACTIVE);
  EXPECT_NEAR(host.torque(kMcp), -0.15, 0.0015);
  EXPECT_NEAR(host.torque(kPip), -0.06, 0.0006);
  EXPECT_NEAR(controller.exoskeleton().plant().tendon_torque()[idx(kMcp)], -0.15, 0.0015);
  host.run(1200);
  EXPECT_EQ(host.torque(kMcp), 0.0) << "he has let go";
  host.run(2000);
  EXPECT_LT(host.torque(kMcp), -0.1) << "and squeezes again";
}

// His hand does not stop for want of a host: without torque he moves through to where he intends to be.
TEST(SimulatedController, ThePatientSqueezesWithoutAHost) {
  SimulatedController controller = controller_of();
  const double start = controller.exoskeleton().plant().angle()[idx(kMcp)];
  for (int i = 0; i < kHolding; ++i) {
    const phx_output& output = controller.tick({});
    ASSERT_EQ(output.sample_size, 0U) << "no session, no sample";
  }
  const DigitPress press = *plan_on_paper().digit[kIndex];
  const double deep = 3.0 * (1.0 / press.stiffness + 1.0 / kWall);
  const double intended = press.contact[idx(kMcp)] + press.into[idx(kMcp)] * deep;
  EXPECT_NEAR(controller.exoskeleton().plant().angle()[idx(kMcp)], intended, 1e-6);
  EXPECT_GT(intended, start + 0.3);
}

TEST(SimulatedController, WithoutCommandsTheTorqueIsZeroAfterTwentyTicks) {
  SimulatedController controller = controller_of();
  MemoryHost host(controller);
  ASSERT_TRUE(host.open());
  host.run(kHolding);
  ASSERT_LT(host.torque(kMcp), -0.14);
  host.silent = true;
  int ticks = 0;
  while (host.largest_torque() > 0.0 && ticks < 100) {
    host.tick();
    ++ticks;
  }
  EXPECT_LE(controller.time_us() - host.acted_on_us(), 20000U);
  EXPECT_GT(controller.time_us() - host.acted_on_us(), PHX_HOLD_AGE_US) << "it did not let go too early";
  host.tick();
  EXPECT_EQ(host.sample().state, PHX_STATE_LATCHED);
  EXPECT_EQ(host.sample().fault, PHX_FAULT_STEP_TOO_OLD);
  host.silent = false;
  for (int i = 0; i < 100; ++i) {
    host.tick();
    ASSERT_EQ(host.largest_torque(), 0.0) << "latched until reset";
  }
  host.reset();
  host.run(100);
  EXPECT_EQ(host.sample().state, PHX_STATE_STARTING);
}

TEST(SimulatedController, ARestartEndsTheSessionAndLeavesTheHandWhereItIs) {
  SimulatedController controller = controller_of();
  MemoryHost host(controller);
  ASSERT_TRUE(host.open());
  host.run(kHolding);
  const JointArray angle = controller.exoskeleton().plant().angle();
  const std::uint64_t ticks = controller.ticks();
  controller.restart(200);
  EXPECT_EQ(controller.exoskeleton().plant().angle(), angle);
  EXPECT_EQ(controller.ticks(), ticks);
  EXPECT_EQ(controller.time_us(), 0U);
  for (int i = 0; i < 50; ++i) {
    host.tick();  // it goes on with commands of the old session
    ASSERT_EQ(host.largest_torque(), 0.0);
    ASSERT_EQ(controller.output().sample_size, 0U);
  }
  EXPECT_EQ(controller.time_us(), 50000U);
  EXPECT_EQ(controller.controller().refused, 10U) << "a command every 5 ticks";
  ASSERT_TRUE(host.open());
  host.run(10);
  EXPECT_EQ(host.sample().state, PHX_STATE_STARTING);
}

TEST(SimulatedController, TicksThatAProcessMissedAgeTheStep) {
  SimulatedController controller = controller_of();
  MemoryHost host(controller);
  ASSERT_TRUE(host.open());
  host.run(kHolding);
  const std::uint64_t before = controller.time_us();
  controller.skip(50);
  host.tick();
  EXPECT_EQ(controller.time_us(), before + 51000U);
  EXPECT_EQ(controller.ticks(), static_cast<std::uint64_t>(kHolding) + 1U);
  EXPECT_EQ(host.largest_torque(), 0.0);
  EXPECT_EQ(host.sample().fault, PHX_FAULT_STEP_TOO_OLD);
}

TEST(SimulatedController, TheClockStartsAboveZeroAndGoesBackwardsIfBroken) {
  SimulatedController controller = controller_of();
  EXPECT_EQ(controller.time_us(), 0U);
  for (int i = 0; i < 5; ++i) controller.tick({});
  EXPECT_EQ(controller.time_us(), 5000U);
  const SimulatedBreakage backwards{.clock_backwards = true};
  controller.tick(backwards);
  EXPECT_EQ(controller.time_us(), 4000U);
  for (int i = 0; i < 10; ++i) controller.tick(backwards);
  EXPECT_EQ(controller.time_us(), 0U);
}

/// What the broken channel reads in the last of some ticks, and what a whole one reads there.
std::pair<std::int32_t, std::int32_t> broken_and_true(const SimulatedBreakage& breakage, int channel,
                                                      int ticks = 3) {
  SimulatedController controller = controller_of();
  MemoryHost host(controller);
  EXPECT_TRUE(host.open());
  host.enable = false;
  host.run(500);  // on the way to the object
  host.run(ticks, breakage);
  SimulatedController whole = controller_of();
  MemoryHost other(whole);
  EXPECT_TRUE(other.open());
  other.enable = false;
  other.run(500 + ticks);
  for (int c = 0; c < 6; ++c)
    if (c != channel) {
      EXPECT_EQ(host.sample().raw[c], other.sample().raw[c]) << c;
    }
  return {host.sample().raw[channel], other.sample().raw[channel]};
}

TEST(SimulatedController, AnOpenSensorReadsAboveAndAShortedOneBelowItsRange) {
  const std::vector<DeviceChannel> channels = controller_of().info().channels;
  for (const int c : {kMcpChannel, kMotorChannel, kTorqueChannel}) {
    EXPECT_EQ(broken_and_true({.open_channel = c}, c).first, channels[idx(c)].raw_max + 1000);
    EXPECT_EQ(broken_and_true({.shorted_channel = c}, c).first, channels[idx(c)].raw_min - 1000);
  }
}

TEST(SimulatedController, AJumpIsFiftyDegrees) {
  const auto [broken, expected] = broken_and_true({.jump_channel = kMcpChannel}, kMcpChannel);
  EXPECT_EQ(broken - expected, std::lround(50.0 * std::numbers::pi / 180.0 / 10e-6));
}

TEST(SimulatedController, AStuckSensorStandsStillWhileItsJointMoves) {
  const auto [early, moved_early] = broken_and_true({.stuck_channel = kMcpChannel}, kMcpChannel, 1);
  const auto [late, moved_late] = broken_and_true({.stuck_channel = kMcpChannel}, kMcpChannel, 50);
  EXPECT_EQ(early, late);
  EXPECT_GT(std::abs(moved_late - moved_early), 100) << "the joint has moved";
}

// 20 counts rms, seeded: over 400 ticks the mean square is within 5 standard errors of 400.
TEST(SimulatedController, ANoisyChannelGetsNoiseOfTheStatedSize) {
  SimulatedController noisy = controller_of();
  SimulatedController whole = controller_of();
  MemoryHost a(noisy), b(whole);
  ASSERT_TRUE(a.open());
  ASSERT_TRUE(b.open());
  a.enable = b.enable = false;
  double sum = 0.0;
  constexpr int kTicks = 400;
  for (int i = 0; i < kTicks; ++i) {
    a.tick({.noise_channel = kMcpChannel, .noise_counts = 20.0});
    b.tick();
    const double error = a.sample().raw[kMcpChannel] - b.sample().raw[kMcpChannel];
    sum += error * error;
  }
  EXPECT_NEAR(sum / kTicks, 400.0, 5.0 * 400.0 * std::sqrt(2.0 / kTicks));
}

TEST(SimulatedController, ADeadMotorDoesNothingAndItsTorqueSensorSaysSo) {
  SimulatedController controller = controller_of();
  MemoryHost host(controller);
  ASSERT_TRUE(host.open());
  host.run(kHolding - 500);
  host.run(500, {.dead_motor = 0});
  EXPECT_LT(host.torque(kMcp), -0.15) << "commanded, and more of it: he goes deeper";
  EXPECT_EQ(controller.exoskeleton().plant().tendon(0).motor_force, 0.0);
  EXPECT_LT(std::abs(host.sample().raw[kTorqueChannel] * 1e-4), 0.01);
  EXPECT_LT(host.sample().raw[kTorqueChannel + 1] * 1e-4, -0.05) << "the other motor pulls";
}

TEST(SimulatedController, EmergencyStopAndDriveFaultLatch) {
  for (const bool estop : {true, false}) {
    SimulatedController controller = controller_of();
    MemoryHost host(controller);
    ASSERT_TRUE(host.open());
    host.run(kHolding);
    host.tick(estop ? SimulatedBreakage{.estop = true} : SimulatedBreakage{.drive_fault = true});
    EXPECT_EQ(host.largest_torque(), 0.0);
    EXPECT_EQ(host.sample().fault, estop ? PHX_FAULT_EMERGENCY_STOP : PHX_FAULT_DRIVE);
    EXPECT_EQ((host.sample().flags & PHX_SAMPLE_ESTOP) != 0, estop);
    host.tick();
    EXPECT_EQ(host.sample().state, PHX_STATE_LATCHED) << "although it is gone";
  }
}

TEST(SimulatedController, ABreakageOfAChannelThatIsNotThereDoesNothing) {
  SimulatedController controller = controller_of();
  MemoryHost host(controller);
  ASSERT_TRUE(host.open());
  SimulatedController whole = controller_of();
  MemoryHost other(whole);
  ASSERT_TRUE(other.open());
  host.run(100, {.stuck_channel = 31, .open_channel = 6, .jump_channel = 99, .dead_motor = 2});
  other.run(100);
  EXPECT_EQ(host.sample().fault, PHX_FAULT_NONE);
  for (std::size_t c = 0; c < PHX_CHANNELS; ++c) EXPECT_EQ(host.sample().raw[c], other.sample().raw[c]) << c;
}

TEST(SimulatedController, TheSameSettingsGiveTheSameBits) {
  const auto raw = [] {
    SimulatedDeviceSettings settings = squeezing_settings();
    for (ExoJoint& joint : settings.exoskeleton.joints) joint.sensor_noise = 1e-4;
    settings.patient.tremor = 3e-5;
    SimulatedController controller = controller_of(settings);
    MemoryHost host(controller);
    EXPECT_TRUE(host.open());
    host.run(3000);
    return std::vector<std::int32_t>(std::begin(host.sample().raw), std::end(host.sample().raw));
  };
  EXPECT_EQ(raw(), raw());
}

TEST(SimulatedController, ATickAllocatesNothing) {
  SimulatedController controller = controller_of();
  MemoryHost host(controller);
  ASSERT_TRUE(host.open());
  const std::size_t before = allocations_of_this_thread();
  host.run(2000, {.noise_channel = 0, .noise_counts = 20.0});
  controller.restart(300);
  controller.skip(3);
  host.run(10);
  EXPECT_EQ(allocations_of_this_thread(), before);
}

TEST(SimulatedController, ARateThatTheLinkCannotCarryIsRefused) {
  SimulatedDeviceSettings settings = squeezing_settings();
  settings.exoskeleton.controller.rate_hz = 100000.0;
  EXPECT_THROW(controller_of(settings), std::invalid_argument);
}

}  // namespace
}  // namespace phalanx::test
