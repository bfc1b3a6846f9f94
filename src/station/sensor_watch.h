// SPDX-License-Identifier: Apache-2.0
// Plausibility of the sensors. Every sample of the device is judged, also those between two steps.
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

/// Result of judging a sample.
struct SensorFinding {
  Fault fault = Fault::kNone;
  int channel = -1;  ///< -1: no single channel
};

/// Judge of each channel's newest samples. It keeps the recent past of all channels.
class SensorWatch {
 public:
  /// Copies the settings and the hand's range of motion. Set-up only.
  /// @param map  must outlive the watch
  SensorWatch(const SafetySettings& settings, const ChannelMap& map, const HandParameters& hand,
              std::vector<MotorWitness> witnesses);

  /// Judges one sample.
  /// @param torque  last torques sent to the device [Nm]
  /// @param force   magnitude of the force on each digit, of the same command [N]
  /// Real-time: no allocation, lock, throw or I/O.
  [[nodiscard]] SensorFinding judge(const DeviceSample& sample, const JointArray& torque,
                                    const DigitArray& force) noexcept;

  /// @returns true if no channel is bad now, which a reset requires.
  [[nodiscard]] bool all_good() const noexcept;
  /// Forgets all samples and keeps the settings: after a reset, the next sample is the first.
  void forget() noexcept;

 private:
  struct Channel {
    int bad = 0;         ///< number of bad samples in a row
    double value = 0.0;  ///< value of the last good sample, in the channel's unit
    double time = 0.0;   ///< time of the last good sample [s]
    bool seen = false;
    std::int32_t raw = 0;       ///< raw value of the last sample
    double still_since = 0.0;   ///< time at which raw last changed [s]
    double error_since = -1.0;  ///< time at which the torque began to disagree [s]; -1: it agrees
  };
  [[nodiscard]] Fault judge_angle(std::size_t c, double t) noexcept;
  [[nodiscard]] bool disagrees(std::size_t c, double commanded, double allowance, double t) noexcept;
  [[nodiscard]] bool stands_still(std::size_t c, double t) noexcept;
  [[nodiscard]] double moved_by(const MotorWitness& witness, std::size_t c) const noexcept;

  SafetySettings settings_;
  const ChannelMap* map_;
  std::vector<MotorWitness> witness_;
  std::vector<Channel> channel_;
  std::vector<double> least_;      ///< smallest plausible value of a channel, in its unit
  std::vector<double> largest_;    ///< largest plausible value of a channel, in its unit
  std::vector<double> witnessed_;  ///< moved_by() when channel c last changed: [c * witnesses + w] [rad]
  std::uint64_t last_time_us_ = 0;
  int clock_bad_ = 0;
  bool started_ = false;
};

/// Finds the motors of a device file that can testify to a joint's motion. Set-up only.
/// @param largest_torque  of a joint; sets the tendon stretch in MotorWitness::slack [Nm]
[[nodiscard]] std::vector<MotorWitness> motor_witnesses(const Exoskeleton& exoskeleton,
                                                        const std::vector<DeviceChannel>& channels,
                                                        double largest_torque);

}  // namespace phalanx
