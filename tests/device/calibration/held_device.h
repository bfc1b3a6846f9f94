// SPDX-License-Identifier: Apache-2.0
// A device of two angles and a motor for tests of calibrations: it reads the pose that is held.
#pragma once

#include <array>
#include <cmath>

#include "phalanx/device/calibration_session.h"
#include "phalanx/device/device.h"

namespace phalanx::test {

inline constexpr std::array<double, 2> kGain = {-1.0 / 800.0, 1.0 / 1000.0};
inline constexpr std::array<double, 2> kOffset = {2.5, -1.0};

/// Reads raw = (value - offset) / gain of the pose that is held. Counts what it is told to do.
class HeldDevice final : public Device {
 public:
  HeldDevice() {
    info_.name = "held";
    info_.serial = "0042";
    for (const int joint : {joint_index(1, 0), joint_index(1, 2)})
      info_.channels.push_back({.kind = ChannelKind::kAngle, .index = joint, .raw_max = 4095});
    info_.channels.push_back({.kind = ChannelKind::kMotor, .index = 0, .gain = 1e-6});
  }
  void open() override {}
  void close() noexcept override {}
  [[nodiscard]] const DeviceInfo& info() const override { return info_; }
  [[nodiscard]] std::size_t receive(double, std::span<DeviceSample> out) noexcept override {
    if (silent) return 0;
    for (std::size_t i = 0; i < 8; ++i) {
      out[i] = {};
      out[i].raw = held;
      out[i].raw[0] += static_cast<std::int32_t>(i % 3) - 1;  // noise of a count
    }
    return 8;
  }
  void send(const DeviceCommand&) noexcept override { ++commands; }
  void reset() noexcept override { ++commands; }
  [[nodiscard]] Fault connection_fault() const noexcept override { return fault; }

  /// The wearer goes into a pose.
  void hold(const CalibrationPose& pose) noexcept {
    for (std::size_t c = 0; c < kGain.size(); ++c)
      if (pose.value[c])
        held[c] = static_cast<std::int32_t>(std::lround((*pose.value[c] - kOffset[c]) / kGain[c]));
  }

  void keep_only_motors() {
    std::erase_if(info_.channels, [](const DeviceChannel& c) { return c.kind != ChannelKind::kMotor; });
  }

  std::array<std::int32_t, kMaxChannels> held{};
  int commands = 0;
  bool silent = false;
  Fault fault = Fault::kNone;

 private:
  DeviceInfo info_;
};

}  // namespace phalanx::test
