// SPDX-License-Identifier: Apache-2.0
// A device without dynamics: all joints have a perfect sensor and move to a given pose. The cockpit's sliders
// use it, for trying the program without an exoskeleton.
#pragma once

#include <memory>

#include "phalanx/core/latest.h"
#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// Settings of a PosedDevice.
struct PosedDeviceSettings {
  HandParameters hand;
  JointArray start{};           ///< clamped to the range of motion [rad]
  double host_rate_hz = 200.0;  ///< each receive() advances by one period [Hz]
  double speed = 6.0;           ///< largest speed of a joint [rad/s]
  double time_constant = 0.05;  ///< of the critically damped approach to the target [s]
};

/// Device with the serial "sliders", one angle channel a joint, and no motor. Samples come at the host's
/// rate. It accepts torques and reports them (state, factor, acted_tick) without an effect. Its time is the
/// number of steps that the host has made.
class PosedDevice final : public Device {
 public:
  /// @throws std::invalid_argument if a rate, speed or time constant is not above 0, or a start angle is not
  /// a finite number
  explicit PosedDevice(const PosedDeviceSettings& settings);

  /// Sets the target of the hand [rad], clamped to the range of motion; an angle that is not finite keeps its
  /// last target. For one thread beside the loop's.
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
  double period_ = 0.0;  ///< period of the host [s]
  double decay_ = 0.0;   ///< exp(-period / time_constant)
  JointArray wanted_{};  ///< last finite target, for the posing thread only [rad]
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
