// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/simulated_channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "device/shown_range.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

constexpr double kAngleCount = 10e-6;  ///< if the sensor has no least significant bit [rad]
constexpr double kMotorCount = 1e-6;   ///< [m]
constexpr double kTorqueCount = 1e-4;  ///< [Nm]
constexpr double kMotorPlay = 5e-3;    ///< winding beyond the joints' angles: backlash and stretch [m]
/// Factor on the motor's torque that a sensor can still show: a rotor that is stopped pulls harder
/// than its motor.
constexpr double kTorqueReserve = 4.0;

/// Converts a value to counts, bounded to 32 bits. NaN reads as an open sensor does.
std::int32_t counts(double value, const DeviceChannel& channel) noexcept {
  const double raw = std::round((value - channel.offset) / channel.gain);
  using Limits = std::numeric_limits<std::int32_t>;
  if (!(raw < static_cast<double>(Limits::max()))) return Limits::max();
  if (raw < static_cast<double>(Limits::min())) return Limits::min();
  return static_cast<std::int32_t>(raw);
}

DeviceChannel channel_of(ChannelKind kind, int index, double gain, double low, double high) {
  DeviceChannel channel{.kind = kind, .index = index, .gain = gain};
  channel.raw_min = counts(low, channel);
  channel.raw_max = counts(high, channel);
  return channel;
}

DeviceChannel angle_channel(const ExoJoint& joint, const HandParameters& hand) {
  const auto j = idx(joint.joint);
  return channel_of(ChannelKind::kAngle, joint.joint, joint.sensor_lsb > 0.0 ? joint.sensor_lsb : kAngleCount,
                    hand.min_angle[j] - kShownBeyondRange, hand.max_angle[j] + kShownBeyondRange);
}

DeviceChannel motor_channel(const ExoMotor& motor, int index, const HandParameters& hand) {
  double low = -kMotorPlay;
  double high = kMotorPlay;
  for (std::size_t j = 0; j < motor.arm.size(); ++j) {
    const JointLinkage* linkage = linkage_of(motor, static_cast<int>(j));
    const auto unwound = [&](double q) {
      return linkage != nullptr ? excursion(*linkage, q) : motor.arm[j] * q;
    };
    const double at_min = unwound(hand.min_angle[j] - kShownBeyondRange);
    const double at_max = unwound(hand.max_angle[j] + kShownBeyondRange);
    low += std::min(at_min, at_max);
    high += std::max(at_min, at_max);
  }
  return channel_of(ChannelKind::kMotor, index, kMotorCount, low, high);
}

DeviceChannel torque_channel(int joint, const Exoskeleton& exoskeleton) {
  double most = 0.0;
  for (const ExoMotor& motor : exoskeleton.motors)
    most += std::abs(motor.arm[idx(joint)]) * motor.force_limit;
  return channel_of(ChannelKind::kTorque, joint, kTorqueCount, -kTorqueReserve * most, kTorqueReserve * most);
}

double measured(const SimulatedExoskeleton& device, const DeviceChannel& channel) noexcept {
  switch (channel.kind) {
    case ChannelKind::kAngle:
      return device.sample().angle[idx(channel.index)];
    case ChannelKind::kTorque:
      return device.sample().measured_torque[idx(channel.index)];
    case ChannelKind::kMotor:
      return device.plant().tendon(idx(channel.index)).wound;
    case ChannelKind::kForce:
    case ChannelKind::kCurl:
    case ChannelKind::kSplay:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<DeviceChannel> simulated_channels(const Exoskeleton& exoskeleton, const HandParameters& hand) {
  std::vector<DeviceChannel> channels;
  channels.reserve(2 * exoskeleton.joints.size() + exoskeleton.motors.size());
  for (const ExoJoint& joint : exoskeleton.joints) channels.push_back(angle_channel(joint, hand));
  for (std::size_t m = 0; m < exoskeleton.motors.size(); ++m)
    channels.push_back(motor_channel(exoskeleton.motors[m], static_cast<int>(m), hand));
  for (const ExoJoint& joint : exoskeleton.joints)
    if (joint.torque_sensor) channels.push_back(torque_channel(joint.joint, exoskeleton));
  if (channels.size() > kMaxChannels) {
    throw std::invalid_argument(fmt::format(
        "device '{}': joints, motors and torque sensors make {} channels, the link carries {}; take torque "
        "sensors or motors out of the device file",
        exoskeleton.name, channels.size(), kMaxChannels));
  }
  return channels;
}

void read_raw(const SimulatedExoskeleton& device, const std::vector<DeviceChannel>& channels,
              std::array<std::int32_t, kMaxChannels>& raw) noexcept {
  raw.fill(0);
  for (std::size_t c = 0; c < std::min(channels.size(), kMaxChannels); ++c)
    raw[c] = counts(measured(device, channels[c]), channels[c]);
}

}  // namespace phalanx
