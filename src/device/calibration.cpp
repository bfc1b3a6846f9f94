// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "phalanx/core/constants.h"
#include "phalanx/hand/anthropometry.h"

namespace phalanx {
namespace {

// ---- one channel's fit and its checks, in their order ----

class Fitter {
 public:
  Fitter(const DeviceChannel& channel, std::span<const PoseReading> readings, const HandParameters& hand,
         const CalibrationLimits& limits)
      : channel_(channel),
        readings_(readings),
        limits_(limits),
        rad_(radians_per_unit(channel.kind, channel.index, hand)) {}

  [[nodiscard]] ChannelFit fit() const {
    check_numbers();
    check_poses_differ();
    check_span();
    ChannelFit fit = least_squares();
    check_stillness(fit);
    check_direction(fit);
    check_residuals(fit);
    check_anatomy(fit);
    return fit;
  }

 private:
  template <class... Args>
  [[noreturn]] void refuse(fmt::format_string<Args...> text, Args&&... args) const {
    throw CalibrationError(channel_label(channel_.kind, channel_.index) + ": " +
                           fmt::format(text, std::forward<Args>(args)...));
  }

  void check_numbers() const {
    for (const PoseReading& r : readings_) {
      if (!std::isfinite(r.value) || !std::isfinite(r.raw) || !std::isfinite(r.noise) ||
          !std::isfinite(r.drift))
        refuse("{}: a number is not finite; measure this pose again", r.pose);
      if (r.raw < channel_.raw_min || r.raw > channel_.raw_max) {
        refuse("{}: raw {:.0f} is outside the sensor's range {} .. {}; check its plug and cable", r.pose,
               r.raw, channel_.raw_min, channel_.raw_max);
      }
    }
  }

  void check_poses_differ() const {
    const auto [low, high] =
        std::minmax_element(readings_.begin(), readings_.end(),
                            [](const PoseReading& a, const PoseReading& b) { return a.value < b.value; });
    const double apart = readings_.empty() ? 0.0 : rad_ * (high->value - low->value);
    if (apart <= limits_.apart) {
      refuse("{} poses, {:.1f} deg apart; measure at least two whose angles differ by more than {:.0f} deg",
             readings_.size(), apart / kDeg, limits_.apart / kDeg);
    }
  }

  void check_span() const {
    const auto [low, high] =
        std::minmax_element(readings_.begin(), readings_.end(),
                            [](const PoseReading& a, const PoseReading& b) { return a.raw < b.raw; });
    if (high->raw - low->raw < limits_.least_span) {
      refuse(
          "the raw counts changed by only {:.1f} between the poses, at least {:.0f} are needed; is the "
          "sensor "
          "connected and fastened to the joint?",
          high->raw - low->raw, limits_.least_span);
    }
  }

  [[nodiscard]] ChannelFit least_squares() const {
    const auto n = static_cast<double>(readings_.size());
    double mean_raw = 0.0;
    double mean_value = 0.0;
    for (const PoseReading& r : readings_) {
      mean_raw += r.raw / n;
      mean_value += r.value / n;
    }
    double raw_raw = 0.0;
    double raw_value = 0.0;
    for (const PoseReading& r : readings_) {
      raw_raw += (r.raw - mean_raw) * (r.raw - mean_raw);
      raw_value += (r.raw - mean_raw) * (r.value - mean_value);
    }
    ChannelFit fit;
    fit.gain = raw_value / raw_raw;
    fit.offset = mean_value - fit.gain * mean_raw;
    for (const PoseReading& r : readings_) {
      fit.residual.push_back(rad_ * (fit.gain * r.raw + fit.offset - r.value));
      fit.worst = std::max(fit.worst, std::abs(fit.residual.back()));
    }
    return fit;
  }

  void check_stillness(const ChannelFit& fit) const {
    const double rad_per_count = rad_ * std::abs(fit.gain);
    for (const PoseReading& r : readings_) {
      const double drift = rad_per_count * std::abs(r.drift);
      if (drift > limits_.most_drift) {
        refuse(
            "{}: it moved by {:.1f} deg while it was measured, at most {:.1f} are allowed; hold the pose "
            "still and measure again",
            r.pose, drift / kDeg, limits_.most_drift / kDeg);
      }
      const double noise = rad_per_count * r.noise;
      if (noise > limits_.most_noise) {
        refuse(
            "{}: the noise is {:.1f} deg rms, at most {:.1f} are allowed; hold the pose still, and check "
            "the sensor's cable",
            r.pose, noise / kDeg, limits_.most_noise / kDeg);
      }
    }
  }

