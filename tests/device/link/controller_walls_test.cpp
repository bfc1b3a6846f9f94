// SPDX-License-Identifier: Apache-2.0
#include "device/link/controller_rig.h"
#include "phalanx/force/local_wall.h"

namespace phalanx::link_test {
namespace {

/// The index finger's first wall, on joint 5, which stands at q_ref = 0.1 rad (raw 100):
///   k = 500 N/m, d_ref = 2 mm, g = 50 mm, f_max = 2 N, and the host's torque holds 1 N of it: 0.05 Nm.
class LinkWalls : public LinkController {
 protected:
  phx_message wall_command() {
    phx_message message = rig.next_command(0.05F);
    const phx_command command = message.as.command;
    message.header.type = PHX_COMMAND_WALLS;
    message.as.walls = {};
    message.as.walls.command = command;
    message.as.walls.valid_us = 6000;
    message.as.walls.q_ref[kJoint] = 0.1F;
    message.as.walls.wall[3] = {{0.0F, 0.05F, 0.0F, 0.0F}, 0.002F, 500.0F, 2.0F, 1.0F};
    return message;
  }
  void act() {
    rig.raw[1] = 100;
    rig.open();
    for (int i = 0; i <= 1000; ++i) drive();
    ASSERT_EQ(rig.sample.state, PHX_STATE_ACTIVE);
  }
  float drive() {
    rig.send(wall_command());
    return rig.tick();
  }
  /// Torque once the rate limit has let it through, with the joint at `raw` counts of 1 mrad.
  float settled(std::int32_t raw) {
    rig.raw[1] = raw;
    for (int i = 0; i < 20; ++i) drive();
    return rig.output.torque[kJoint];
  }
};

// At q_ref: 500 N/m * 2 mm = 1 N, the host's own.
TEST_F(LinkWalls, AddNothingAtTheReference) {
  act();
  EXPECT_NEAR(rig.output.torque[kJoint], 0.05F, 1e-6F);
}

// 10 mrad further open: depth 2 mm - 50 mm * 0.01 = 1.5 mm, 0.75 N, 0.0375 Nm.
TEST_F(LinkWalls, FollowTheAngleBetweenTwoSteps) {
  act();
  EXPECT_NEAR(settled(110), 0.0375F, 1e-6F);
  EXPECT_NEAR(settled(90), 0.0625F, 1e-6F);
}

TEST_F(LinkWalls, NeverPullAndNeverPushHarderThanTheirMost) {
  act();
  EXPECT_NEAR(settled(400), 0.0F, 1e-6F);   // 0.05 - 0.05 * 1 N
  EXPECT_NEAR(settled(-900), 0.1F, 1e-6F);  // 2 N
}

TEST_F(LinkWalls, HoldForTheirTimeAndThenLeaveTheHostsTorque) {
  act();
  settled(110);
  rig.send(wall_command());
  for (int age = 1; age <= 6; ++age) EXPECT_NEAR(rig.tick(), 0.0375F, 1e-6F) << age << " ms";
  EXPECT_NEAR(rig.tick(), 0.0475F, 1e-6F);  // the way back is rate-limited: 0.01 Nm a tick
  EXPECT_NEAR(rig.tick(), 0.05F, 1e-6F);
}

TEST_F(LinkWalls, EndWithACommandWithoutWalls) {
  act();
  settled(110);
  EXPECT_NEAR(rig.drive(0.05F, 5), 0.05F, 1e-6F);
}

// The tick comes in the very microsecond of the sample that the command names: from 0.0375 Nm the rate lets
// 0.01 Nm through.
TEST_F(LinkWalls, EndWithACommandWithoutWallsOfAgeZeroToo) {
  act();
  settled(110);
  rig.now += kPeriod;
  phx_message message = rig.next_command(0.05F);
  message.as.command.sample_time_us = rig.now;
  ASSERT_EQ(rig.send(message), PHX_USED);
  EXPECT_NEAR(rig.tick(0), 0.0475F, 1e-6F);
}

TEST_F(LinkWalls, TakeAnUnmeasuredJointToStandAtItsReference) {
  rig.controller.device.channel_count = 1;  // joint 5 is not measured any more
  act();
  EXPECT_NEAR(settled(400), 0.05F, 1e-6F);
}

TEST_F(LinkWalls, TakeAJointWhoseSensorIsOutOfRangeToStandAtItsReference) {
  act();
  rig.raw[1] = 5000;
  EXPECT_NEAR(drive(), 0.05F, 1e-6F);
  EXPECT_NEAR(drive(), 0.05F, 1e-6F);
  EXPECT_EQ(drive(), 0.0F);  // the third: latched
}

// A torque sensor on the same joint reads 400, which as an angle were 0.4 rad.
TEST_F(LinkWalls, TakeAnglesFromAngleChannelsAlone) {
  phx_device device = bench_device();
  device.channel[2] = {PHX_CHANNEL_TORQUE, 5, 0, 4095, 1e-3F, 0.0F};
  rig = Rig(device);
  rig.raw[2] = 400;
  act();
  EXPECT_NEAR(settled(110), 0.0375F, 1e-6F);
}

TEST_F(LinkWalls, TakeAChannelConfiguredWithGainZeroForUnmeasured) {
  rig.raw[1] = 100;
  rig.hello();
  phx_message configure = rig.frame(PHX_CONFIGURE);
  configure.as.configure.torque_limit = kLimit;
  configure.as.configure.torque_rate = kRate;
  rig.send(configure);
  rig.tick();
  for (int i = 0; i <= 1000; ++i) drive();
  EXPECT_NEAR(settled(400), 0.05F, 1e-6F);
}

// Raw 100 and an offset of 10 mrad are 0.11 rad: 10 mrad further open than q_ref, so again 0.75 N, 0.0375 Nm.
TEST_F(LinkWalls, AddTheConfiguredOffsetToTheAngle) {
  rig.raw[1] = 100;
  rig.hello();
  phx_message configure = rig.frame(PHX_CONFIGURE);
  configure.as.configure.gain[1] = 1e-3F;
  configure.as.configure.offset[1] = 0.01F;
  configure.as.configure.torque_limit = kLimit;
  configure.as.configure.torque_rate = kRate;
  rig.send(configure);
  rig.tick();
  for (int i = 0; i <= 1000; ++i) drive();
  EXPECT_NEAR(settled(100), 0.0375F, 1e-6F);
}

TEST_F(LinkWalls, StayWithinTheTorqueLimitAndRate) {
  act();
  rig.raw[1] = -3000;
  float last = rig.output.torque[kJoint];
  for (int i = 0; i < 100; ++i) {
    phx_message message = wall_command();
    message.as.walls.wall[3].force_max = 1e30F;
    message.as.walls.wall[3].stiffness = 1e30F;
    rig.send(message);
    const float torque = rig.tick();
    EXPECT_LE(torque, kLimit);
    EXPECT_LE(torque - last, 0.01F + 1e-6F);
    last = torque;
  }
  EXPECT_FLOAT_EQ(last, kLimit);
}

TEST_F(LinkWalls, GiveZeroWhereHugeNumbersMakeATorqueThatIsNotFinite) {
  act();
  for (int i = 0; i < 20; ++i) {
    phx_message message = wall_command();
    message.as.walls.wall[3] = {{0.0F, 3e38F, 0.0F, 0.0F}, 3e38F, 3e38F, 3e38F, 0.0F};
    rig.send(message);
    rig.tick();  // asserts finite
  }
  EXPECT_EQ(rig.output.torque[kJoint], 0.0F);
}

/// 20 measured joints and limits that nothing here reaches.
phx_device all_joints() {
  phx_device device = bench_device();
  device.channel_count = 20;
  for (std::size_t i = 0; i < 20; ++i)
    device.channel[i] = {PHX_CHANNEL_ANGLE, static_cast<std::uint8_t>(i), -4000, 4000, 1e-3F, 0.0F};
  device.torque_limit = 1e6F;
  device.torque_rate = 1e9F;
  return device;
}

LocalWall as_local(const phx_wall& wall) {
  LocalWall local;
  local.active = wall.stiffness > 0.0F;
  for (std::size_t i = 0; i < local.g.size(); ++i) local.g[i] = static_cast<double>(wall.g[i]);
  local.d_ref = static_cast<double>(wall.d_ref);
  local.stiffness = static_cast<double>(wall.stiffness);
  local.force_max = static_cast<double>(wall.force_max);
  local.host_force = static_cast<double>(wall.host_force);
  return local;
}

/// Torque of one joint as docs/architecture.md has it.
double expected_torque(const phx_command_walls& walls, const std::array<std::int32_t, PHX_CHANNELS>& raw,
                       std::size_t joint) {
  const std::size_t digit = joint / 4;
  double torque = static_cast<double>(walls.command.torque[joint]);
  DigitAngles q{};
  DigitAngles q_ref{};
  for (std::size_t i = 0; i < 4; ++i) {
    q[i] = 1e-3 * raw[4 * digit + i];
    q_ref[i] = static_cast<double>(walls.q_ref[4 * digit + i]);
  }
  for (std::size_t w = 3 * digit; w < 3 * digit + 3; ++w) {
    const LocalWall local = as_local(walls.wall[w]);
    if (local.active) torque += local.g[joint % 4] * (local_wall_force(local, q, q_ref) - local.host_force);
  }
  return torque;
}

TEST_F(LinkWalls, AreThoseOfLocalWallForEveryDigitAndJoint) {
  rig = Rig(all_joints());
  rig.hello();
  rig.configure(1e6F, 1e9F);
  rig.tick();
  rig.drive(0.1F, 1001);
  std::mt19937_64 random(641);
  for (int round = 0; round < 500; ++round) {
    for (std::size_t i = 0; i < 20; ++i) rig.raw[i] = static_cast<std::int32_t>(random() % 2000) - 1000;
    phx_message message = random_message(PHX_COMMAND_WALLS, random);
    phx_command_walls& walls = message.as.walls;
    message.header.epoch = rig.epoch;
    walls.command.tick = ++rig.host_tick;
    walls.command.sample_time_us = rig.sample.time_us;
    walls.command.flags = PHX_COMMAND_ENABLE;
    walls.valid_us = 5000;
    if (round % 3 == 0) walls.wall[random() % PHX_WALLS].stiffness = 0.0F;
    ASSERT_EQ(rig.send(message), PHX_USED);
    rig.tick();
    for (std::size_t joint = 0; joint < PHX_JOINTS; ++joint)
      ASSERT_NEAR(static_cast<double>(rig.output.torque[joint]), expected_torque(walls, rig.raw, joint), 2e-5)
          << "seed 641, round " << round << ", joint " << joint;
  }
}

}  // namespace
}  // namespace phalanx::link_test
