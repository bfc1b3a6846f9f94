// SPDX-License-Identifier: Apache-2.0
// Calibration: the gain and offset of each channel, fitted to raw counts at poses with known angles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// Source of the known angles of a calibration. None of them depends on what a patient can reach.
enum class CalibrationMethod : std::uint8_t {
  kJig,         ///< the device is on a jig or a dummy hand, whose joints are set to stated angles
  kStops,       ///< the device is at its mechanical stops, whose angles its file states
  kGoniometer,  ///< a hand is held where it can be held, and a person measures and enters each angle
};

/// Names a method: "jig", "stops", "goniometer".
[[nodiscard]] std::string_view calibration_method_name(CalibrationMethod method) noexcept;

/// Limits for a plausible calibration. Angles also bound curls and splays, through radians_per_unit().
struct CalibrationLimits {
  double least_span = 50.0;        ///< least span of the raw counts between the poses [counts]
  double most_residual = 0.08727;  ///< largest error of any pose: 5 deg [rad]
  double most_noise = 0.03491;  ///< largest noise (root mean square, rms) while a pose is held: 2 deg [rad]
  double most_drift = 0.05236;  ///< largest drift while a pose is held: 3 deg; beyond it, the hand
                                ///< has moved [rad]
  double apart = 0.01745;       ///< the poses' known angles must differ by more: 1 deg [rad]
};

/// Error of a calibration that is not plausible. what() names the channel, the value and the remedy.
class CalibrationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Mean, noise and drift of a channel while a pose is held, from a straight line fitted to the
/// counts over time.
class RawAverage {
 public:
  void add(std::int32_t raw) noexcept;
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] double mean() const noexcept;   ///< [counts]
  [[nodiscard]] double drift() const noexcept;  ///< change of the line from the first count to
                                                ///< the last [counts]
  [[nodiscard]] double noise() const noexcept;  ///< rms about the line [counts]

 private:
  [[nodiscard]] double slope() const noexcept;  ///< [counts per count]

  std::size_t count_ = 0;
  double first_ = 0.0;  ///< subtracted, so that large counts lose no digits
  double sum_ = 0.0;
  double squares_ = 0.0;
  double with_time_ = 0.0;  ///< sum of i raw_i
};

/// Reading of one channel at one pose.
struct PoseReading {
  std::string pose;       ///< name of the pose, for messages
  double value = 0.0;     ///< known value, in the channel's unit
  double raw = 0.0;       ///< mean [counts]
  double noise = 0.0;     ///< [counts]
  double drift = 0.0;     ///< [counts]
  double residual = 0.0;  ///< fitted less known value, once fitted [rad]
};

/// Result of a fit: value = gain raw + offset.
struct ChannelFit {
  double gain = 1.0;
  double offset = 0.0;
  std::vector<double> residual;  ///< fitted less known value of each reading [rad]
  double worst = 0.0;            ///< largest magnitude of the residuals [rad]
};

/// @returns true if poses can calibrate the channel: angles, curls and splays. Torques, forces and motors
/// keep the maker's values.
[[nodiscard]] bool is_posable(ChannelKind kind) noexcept;
/// Names a channel for messages and tables: "angle of index_pip_flexion", "curl of thumb", "motor 3".
[[nodiscard]] std::string channel_label(ChannelKind kind, int index);
/// @returns the hand's motion for one unit of a channel [rad]: 1 for an angle, the mean range of the flexion
/// joints for a curl, half the range of abduction for a splay.
[[nodiscard]] double radians_per_unit(ChannelKind kind, int index, const HandParameters& hand);

/// @returns the joint whose angle stands for the channel: its own, the middle joint of a curl's digit, the abduction of
/// a splay's.
/// @pre is_posable(channel.kind)
[[nodiscard]] int leading_joint(const DeviceChannel& channel) noexcept;
/// @returns the angle of the leading joint at a value of the channel [rad].
[[nodiscard]] double angle_of_value(const DeviceChannel& channel, double value,
                                    const HandParameters& hand) noexcept;
/// @returns the value of the channel at an angle of its leading joint [rad].
[[nodiscard]] double value_of_angle(const DeviceChannel& channel, double angle,
                                    const HandParameters& hand) noexcept;

/// Fits value over raw counts by least squares: minimises sum (gain raw + offset - value)^2.
/// @param channel   kind, index and valid raw range
/// @throws CalibrationError naming the channel, the value and the remedy:
/// - a number is not finite, or fewer than two poses differ
/// - raw counts are outside the channel's range, or their span is below the least
/// - the hand moved, or the noise is too large
/// - poses disagree on the direction, or a pose is further from the fit than allowed
/// - an angle is not anatomically possible
/// Set-up only.
[[nodiscard]] ChannelFit fit_channel(const DeviceChannel& channel, std::span<const PoseReading> readings,
                                     const HandParameters& hand, const CalibrationLimits& limits = {});

/// One channel of a calibration.
struct CalibratedChannel {
  DeviceChannel channel;                ///< without the raw range, which a file does not state
  double residual = 0.0;                ///< residual of the worst pose [rad]
  std::vector<PoseReading> poses = {};  ///< readings that it was fitted to
  CalibrationMethod method = CalibrationMethod::kJig;
  std::string date = {};  ///< of its own measurement, as Calibration::date; empty: that of the calibration
};

/// Content of a calibration file. It belongs to one device.
struct Calibration {
  std::string device;   ///< DeviceInfo::name
  std::string serial;   ///< DeviceInfo::serial
  std::string date;     ///< UTC, ISO 8601: "2026-05-04T09:30:00Z"
  std::string phalanx;  ///< version of the program that made it
  std::vector<CalibratedChannel> channels;
};

/// Applies a calibration's gains and offsets to the device's channels, in the device's order.
/// @throws CalibrationError if it was made for another device or serial number. It also throws if one of its
/// channels is not the device's, or if it lacks one of the device's angles, curls or splays. Set-up only.
[[nodiscard]] std::vector<DeviceChannel> apply_calibration(const Calibration& calibration,
                                                           const DeviceInfo& device);

}  // namespace phalanx
