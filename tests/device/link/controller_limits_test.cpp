// SPDX-License-Identifier: Apache-2.0
// Torque limit, torque rate, finite numbers, whatever the commands, the sensors and the clock do.
#include <limits>
#include <utility>

#include "device/link/controller_rig.h"

namespace phalanx::link_test {
namespace {

class LinkLimits : public LinkController {};

TEST_F(LinkLimits, TheDevicesOwnHoldAgainstAHostThatAllowsMore) {
  rig.hello();
  rig.configure(100.0F, 1e6F);
  rig.tick();
  EXPECT_FLOAT_EQ(rig.drive(50.0F, 1001), kLimit);
  EXPECT_FLOAT_EQ(rig.drive(-50.0F, 1), kLimit - 0.01F);
}

TEST_F(LinkLimits, TheHostsHoldIfTheyAreSmaller) {
  rig.hello();
  rig.configure(0.1F, 2.0F);
  rig.tick();
  EXPECT_FLOAT_EQ(rig.drive(50.0F, 1001), 0.1F);
  EXPECT_NEAR(rig.drive(-50.0F, 1), 0.1F - 0.002F, 1e-6F);
}

TEST_F(LinkLimits, DoNotChangeUnderAnActingStep) {
  rig.open_and_act(0.4F);
  rig.configure(0.1F, 1.0F);
  EXPECT_FLOAT_EQ(rig.drive(0.4F, 10), 0.4F);
  rig.disable();
  rig.silent(100);
  rig.configure(0.1F, 1.0F);
  EXPECT_FLOAT_EQ(rig.drive(0.4F, 1001), 0.1F);
}

TEST_F(LinkLimits, OfZeroGiveZeroTorque) {
  for (const auto& [limit, rate] : {std::pair{0.0F, kRate}, std::pair{kLimit, 0.0F}}) {
    rig = Rig();
    rig.hello();
    EXPECT_EQ(rig.configure(limit, rate), PHX_USED) << limit;
    rig.tick();
    EXPECT_EQ(rig.drive(0.4F, 1100), 0.0F) << limit;
  }
}

TEST_F(LinkLimits, OfADeviceThatAreNoNumbersGiveZeroTorque) {
  for (float phx_device::* number : {&phx_device::torque_limit, &phx_device::torque_rate}) {
    for (const float none :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.0F}) {
      phx_device device = bench_device();
      device.*number = none;
      rig = Rig(device);
      rig.open();
      EXPECT_EQ(rig.drive(0.4F, 1100), 0.0F) << none;
    }
  }
}

TEST_F(LinkLimits, TheRateCountsTheRealTimeSinceTheLastTickButAtMostTwoPeriods) {
  rig.open_and_act(0.0F);
  float last = 0.0F;
  for (const std::uint64_t after : {1000U, 500U, 0U, 2000U, 9000U}) {
    rig.command(0.4F);
    const float torque = rig.tick(after);
    EXPECT_NEAR(torque - last, kRate * 1e-6F * static_cast<float>(std::min<std::uint64_t>(after, 2000)),
                1e-6F);
    last = torque;
  }
}

// Without a rate a period is a millisecond: 0.01 Nm, and at most two of them.
TEST_F(LinkLimits, OfADeviceThatNamesNoRateCountMilliseconds) {
  rig.open_and_act(0.0F);
  rig.controller.device.rate_hz = 0;
  rig.command(0.4F);
  EXPECT_NEAR(rig.tick(1000), 0.01F, 1e-6F);
  rig.command(0.4F);
  EXPECT_NEAR(rig.tick(9000), 0.03F, 1e-6F);
}

TEST_F(LinkLimits, TheRateCountsOnePeriodIfTheClockHasRunBackwards) {
  rig.open_and_act(0.0F);
  rig.tick(3000);
  phx_message command = rig.next_command(0.4F);
  rig.now -= 2500;  // before the last tick, after the sample that the command names
  command.as.command.sample_time_us = rig.now - 500;
  rig.send(command);
  EXPECT_NEAR(rig.tick(1000), 0.01F, 1e-6F);
}

// If the torque of the last tick is not a number (a fault of the memory), the torque begins at zero and rises
// by the rate.
TEST_F(LinkLimits, HoldWhereTheTorqueOfTheLastTickIsNoNumber) {
  rig.open_and_act(0.3F);
  rig.controller.torque[kJoint] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(rig.drive(0.3F, 1), 0.0F);
  EXPECT_NEAR(rig.drive(0.3F, 1), 0.01F, 1e-6F);
}

TEST_F(LinkLimits, TheStepFromOneTorqueToItsOppositeTakesTheRatesTime) {
  rig.open_and_act(0.5F);
  for (int i = 1; i <= 100; ++i)
    EXPECT_NEAR(rig.drive(-0.5F, 1), 0.5F - 0.01F * static_cast<float>(i), 1e-5F);
  EXPECT_FLOAT_EQ(rig.drive(-0.5F, 2), -0.5F);
}

/// One random frame of a host that knows the epoch, with numbers from 0 to the largest.
phx_message wild_command(Rig& rig, std::mt19937_64& random) {
  const std::uint8_t type = random() % 2 == 0 ? PHX_COMMAND : PHX_COMMAND_WALLS;
  phx_message message = random_message(type, random);
  phx_command& command = type == PHX_COMMAND ? message.as.command : message.as.walls.command;
  message.header.epoch = rig.epoch;
  command.tick = random() % 10 == 0 ? rig.host_tick : ++rig.host_tick;
  command.sample_time_us = rig.sample.time_us - (random() % 20 == 0 ? random() % 30000 : 0);
  command.flags = random() % 200 == 0 ? 0 : PHX_COMMAND_ENABLE;
  const float scale = std::ldexp(1.0F, static_cast<int>(random() % 128));
  for (float& torque : command.torque) torque *= scale;
  if (type == PHX_COMMAND) return message;
  message.as.walls.valid_us %= 10000;
  for (phx_wall& wall : message.as.walls.wall) {
    for (float& g : wall.g) g *= scale;
    wall.stiffness = wall.stiffness / 2000.0F * scale;
    wall.force_max = wall.force_max / 10.0F * scale;
  }
  return message;
}

// The torque may jump towards zero (fade, latch), but never away from it faster than the rate.
void expect_within_limits(const phx_output& last, const phx_output& now, std::uint64_t after) {
  const float most = kRate * 1e-6F * static_cast<float>(std::min<std::uint64_t>(after, 2000)) + 1e-6F;
  for (std::size_t i = 0; i < PHX_JOINTS; ++i) {
    ASSERT_LE(std::fabs(now.torque[i]), kLimit);
    ASSERT_LE(now.torque[i], std::max(last.torque[i], 0.0F) + most);
    ASSERT_GE(now.torque[i], std::min(last.torque[i], 0.0F) - most);
  }
}

TEST_F(LinkLimits, GiveWayToAHostInFaultWhoseTorqueIsZeroWithinFiveMilliseconds) {
  rig.open_and_act(kLimit);
  for (int i = 1; i <= 5; ++i) {
    phx_message message = rig.next_command(kLimit);  // whatever torque it still names
    message.as.command.flags = PHX_COMMAND_FAULT;
    rig.send(message);
    EXPECT_NEAR(rig.tick(), kLimit * (1.0F - 0.2F * static_cast<float>(i)), 1e-5F) << i;
  }
  EXPECT_FLOAT_EQ(rig.output.torque[kJoint], 0.0F);
  EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
  EXPECT_EQ(rig.sample.fault, PHX_FAULT_NONE);
}

TEST_F(LinkLimits, HoldUnderRandomCommandsSensorsAndTicks) {
  std::mt19937_64 random(651);
  rig.open();
  int acting = 0;
  for (int i = 0; i < 60000; ++i) {
    SCOPED_TRACE("seed 651, tick " + std::to_string(i));
    const phx_output last = rig.output;
    for (std::int32_t& raw : rig.raw) raw = static_cast<std::int32_t>(random() % 4000);
    if (random() % 3000 == 0) rig.raw[0] = 1 << 30;
    rig.estop = random() % 3000 == 0;
    if (random() % 4 != 0) rig.send(wild_command(rig, random));
    if (random() % 50 == 0) rig.send(rig.frame(PHX_RESET));
    const std::uint64_t after = random() % 10 == 0 ? random() % 4000 : kPeriod;
    rig.tick(after);
    expect_within_limits(last, rig.output, after);
    if (HasFatalFailure()) return;
    if (rig.sample.state >= PHX_STATE_STARTING && rig.sample.state <= PHX_STATE_FADING) ++acting;
  }
  EXPECT_GT(acting, 10000);  // or the test has tested nothing
}

TEST_F(LinkLimits, HoldUnderRandomBytes) {
  std::mt19937_64 random(652);
  rig.open();
  for (int i = 0; i < 20000; ++i) {
    Bytes bytes(random() % 1100);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    EXPECT_EQ(rig.receive(bytes), PHX_DROPPED);
  }
  EXPECT_EQ(rig.controller.corrupt, 20000U);
  EXPECT_EQ(rig.tick(), 0.0F);
  EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
}

}  // namespace
}  // namespace phalanx::link_test
