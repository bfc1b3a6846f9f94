// SPDX-License-Identifier: Apache-2.0
#include "device/link/frame_bytes.h"

namespace phalanx::link_test {
namespace {

float number(std::mt19937_64& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

template <typename T>
T any(std::mt19937_64& random) {
  return static_cast<T>(random());
}

void fill(phx_welcome& welcome, std::mt19937_64& random) {
  welcome.host_id = random();
  for (char& letter : welcome.serial) letter = static_cast<char>('A' + random() % 26);
  welcome.rate_hz = static_cast<std::uint16_t>(1 + random() % 2000);
  welcome.channel_count = static_cast<std::uint8_t>(random() % (PHX_CHANNELS + 1));
  welcome.flags = static_cast<std::uint8_t>(random() % 2);
  for (std::size_t i = 0; i < welcome.channel_count; ++i) {
    phx_channel& channel = welcome.channel[i];
    channel.kind = static_cast<std::uint8_t>(random() % 6);
    channel.index = static_cast<std::uint8_t>(random() % 5);
    channel.raw_min = any<std::int32_t>(random) / 2;
    channel.raw_max = channel.raw_min + static_cast<std::int32_t>(random() % 100000);
    channel.gain = number(random, 0.001F, 1.0F);
    channel.offset = number(random, -1.0F, 1.0F);
  }
}

void fill(phx_configure& configure, std::mt19937_64& random) {
  for (float& gain : configure.gain) gain = number(random, -1.0F, 1.0F);
  for (float& offset : configure.offset) offset = number(random, -1.0F, 1.0F);
  configure.torque_limit = number(random, 0.0F, 1.0F);
  configure.torque_rate = number(random, 0.0F, 20.0F);
}

void fill(phx_sample& sample, std::mt19937_64& random) {
  sample.time_us = random();
  sample.acted_tick = random();
  sample.acted_age_us = any<std::uint32_t>(random);
  sample.state = static_cast<std::uint8_t>(random() % 6);
  sample.flags = any<std::uint8_t>(random);
  sample.fault = any<std::uint16_t>(random);
  sample.fault_channel = static_cast<std::uint8_t>(random() % PHX_CHANNELS);
  sample.factor = number(random, 0.0F, 1.0F);
  sample.corrupt = any<std::uint32_t>(random);
  sample.refused = any<std::uint32_t>(random);
  sample.outdated = any<std::uint32_t>(random);
  for (std::int32_t& raw : sample.raw) raw = any<std::int32_t>(random);
}

void fill(phx_command& command, std::mt19937_64& random) {
  command.tick = random();
  command.sample_time_us = random();
  command.flags = any<std::uint8_t>(random);
  for (float& torque : command.torque) torque = number(random, -1.0F, 1.0F);
}

void fill(phx_command_walls& walls, std::mt19937_64& random) {
  fill(walls.command, random);
  walls.valid_us = any<std::uint32_t>(random);
  for (float& angle : walls.q_ref) angle = number(random, -1.0F, 1.0F);
  for (phx_wall& wall : walls.wall) {
    for (float& g : wall.g) g = number(random, -0.1F, 0.1F);
    wall.d_ref = number(random, -0.01F, 0.01F);
    wall.stiffness = number(random, 0.0F, 2000.0F);
    wall.force_max = number(random, 0.0F, 10.0F);
    wall.host_force = number(random, 0.0F, 10.0F);
  }
}

}  // namespace

phx_message random_message(std::uint8_t type, std::mt19937_64& random) {
  phx_message message{};
  message.header.type = type;
  message.header.epoch = any<std::uint32_t>(random);
  message.header.sequence = any<std::uint32_t>(random);
  switch (type) {
    case PHX_HELLO:
      message.as.hello.host_id = random();
      break;
    case PHX_WELCOME:
      fill(message.as.welcome, random);
      break;
    case PHX_REFUSED:
      message.as.refused = {random(), any<std::uint8_t>(random), any<std::uint8_t>(random)};
      break;
    case PHX_CONFIGURE:
      fill(message.as.configure, random);
      break;
    case PHX_SAMPLE:
      fill(message.as.sample, random);
      break;
    case PHX_COMMAND:
      fill(message.as.command, random);
      break;
    case PHX_COMMAND_WALLS:
      fill(message.as.walls, random);
      break;
    case PHX_PING:
    case PHX_PONG:
      message.as.ping = {random(), random()};
      break;
    default:
      break;
  }
  return message;
}

}  // namespace phalanx::link_test
