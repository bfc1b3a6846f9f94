// SPDX-License-Identifier: Apache-2.0
// From raw counts at poses whose angles are known to the gain and offset of each channel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// What is believed of a calibration. Angles also bound curls and splays, through radians_per_unit().
struct CalibrationLimits {
  double least_span = 50.0;        ///< of the raw counts between the poses [counts]
  double most_residual = 0.08727;  ///< of any pose: 5 deg [rad]
  double most_noise = 0.03491;     ///< rms while a pose is held: 2 deg [rad]
  double most_drift = 0.05236;     ///< while a pose is held: 3 deg; more, and the hand has moved [rad]
  double apart = 0.01745;          ///< poses that differ by less are one: 1 deg [rad]
};

/// A calibration that cannot be right. what() names the channel, the value and the remedy.
class CalibrationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Mean, noise and drift of a channel while a pose is held: a straight line through the counts over time.
class RawAverage {
 public:
  void add(std::int32_t raw) noexcept;
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] double mean() const noexcept;   ///< [counts]
  [[nodiscard]] double drift() const noexcept;  ///< of the line, from the first count to the last [counts]
  [[nodiscard]] double noise() const noexcept;  ///< rms about the line [counts]

 private:
  [[nodiscard]] double slope() const noexcept;  ///< [counts per count]

  std::size_t count_ = 0;
  double first_ = 0.0;  ///< subtracted, so that large counts lose no digits
  double sum_ = 0.0;
  double squares_ = 0.0;
  double with_time_ = 0.0;  ///< sum of (i raw_i)
};

/// One channel at one pose.
struct PoseReading {
  std::string pose;    ///< its name, for messages
  double value = 0.0;  ///< known, in the channel's unit
  double raw = 0.0;    ///< mean [counts]
  double noise = 0.0;  ///< [counts]
  double drift = 0.0;  ///< [counts]
};

/// value = gain raw + offset.
struct ChannelFit {
  double gain = 1.0;
  double offset = 0.0;
  std::vector<double> residual;  ///< of each reading: what the fit says less what is known [rad]
  double worst = 0.0;            ///< largest magnitude of these [rad]
};

/// Angles, curls and splays can be calibrated by poses; torques, forces and motors keep the maker's numbers.
[[nodiscard]] bool is_posable(ChannelKind kind) noexcept;
/// "angle of index_pip_flexion", "curl of thumb", "motor 3", for messages and tables.
[[nodiscard]] std::string channel_label(ChannelKind kind, int index);
/// How far the hand moves for one unit of a channel: 1 for an angle; the mean range of the flexion joints for
/// a curl, half the range of abduction for a splay [rad].
[[nodiscard]] double radians_per_unit(ChannelKind kind, int index, const HandParameters& hand);

/// Least squares of value over raw counts: minimises sum (gain raw + offset - value)^2.
/// @param channel   kind, index and valid raw range
/// @throws CalibrationError naming the channel, the value and the remedy: a number that is not finite, fewer
/// than two poses that differ, raw counts outside the channel's range, a raw span below the least, a hand
/// that moved, too much noise, poses that disagree on the direction, a pose further from the fit than the
/// most, an angle that is not anatomically possible. Set-up only.
[[nodiscard]] ChannelFit fit_channel(const DeviceChannel& channel, std::span<const PoseReading> readings,
                                     const HandParameters& hand, const CalibrationLimits& limits = {});

/// One channel of a calibration.
struct CalibratedChannel {
  DeviceChannel channel;                ///< a file does not state its raw range
  double residual = 0.0;                ///< the worst pose's [rad]
  std::vector<PoseReading> poses = {};  ///< that it was fitted to
};

/// What a calibration file holds. It belongs to one device.
struct Calibration {
  std::string device;   ///< DeviceInfo::name
  std::string serial;   ///< DeviceInfo::serial
  std::string date;     ///< UTC, ISO 8601: "2026-05-04T09:30:00Z"
  std::string phalanx;  ///< version that made it
  std::vector<CalibratedChannel> channels;
};

/// The device's channels with the calibration's gains and offsets, in the device's order.
/// @throws CalibrationError if it was made for another device or serial number, or one of its channels is not
/// the device's, or one of the device's angles, curls and splays is not in it. Set-up only.
[[nodiscard]] std::vector<DeviceChannel> apply_calibration(const Calibration& calibration,
                                                           const DeviceInfo& device);

}  // namespace phalanx
