// SPDX-License-Identifier: Apache-2.0
// Whether the sensors can be believed: every sample of the device is judged, also those between two steps.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/device/channel_map.h"
#include "phalanx/device/device.h"
#include "phalanx/device/exoskeleton.h"
#include "phalanx/station/safety_settings.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// A motor that says how far it has wound, and the joints that it moves: what a sensor that stands still is
/// held against.
struct MotorWitness {
  int channel = -1;                   ///< of kMotor
  std::array<double, kJoints> arm{};  ///< [m]
  double slack = 0.0;  ///< tendon stretch at the largest torque, and play: motion of the motor that moves
                       ///< no joint [m]
};

/// What a watch found.
struct SensorFinding {
  Fault fault = Fault::kNone;
  int channel = -1;  ///< -1: not one channel's
};

/// One channel's recent past; in one place, so that a fault can show it.
class SensorWatch {
 public:
  /// Set-up only.
  SensorWatch(const SafetySettings& settings, const ChannelMap& map, const HandParameters& hand,
              std::vector<MotorWitness> witnesses);

  /// Judges one sample.
  /// @param torque  that the device was last sent [Nm]
  /// @param force   magnitude of the forces on each digit that went with it [N]
  /// Real-time: no allocation, lock, throw or I/O.
  [[nodiscard]] SensorFinding judge(const DeviceSample& sample, const JointArray& torque,
                                    const DigitArray& force) noexcept;

  /// No channel is bad at the moment: what a reset asks.
  [[nodiscard]] bool all_good() const noexcept;
  /// Forgets the past, not the settings: after a reset the next sample is the first.
  void forget() noexcept;

 private:
  struct Channel {
    int bad = 0;         ///< samples in a row
    double value = 0.0;  ///< of the last good sample
    double time = 0.0;   ///< of it [s]
    bool seen = false;
    std::int32_t raw = 0;       ///< of the last sample
    double still_since = 0.0;   ///< when raw last changed [s]
    double error_since = -1.0;  ///< when the torque began to disagree [s]; -1: it agrees
  };
  [[nodiscard]] Fault judge_angle(std::size_t c, double t) noexcept;
  [[nodiscard]] bool disagrees(std::size_t c, double commanded, double allowance, double t) noexcept;
  [[nodiscard]] bool stands_still(std::size_t c, double t) noexcept;
  [[nodiscard]] double moved_by(const MotorWitness& witness, std::size_t c) const noexcept;

  SafetySettings settings_;
  const ChannelMap* map_;
  std::vector<MotorWitness> witness_;
  std::vector<Channel> channel_;
  std::vector<double> least_;  ///< plausible values of a channel, in its unit
  std::vector<double> largest_;
  std::vector<double> witnessed_;  ///< moved_by() when channel c last changed: [c * witnesses + w] [rad]
  std::uint64_t last_time_us_ = 0;
  int clock_bad_ = 0;
  bool started_ = false;
};

/// The witnesses that a device's channels and its file offer. Set-up only.
[[nodiscard]] std::vector<MotorWitness> motor_witnesses(const Exoskeleton& exoskeleton,
                                                        const std::vector<DeviceChannel>& channels,
                                                        double largest_torque);

}  // namespace phalanx
