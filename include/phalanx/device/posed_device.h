// SPDX-License-Identifier: Apache-2.0
// A device without dynamics: all joints have a perfect sensor and go where they are told. For whoever plays
// without an exoskeleton, with the cockpit's sliders.
#pragma once

#include <memory>

#include "phalanx/device/device.h"
#include "phalanx/device/latest.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

struct PosedDeviceSettings {
  HandParameters hand;
  JointArray start{};           ///< [rad]; clamped to the range of motion
  double host_rate_hz = 200.0;  ///< every receive() is one period later
  double speed = 6.0;           ///< no joint moves faster [rad/s]
  double time_constant = 0.05;  ///< of the critically damped way to the target [s]
};

/// Serial "sliders", one angle channel a joint, no motor. Samples come at the host's rate; torques are
/// accepted, obeyed in name (state, factor, acted_tick) and felt by nobody. Its time is the number of steps
/// that the host has made.
class PosedDevice final : public Device {
 public:
  /// @throws std::invalid_argument if a rate, speed or time constant is not above 0, or a start angle is not
  /// finite
  explicit PosedDevice(const PosedDeviceSettings& settings);

  /// Where the hand is wanted [rad]: clamped to the range of motion; what is not finite stays where it was.
  /// One thread beside the loop's.
  void pose(const JointArray& angle) noexcept;

  void open() override;
  void close() noexcept override;
  [[nodiscard]] const DeviceInfo& info() const override { return info_; }
  [[nodiscard]] std::size_t receive(double now, std::span<DeviceSample> out) noexcept override;
  void send(const DeviceCommand& command) noexcept override;
  void reset() noexcept override;
  [[nodiscard]] LinkStatistics statistics() const noexcept override { return statistics_; }

 private:
  void move(std::size_t joint, double target) noexcept;
  void follow_command() noexcept;

  PosedDeviceSettings settings_;
  DeviceInfo info_;
  double period_ = 0.0;  ///< of the host [s]
  double decay_ = 0.0;   ///< exp(-period / time_constant)
  JointArray wanted_{};  ///< the posing thread's own: the last that was finite [rad]
  Latest<JointArray> target_;
  JointArray angle_{};  ///< [rad]
  JointArray speed_{};  ///< [rad/s]
  DeviceSample sample_;
  DeviceCommand command_;
  LinkStatistics statistics_;
  std::uint64_t steps_ = 0;
  bool open_ = false;
};

}  // namespace phalanx
