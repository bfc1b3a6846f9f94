// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/posed_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "device/shown_range.h"

namespace phalanx {
namespace {

constexpr double kCount = 10e-6;    ///< resolution of an angle channel [rad]
constexpr double kStartRamp = 1.0;  ///< rise time of the factor, as on a controller of the link [s]

void check_above_zero(double value, const char* what) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw std::invalid_argument(
        fmt::format("posed device: {} is {}; it must be a number above 0", what, value));
}

/// @returns `angle` clamped to the range of motion; an angle that is not finite is taken from `last`.
JointArray within_range(const JointArray& angle, const JointArray& last,
                        const HandParameters& hand) noexcept {
  JointArray inside = last;
  for (std::size_t j = 0; j < angle.size(); ++j)
    if (std::isfinite(angle[j])) inside[j] = std::clamp(angle[j], hand.min_angle[j], hand.max_angle[j]);
  return inside;
}

DeviceInfo info_of(const PosedDeviceSettings& settings) {
  DeviceInfo info{.name = "posed hand",
                  .serial = "sliders",
                  .rate_hz = settings.host_rate_hz,
                  .channels = {},
                  .renders_torque = true,
                  .simulated = true};
  for (std::size_t j = 0; j < kJoints; ++j) {
    const double low = (settings.hand.min_angle[j] - kShownBeyondRange) / kCount;
    const double high = (settings.hand.max_angle[j] + kShownBeyondRange) / kCount;
    info.channels.push_back({.kind = ChannelKind::kAngle,
                             .index = static_cast<int>(j),
                             .raw_min = static_cast<std::int32_t>(std::lround(low)),
                             .raw_max = static_cast<std::int32_t>(std::lround(high)),
                             .gain = kCount});
  }
  return info;
}

}  // namespace

PosedDevice::PosedDevice(const PosedDeviceSettings& settings) : settings_(settings) {
  check_above_zero(settings.host_rate_hz, "the host's rate [Hz]");
  check_above_zero(settings.speed, "the largest speed [rad/s]");
  check_above_zero(settings.time_constant, "the time constant [s]");
  for (std::size_t j = 0; j < kJoints; ++j)
    if (!std::isfinite(settings.start[j]))
      throw std::invalid_argument(fmt::format("posed device: the start angle of {} is {}; it must be finite",
                                              joint_name(static_cast<int>(j)), settings.start[j]));
  info_ = info_of(settings_);
  period_ = 1.0 / settings.host_rate_hz;
  decay_ = std::exp(-period_ / settings.time_constant);
  wanted_ = within_range(settings.start, {}, settings_.hand);
  angle_ = wanted_;
  target_.write(wanted_);
}

void PosedDevice::pose(const JointArray& angle) noexcept {
  wanted_ = within_range(angle, wanted_, settings_.hand);
  target_.write(wanted_);
}

void PosedDevice::open() {
  command_ = {};
  sample_.state = DeviceState::kReady;
  sample_.factor = 0.0;
  open_ = true;
}

void PosedDevice::close() noexcept { open_ = false; }

/// Moves a joint by one period of  a = w^2 (target - x) - 2 w v,  w = 1 / time_constant,  solved exactly. A
/// target further away than 2 speed / w is moved to that distance. From there, the speed tends to `speed` and
/// never exceeds it. From rest, the joint does not overshoot the target.
void PosedDevice::move(std::size_t joint, double target) noexcept {
  const double w = 1.0 / settings_.time_constant;
  const double reach = 2.0 * settings_.speed * settings_.time_constant;
  const double before = std::clamp(angle_[joint] - target, -reach, reach);
  const double mixed = speed_[joint] + w * before;
  const double after = (before + mixed * period_) * decay_;
  speed_[joint] = (speed_[joint] - w * mixed * period_) * decay_;

  // A joint may pass a target that comes back towards it, but never the end of its range.
  const double next = angle_[joint] + (after - before);
  angle_[joint] = std::clamp(next, settings_.hand.min_angle[joint], settings_.hand.max_angle[joint]);
  if (angle_[joint] != next) speed_[joint] = 0.0;
}

/// Sets the state and factor that a controller would report for the newest command.
void PosedDevice::follow_command() noexcept {
  const bool enabled = command_.enable && !command_.fault;
  sample_.factor = enabled ? std::min(1.0, sample_.factor + period_ / kStartRamp) : 0.0;
  sample_.state = DeviceState::kReady;
  if (enabled) sample_.state = sample_.factor < 1.0 ? DeviceState::kStarting : DeviceState::kActive;
  sample_.acted_tick = command_.tick;
}

std::size_t PosedDevice::receive(double now, std::span<DeviceSample> out) noexcept {
  if (!open_) return 0;
  target_.update();
  for (std::size_t j = 0; j < kJoints; ++j) {
    move(j, target_.value()[j]);
    sample_.raw[j] = static_cast<std::int32_t>(std::lround(angle_[j] / kCount));
  }
  follow_command();
  ++steps_;
  sample_.sequence = static_cast<std::uint32_t>(steps_);
  sample_.time_us = static_cast<std::uint64_t>(std::llround(1e6 * static_cast<double>(steps_) * period_));
  sample_.received = now;
  ++statistics_.received;
  if (out.empty()) {
    ++statistics_.overflowed;
    return 0;
  }
  out.front() = sample_;
  return 1;
}

void PosedDevice::send(const DeviceCommand& command) noexcept {
  if (!open_) return;
  command_ = command;
  ++statistics_.sent;
}

void PosedDevice::reset() noexcept {
  command_.enable = false;
  command_.fault = false;
}

}  // namespace phalanx
