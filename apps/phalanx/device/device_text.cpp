// SPDX-License-Identifier: Apache-2.0
#include "device/device_text.h"

#include <fmt/format.h>

#include <numbers>

#include "phalanx/hand/joints.h"

namespace phalanx {

std::string_view state_name(DeviceState state) noexcept {
  switch (state) {
    case DeviceState::kConnecting:
      return "connecting";
    case DeviceState::kReady:
      return "ready";
    case DeviceState::kStarting:
      return "starting";
    case DeviceState::kActive:
      return "active";
    case DeviceState::kFading:
      return "fading";
    case DeviceState::kLatched:
      return "latched";
  }
  return "unknown";
}

std::string_view kind_name(ChannelKind kind) noexcept {
  switch (kind) {
    case ChannelKind::kAngle:
      return "angle";
    case ChannelKind::kTorque:
      return "torque";
    case ChannelKind::kForce:
      return "force";
    case ChannelKind::kMotor:
      return "motor";
    case ChannelKind::kCurl:
      return "curl";
    case ChannelKind::kSplay:
      return "splay";
  }
  return "unknown";
}

std::string place_name(const DeviceChannel& channel) {
  const bool of_joint = channel.kind == ChannelKind::kAngle || channel.kind == ChannelKind::kTorque;
  if (channel.kind == ChannelKind::kMotor) return fmt::format("motor {}", channel.index);
  if (channel.index < 0 || channel.index >= (of_joint ? kJoints : kDigits))
    return fmt::format("{} {}?", of_joint ? "joint" : "digit", channel.index);
  return std::string(of_joint ? joint_name(channel.index) : digit_name(channel.index));
}

std::string_view shown_unit(ChannelKind kind) noexcept {
  switch (kind) {
    case ChannelKind::kAngle:
      return "deg";
    case ChannelKind::kTorque:
      return "Nm";
    case ChannelKind::kForce:
      return "N";
    case ChannelKind::kMotor:
      return "mm";
    default:
      return "";
  }
}

double shown(const DeviceChannel& channel, std::int32_t raw) noexcept {
  const double value = channel.gain * static_cast<double>(raw) + channel.offset;
  if (channel.kind == ChannelKind::kAngle) return value * 180.0 / std::numbers::pi;
  return channel.kind == ChannelKind::kMotor ? value * 1e3 : value;
}

bool in_range(const DeviceChannel& channel, std::int32_t raw) noexcept {
  return raw >= channel.raw_min && raw <= channel.raw_max;
}

std::string fault_text(Fault fault) {
  if (fault == Fault::kNone) return "none";
  return fmt::format("{}: {} {}", fault_name(fault), fault_meaning(fault), fault_remedy(fault));
}

}  // namespace phalanx