  // Checks that any two poses that are well apart agree with the fit on the direction of the counts.
  void check_direction(const ChannelFit& fit) const {
    for (const PoseReading& a : readings_) {
      for (const PoseReading& b : readings_) {
        const bool well_apart = rad_ * (b.value - a.value) > 2.0 * limits_.most_residual &&
                                std::abs(b.raw - a.raw) >= limits_.least_span;
        if (well_apart && fit.gain * (b.raw - a.raw) <= 0.0) {
          refuse(
              "from '{}' (raw {:.0f}) to '{}' (raw {:.0f}) the counts go the other way than in the other "
              "poses; measure both again",
              a.pose, a.raw, b.pose, b.raw);
        }
      }
    }
  }

  void check_residuals(const ChannelFit& fit) const {
    for (std::size_t i = 0; i < readings_.size(); ++i) {
      if (std::abs(fit.residual[i]) <= limits_.most_residual) continue;
      refuse(
          "{}: {:+.1f} deg beside the straight line through all poses, at most {:.1f} are allowed; measure "
          "this pose again, and check the angle that is stated for it",
          readings_[i].pose, fit.residual[i] / kDeg, limits_.most_residual / kDeg);
    }
  }

  [[nodiscard]] std::pair<double, double> possible() const {
    if (channel_.kind == ChannelKind::kCurl) return {0.0, 1.0};
    if (channel_.kind == ChannelKind::kSplay) return {-1.0, 1.0};
    const PlausibleRange range = plausible_angle(channel_.index);
    return {range.min, range.max};
  }

  void check_anatomy(const ChannelFit& fit) const {
    const auto [low, high] = possible();
    const double margin = limits_.most_residual / rad_;
    for (const PoseReading& r : readings_) {
      for (const double value : {r.value, fit.gain * r.raw + fit.offset}) {
        if (value >= low - margin && value <= high + margin) continue;
        refuse(
            "{}: {:.1f} deg is beyond what a hand can do, {:.1f} .. {:.1f}; check the angle that is stated "
            "for it",
            r.pose, rad_ * value / kDeg, rad_ * low / kDeg, rad_ * high / kDeg);
      }
    }
  }

