// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/link/messages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>

namespace phalanx {
namespace {

/// Through the bytes of a frame and back.
phx_message over_the_wire(phx_message message) {
  message.header.epoch = 9;
  message.header.sequence = 3;
  std::array<std::uint8_t, PHX_FRAME_MAX> frame{};
  const std::size_t size = phx_encode(&message, frame.data(), frame.size());
  EXPECT_GT(size, 0U);
  phx_message out{};
  EXPECT_EQ(phx_decode(frame.data(), size, &out), PHX_OK);
  return out;
}

DeviceCommand a_command() {
  DeviceCommand command;
  command.tick = 12345678901ULL;
  command.sample_time_us = 98765432109ULL;
  command.enable = true;
  for (std::size_t j = 0; j < command.torque.size(); ++j) {
    command.torque[j] = 0.03125 * static_cast<double>(j) - 0.25;
    command.hcp_angle[j] = 0.0625 * static_cast<double>(j);
  }
  return command;
}

TEST(LinkMessages, ACommandKeepsItsNumbers) {
  const DeviceCommand command = a_command();
  phx_message message{};
  write_command(command, message);
  const phx_message out = over_the_wire(message);
  ASSERT_EQ(out.header.type, PHX_COMMAND);
  EXPECT_EQ(out.as.command.tick, command.tick);
  EXPECT_EQ(out.as.command.sample_time_us, command.sample_time_us);
  EXPECT_EQ(out.as.command.flags, PHX_COMMAND_ENABLE);
  for (std::size_t j = 0; j < kJoints; ++j)
    EXPECT_EQ(static_cast<double>(out.as.command.torque[j]), command.torque[j]);
}

TEST(LinkMessages, AnEnabledCommandOfAHostInFaultSaysFaultAlone) {
  DeviceCommand command = a_command();
  command.fault = true;
  phx_message message{};
  write_command(command, message);
  EXPECT_EQ(message.as.command.flags, PHX_COMMAND_FAULT);
}

TEST(LinkMessages, ACommandWithAWallCarriesAllOfThem) {
  DeviceCommand command = a_command();
  command.enable = false;
  command.wall_valid_for = 0.0075;
  LocalWall& wall = command.wall[static_cast<std::size_t>(segment_index(3, 2))];
  wall = {.active = true, .g = {-0.5, 0.25, -0.125, 2.0}, .d_ref = 0.5, .stiffness = 500.0};
  wall.force_max = 5.0;
  wall.host_force = 2.5;
  command.wall[0].stiffness = 700.0;  // not active
  phx_message message{};
  write_command(command, message);
  const phx_message out = over_the_wire(message);
  ASSERT_EQ(out.header.type, PHX_COMMAND_WALLS);
  EXPECT_EQ(out.as.walls.command.tick, command.tick);
  EXPECT_EQ(out.as.walls.command.flags, 0);
  EXPECT_EQ(out.as.walls.valid_us, 7500U);
  EXPECT_EQ(static_cast<double>(out.as.walls.q_ref[5]), command.hcp_angle[5]);
  const phx_wall& there = out.as.walls.wall[11];
  EXPECT_EQ(there.g[3], 2.0F);
  EXPECT_EQ(there.d_ref, 0.5F);
  EXPECT_EQ(there.stiffness, 500.0F);
  EXPECT_EQ(there.force_max, 5.0F);
  EXPECT_EQ(there.host_force, 2.5F);
  for (std::size_t w = 0; w < PHX_WALLS; ++w)
    if (w != 11) {
      EXPECT_EQ(out.as.walls.wall[w].stiffness, 0.0F) << w;
    }
}

TEST(LinkMessages, WithoutTimeOrAnActiveWallThereAreNone) {
  phx_message message{};
  DeviceCommand command = a_command();
  command.wall_valid_for = 0.01;
  write_command(command, message);
  EXPECT_EQ(message.header.type, PHX_COMMAND) << "none is active";
  command.wall[4].active = true;
  for (const double none : {0.0, -1.0, std::nan("")}) {
    command.wall_valid_for = none;
    write_command(command, message);
    EXPECT_EQ(message.header.type, PHX_COMMAND) << none;
  }
  command.wall_valid_for = std::numeric_limits<double>::infinity();
  write_command(command, message);
  EXPECT_EQ(message.header.type, PHX_COMMAND_WALLS);
  EXPECT_EQ(message.as.walls.valid_us, 1000000U);
}

TEST(LinkMessages, ASampleKeepsItsNumbers) {
  phx_message message{};
  message.header.type = PHX_SAMPLE;
  phx_sample& in = message.as.sample;
  in.time_us = 5555;
  in.acted_tick = 44;
  in.state = PHX_STATE_LATCHED;
  in.flags = PHX_SAMPLE_ESTOP | PHX_SAMPLE_CONFIGURED;
  in.fault = PHX_FAULT_SENSOR_RANGE;
  in.fault_channel = 7;
  in.factor = 0.5F;
  for (int c = 0; c < 32; ++c) in.raw[c] = 1000 * c - 7;
  const DeviceSample out = read_sample(over_the_wire(message), 1.25);
  EXPECT_EQ(out.sequence, 3U);
  EXPECT_EQ(out.time_us, 5555U);
  EXPECT_EQ(out.received, 1.25);
  EXPECT_EQ(out.acted_tick, 44U);
  EXPECT_EQ(out.state, DeviceState::kLatched);
  EXPECT_TRUE(out.estop);
  EXPECT_EQ(out.fault, Fault::kSensorRange);
  EXPECT_EQ(out.fault_channel, 7);
  EXPECT_EQ(out.factor, 0.5);
  EXPECT_EQ(out.raw[31], 30993);
}

TEST(LinkMessages, AControllerIsReadyOnceItIsConfigured) {
  phx_message message{};
  message.header.type = PHX_SAMPLE;
  message.as.sample.state = PHX_STATE_READY;
  EXPECT_EQ(read_sample(message, 0.0).state, DeviceState::kConnecting);
  message.as.sample.flags = PHX_SAMPLE_CONFIGURED;
  EXPECT_EQ(read_sample(message, 0.0).state, DeviceState::kReady);
  message.as.sample.state = PHX_STATE_NO_SESSION;
  EXPECT_EQ(read_sample(message, 0.0).state, DeviceState::kConnecting);
  message.as.sample.fault = PHX_FAULT_DRIVE;
  EXPECT_EQ(read_sample(message, 0.0).fault_channel, -1) << "a drive has no channel";
}

// From 64 on the numbers are the host's own: a device that sends one means something of its own.
TEST(LinkMessages, AFaultFromSixtyFourOnIsTheDevicesDrive) {
  phx_message message{};
  message.header.type = PHX_SAMPLE;
  message.as.sample.fault_channel = 7;
  message.as.sample.fault = 63;
  EXPECT_EQ(read_sample(message, 0.0).fault, static_cast<Fault>(63));
  EXPECT_EQ(read_sample(message, 0.0).fault_channel, -1);
  for (const std::uint16_t number : {std::uint16_t{64}, std::uint16_t{65}}) {
    message.as.sample.fault = number;
    EXPECT_EQ(read_sample(message, 0.0).fault, Fault::kDrive) << number;
    EXPECT_EQ(read_sample(message, 0.0).fault_channel, -1) << number;
  }
}

TEST(LinkMessages, ChannelsAndSerialNumberComeBack) {
  const DeviceChannel channel{
      .kind = ChannelKind::kMotor, .index = 3, .raw_min = -70, .raw_max = 90, .gain = 0.5, .offset = -2.0};
  phx_message message{};
  message.header.type = PHX_WELCOME;
  message.as.welcome.rate_hz = 500;
  message.as.welcome.channel_count = 1;
  message.as.welcome.channel[0] = link_channel(channel);
  write_serial("PX-0001", message.as.welcome.serial);
  const DeviceInfo info = device_info(over_the_wire(message).as.welcome);
  EXPECT_EQ(info.serial, "PX-0001");
  EXPECT_EQ(info.rate_hz, 500.0);
  ASSERT_EQ(info.channels.size(), 1U);
  EXPECT_EQ(info.channels[0].kind, channel.kind);
  EXPECT_EQ(info.channels[0].index, channel.index);
  EXPECT_EQ(info.channels[0].raw_min, channel.raw_min);
  EXPECT_EQ(info.channels[0].raw_max, channel.raw_max);
  EXPECT_EQ(info.channels[0].gain, channel.gain);
  EXPECT_EQ(info.channels[0].offset, channel.offset);
}

TEST(LinkMessages, ALongSerialNumberIsCut) {
  struct {
    char serial[PHX_SERIAL_SIZE];
    char behind[PHX_SERIAL_SIZE];
  } place;
  std::fill(std::begin(place.serial), std::end(place.serial), 'x');
  std::fill(std::begin(place.behind), std::end(place.behind), 'x');
  write_serial("0123456789abcdefghij", place.serial);
  EXPECT_EQ(read_serial(place.serial), "0123456789abcdef");
  EXPECT_EQ(std::string(place.behind, PHX_SERIAL_SIZE), std::string(PHX_SERIAL_SIZE, 'x'));
  write_serial("PX", place.serial);
  EXPECT_EQ(std::string(place.serial, PHX_SERIAL_SIZE), "PX" + std::string(PHX_SERIAL_SIZE - 2, '\0'));
}

TEST(LinkMessages, ConfigureCarriesTheCalibration) {
  const std::vector<DeviceChannel> channels{{.gain = 0.5, .offset = 1.5}, {.gain = -0.25, .offset = 0.0}};
  const phx_message out = over_the_wire(configure_message(channels, 0.5, 10.0));
  ASSERT_EQ(out.header.type, PHX_CONFIGURE);
  EXPECT_EQ(out.as.configure.gain[0], 0.5F);
  EXPECT_EQ(out.as.configure.offset[0], 1.5F);
  EXPECT_EQ(out.as.configure.gain[1], -0.25F);
  EXPECT_EQ(out.as.configure.gain[2], 0.0F);
  EXPECT_EQ(out.as.configure.torque_limit, 0.5F);
  EXPECT_EQ(out.as.configure.torque_rate, 10.0F);
}

}  // namespace
}  // namespace phalanx
