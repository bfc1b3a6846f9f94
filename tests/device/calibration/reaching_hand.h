// SPDX-License-Identifier: Apache-2.0
// A calibrated device on a simulated hand that reaches only so far.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/device/device.h"

namespace phalanx::test {

/// Angles of MCP, abduction, PIP and DIP of the index finger, with noise. The hand moves to what it intends, but no
/// further than its own reach. Then the torque on the PIP joint moves it, too, as on a relaxed finger in a viscous
/// medium.
class ReachingHand final : public Device {
 public:
  static constexpr double kCount = 1e-4;        ///< [rad]
  static constexpr double kNoise = 0.3 * kDeg;  ///< rms of the sensors [rad]
  static constexpr double kYield = 2.0;         ///< speed of a relaxed joint per torque [rad/s per Nm]
  static constexpr double kPeriod = 1e-3;       ///< [s]

  explicit ReachingHand(double reach) : reach_(reach) {
    info_.name = "reaching";
    info_.serial = "0040";
    for (int i = 0; i < kJointsPerDigit; ++i)
      info_.channels.push_back({.kind = ChannelKind::kAngle,
                                .index = joint_index(1, i),
                                .raw_min = -40000,
                                .raw_max = 40000,
                                .gain = kCount,
                                .offset = 0.0});
  }

  /// Intends these angles from now on, at most `reach` of PIP [rad].
  void intend(const std::array<double, kJointsPerDigit>& angle) {
    intended_ = angle;
    intended_[2] = std::min(intended_[2], reach_);
  }
  /// The next sample of the PIP sensor is wrong.
  void disturb() { spike_ = true; }
  /// Relaxes the finger: torques move its PIP joint.
  void relax() { relaxed_ = true; }
  [[nodiscard]] double pip() const { return angle_[2]; }

  void open() override {}
  void close() noexcept override {}
  [[nodiscard]] const DeviceInfo& info() const override { return info_; }
  [[nodiscard]] std::size_t receive(double now, std::span<DeviceSample> out) noexcept override {
    move();
    DeviceSample& sample = out.front();
    sample = {};
    sample.sequence = ++count_;
    sample.time_us = 1000ULL * count_;
    sample.received = now;
    sample.state = command_.enable ? DeviceState::kActive : DeviceState::kReady;
    sample.factor = 1.0;
    for (std::size_t i = 0; i < angle_.size(); ++i)
      sample.raw[i] = static_cast<std::int32_t>(std::lround((angle_[i] + noise_(random_)) / kCount));
    if (spike_) sample.raw[2] += static_cast<std::int32_t>(60.0 * kDeg / kCount);
    spike_ = false;
    return 1;
  }
  void send(const DeviceCommand& command) noexcept override { command_ = command; }
  void reset() noexcept override {}

 private:
  void move() noexcept {
    constexpr double kSpeed = 2.0 * kPeriod;  // [rad] in a period
    for (std::size_t i = 0; i < angle_.size(); ++i)
      if (!relaxed_) angle_[i] += std::clamp(intended_[i] - angle_[i], -kSpeed, kSpeed);
    if (relaxed_) angle_[2] += kYield * command_.torque[idx(joint_index(1, 2))] * kPeriod;
  }

  double reach_;
  DeviceInfo info_;
  DeviceCommand command_;
  std::array<double, kJointsPerDigit> angle_{};
  std::array<double, kJointsPerDigit> intended_{};
  std::uint32_t count_ = 0;
  bool spike_ = false;
  bool relaxed_ = false;
  std::mt19937 random_{20261128};
  std::normal_distribution<double> noise_{0.0, kNoise};
};

}  // namespace phalanx::test