  const DeviceChannel& channel_;
  std::span<const PoseReading> readings_;
  const CalibrationLimits& limits_;
  double rad_;
};

}  // namespace

// ---- averaging ----

void RawAverage::add(std::int32_t raw) noexcept {
  if (count_ == 0) first_ = raw;
  const double x = raw - first_;
  sum_ += x;
  squares_ += x * x;
  with_time_ += static_cast<double>(count_) * x;
  ++count_;
}

double RawAverage::mean() const noexcept {
  return count_ == 0 ? 0.0 : first_ + sum_ / static_cast<double>(count_);
}

double RawAverage::slope() const noexcept {
  const auto n = static_cast<double>(count_);
  if (count_ < 2) return 0.0;
  const double time_time = n * (n * n - 1.0) / 12.0;  // sum (i - mean i)^2
  return (with_time_ - 0.5 * (n - 1.0) * sum_) / time_time;
}

double RawAverage::drift() const noexcept {
  return count_ < 2 ? 0.0 : slope() * static_cast<double>(count_ - 1);
}

double RawAverage::noise() const noexcept {
  if (count_ < 2) return 0.0;
  const auto n = static_cast<double>(count_);
  const double about_mean = squares_ - sum_ * sum_ / n;
  const double of_line = slope() * slope() * n * (n * n - 1.0) / 12.0;
  return std::sqrt(std::max(0.0, about_mean - of_line) / n);
}

// ---- channels ----

bool is_posable(ChannelKind kind) noexcept {
  return kind == ChannelKind::kAngle || kind == ChannelKind::kCurl || kind == ChannelKind::kSplay;
}

std::string channel_label(ChannelKind kind, int index) {
  const bool is_joint = index >= 0 && index < kJoints;
  const bool is_digit = index >= 0 && index < kDigits;
  const auto joint = is_joint ? std::string(joint_name(index)) : fmt::format("joint {}", index);
  const auto digit = is_digit ? std::string(digit_name(index)) : fmt::format("digit {}", index);
  switch (kind) {
    case ChannelKind::kAngle:
      return "angle of " + joint;
    case ChannelKind::kTorque:
      return "torque on " + joint;
    case ChannelKind::kForce:
      return "force on " + digit;
    case ChannelKind::kMotor:
      return fmt::format("motor {}", index);
    case ChannelKind::kCurl:
      return "curl of " + digit;
    case ChannelKind::kSplay:
      return "splay of " + digit;
  }
  return fmt::format("channel of kind {}", static_cast<int>(kind));
}

double radians_per_unit(ChannelKind kind, int index, const HandParameters& hand) {
  const auto range = [&](int i) {
    const auto j = static_cast<std::size_t>(joint_index(index, i));
    return hand.max_angle[j] - hand.min_angle[j];
  };
  if (kind == ChannelKind::kCurl) return (range(0) + range(2) + range(3)) / 3.0;
  if (kind == ChannelKind::kSplay) return range(1) / 2.0;
  return 1.0;
}

int leading_joint(const DeviceChannel& channel) noexcept {
  if (channel.kind == ChannelKind::kCurl) return joint_index(channel.index, 2);
  if (channel.kind == ChannelKind::kSplay) return joint_index(channel.index, kAbductionJoint);
  return channel.index;
}

double angle_of_value(const DeviceChannel& channel, double value, const HandParameters& hand) noexcept {
  if (channel.kind == ChannelKind::kAngle) return value;
  const auto j = static_cast<std::size_t>(leading_joint(channel));
  const double range = hand.max_angle[j] - hand.min_angle[j];
  const double share = channel.kind == ChannelKind::kSplay ? 0.5 * (value + 1.0) : value;
  return hand.min_angle[j] + share * range;
}

double value_of_angle(const DeviceChannel& channel, double angle, const HandParameters& hand) noexcept {
  if (channel.kind == ChannelKind::kAngle) return angle;
  const auto j = static_cast<std::size_t>(leading_joint(channel));
  const double share = (angle - hand.min_angle[j]) / (hand.max_angle[j] - hand.min_angle[j]);
  return channel.kind == ChannelKind::kSplay ? 2.0 * share - 1.0 : share;
}

std::string_view calibration_method_name(CalibrationMethod method) noexcept {
  if (method == CalibrationMethod::kJig) return "jig";
  return method == CalibrationMethod::kStops ? "stops" : "goniometer";
}

ChannelFit fit_channel(const DeviceChannel& channel, std::span<const PoseReading> readings,
                       const HandParameters& hand, const CalibrationLimits& limits) {
  return Fitter(channel, readings, hand, limits).fit();
}

std::vector<DeviceChannel> apply_calibration(const Calibration& calibration, const DeviceInfo& device) {
  if (calibration.serial != device.serial || calibration.device != device.name) {
    throw CalibrationError(fmt::format(
        "the calibration was made for {} {}, this is {} {}; calibrate this device (phalanx device "
        "calibrate)",
        calibration.device, calibration.serial, device.name, device.serial));
  }
  std::vector<DeviceChannel> channels = device.channels;
  std::size_t used = 0;
  for (DeviceChannel& channel : channels) {
    const auto found = std::find_if(
        calibration.channels.begin(), calibration.channels.end(), [&](const CalibratedChannel& c) {
          return c.channel.kind == channel.kind && c.channel.index == channel.index;
        });
    if (found != calibration.channels.end()) {
      channel.gain = found->channel.gain;
      channel.offset = found->channel.offset;
      ++used;
    } else if (is_posable(channel.kind)) {
      throw CalibrationError(fmt::format("the calibration has no {}, which the device sends; calibrate again",
                                         channel_label(channel.kind, channel.index)));
    }
  }
  if (used != calibration.channels.size()) {
    throw CalibrationError(
        fmt::format("the calibration has {} channels, of which the device sends only {}; calibrate again",
                    calibration.channels.size(), used));
  }
  return channels;
}

}  // namespace phalanx
