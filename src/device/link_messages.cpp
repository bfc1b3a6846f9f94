// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/link/messages.h"

#include <algorithm>
#include <cmath>

namespace phalanx {
namespace {

static_assert(PHX_JOINTS == kJoints && PHX_CHANNELS == kMaxChannels && PHX_WALLS == kSegments - 1 &&
              PHX_WALL_JOINTS == kJointsPerDigit);
static_assert(static_cast<int>(ChannelKind::kAngle) == PHX_CHANNEL_ANGLE &&
              static_cast<int>(ChannelKind::kTorque) == PHX_CHANNEL_TORQUE &&
              static_cast<int>(ChannelKind::kForce) == PHX_CHANNEL_FORCE &&
              static_cast<int>(ChannelKind::kMotor) == PHX_CHANNEL_MOTOR &&
              static_cast<int>(ChannelKind::kCurl) == PHX_CHANNEL_CURL &&
              static_cast<int>(ChannelKind::kSplay) == PHX_CHANNEL_SPLAY);
static_assert(static_cast<int>(Fault::kStepTooOld) == PHX_FAULT_STEP_TOO_OLD &&
              static_cast<int>(Fault::kSensorRange) == PHX_FAULT_SENSOR_RANGE &&
              static_cast<int>(Fault::kEmergencyStop) == PHX_FAULT_EMERGENCY_STOP &&
              static_cast<int>(Fault::kDrive) == PHX_FAULT_DRIVE);

float single(double x) noexcept { return static_cast<float>(x); }

/// Bound of a wall's validity, far above ordinary ones; larger and infinite values are replaced by it [s].
constexpr double kLongestValidity = 1.0;

std::uint32_t validity_us(double seconds) noexcept {
  if (!(seconds > 0.0)) return 0;
  return static_cast<std::uint32_t>(std::lround(std::min(seconds, kLongestValidity) * 1e6));
}

/// Converts the state. A controller without a session or calibration is still connecting.
DeviceState state_of(const phx_sample& sample) noexcept {
  switch (sample.state) {
    case PHX_STATE_READY:
      return (sample.flags & PHX_SAMPLE_CONFIGURED) != 0 ? DeviceState::kReady : DeviceState::kConnecting;
    case PHX_STATE_STARTING:
      return DeviceState::kStarting;
    case PHX_STATE_ACTIVE:
      return DeviceState::kActive;
    case PHX_STATE_FADING:
      return DeviceState::kFading;
    case PHX_STATE_LATCHED:
      return DeviceState::kLatched;
    default:
      return DeviceState::kConnecting;
  }
}

void write_wall(const LocalWall& wall, phx_wall& out) noexcept {
  out = {};
  if (!wall.active) return;
  std::transform(wall.g.begin(), wall.g.end(), out.g, single);
  out.d_ref = single(wall.d_ref);
  out.stiffness = single(wall.stiffness);
  out.force_max = single(wall.force_max);
  out.host_force = single(wall.host_force);
}

}  // namespace

void write_command(const DeviceCommand& command, phx_message& message) noexcept {
  const std::uint32_t valid_us = validity_us(command.wall_valid_for);
  const bool walls = valid_us > 0 && std::any_of(command.wall.begin(), command.wall.end(),
                                                 [](const LocalWall& wall) { return wall.active; });
  message.header.type = walls ? PHX_COMMAND_WALLS : PHX_COMMAND;
  phx_command& out = walls ? message.as.walls.command : message.as.command;
  out.tick = command.tick;
  out.sample_time_us = command.sample_time_us;
  out.flags = static_cast<std::uint8_t>(command.fault    ? PHX_COMMAND_FAULT
                                        : command.enable ? PHX_COMMAND_ENABLE
                                                         : 0U);
  std::transform(command.torque.begin(), command.torque.end(), out.torque, single);
  if (!walls) return;
  message.as.walls.valid_us = valid_us;
  std::transform(command.hcp_angle.begin(), command.hcp_angle.end(), message.as.walls.q_ref, single);
  for (std::size_t w = 0; w < PHX_WALLS; ++w) write_wall(command.wall[w], message.as.walls.wall[w]);
}

DeviceSample read_sample(const phx_message& message, double received) noexcept {
  const phx_sample& in = message.as.sample;
  DeviceSample out;
  out.sequence = message.header.sequence;
  out.time_us = in.time_us;
  out.received = received;
  std::copy(std::begin(in.raw), std::end(in.raw), out.raw.begin());
  out.state = state_of(in);
  // From kNoSample on, the numbers are the host's own: from a device, such a number is an unknown fault.
  out.fault =
      in.fault < static_cast<std::uint16_t>(Fault::kNoSample) ? static_cast<Fault>(in.fault) : Fault::kDrive;
  out.fault_channel = in.fault == PHX_FAULT_SENSOR_RANGE ? in.fault_channel : -1;
  out.estop = (in.flags & PHX_SAMPLE_ESTOP) != 0;
  out.factor = static_cast<double>(in.factor);
  out.acted_tick = in.acted_tick;
  return out;
}

phx_message configure_message(std::span<const DeviceChannel> channels, double torque_limit,
                              double torque_rate) noexcept {
  phx_message message{};
  message.header.type = PHX_CONFIGURE;
  for (std::size_t c = 0; c < std::min(channels.size(), kMaxChannels); ++c) {
    message.as.configure.gain[c] = single(channels[c].gain);
    message.as.configure.offset[c] = single(channels[c].offset);
  }
  message.as.configure.torque_limit = single(torque_limit);
  message.as.configure.torque_rate = single(torque_rate);
  return message;
}

DeviceInfo device_info(const phx_welcome& welcome) {
  DeviceInfo info;
  info.serial = read_serial(welcome.serial);
  info.name = info.serial;
  info.rate_hz = welcome.rate_hz;
  info.simulated = (welcome.flags & PHX_WELCOME_SIMULATED) != 0;
  info.own_clock = true;
  info.watchdog = 1e-6 * PHX_LATCH_AGE_US;  // as the link prescribes
  for (std::size_t c = 0; c < std::min<std::size_t>(welcome.channel_count, kMaxChannels); ++c) {
    const phx_channel& channel = welcome.channel[c];
    info.channels.push_back({.kind = static_cast<ChannelKind>(channel.kind),
                             .index = channel.index,
                             .raw_min = channel.raw_min,
                             .raw_max = channel.raw_max,
                             .gain = static_cast<double>(channel.gain),
                             .offset = static_cast<double>(channel.offset)});
  }
  return info;
}

phx_channel link_channel(const DeviceChannel& channel) noexcept {
  phx_channel out{};
  out.kind = static_cast<std::uint8_t>(channel.kind);
  out.index = static_cast<std::uint8_t>(channel.index);
  out.raw_min = channel.raw_min;
  out.raw_max = channel.raw_max;
  out.gain = single(channel.gain);
  out.offset = single(channel.offset);
  return out;
}

void write_serial(const std::string& serial, char (&out)[PHX_SERIAL_SIZE]) noexcept {
  std::fill(std::begin(out), std::end(out), '\0');
  std::copy_n(serial.begin(), std::min<std::size_t>(serial.size(), PHX_SERIAL_SIZE), out);
}

std::string read_serial(const char (&serial)[PHX_SERIAL_SIZE]) {
  return {std::begin(serial), std::find(std::begin(serial), std::end(serial), '\0')};
}

}  // namespace phalanx
