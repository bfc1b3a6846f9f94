// SPDX-License-Identifier: Apache-2.0
#include "station/sensor_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "phalanx/core/index.h"

namespace phalanx {
namespace {

bool is_angle(const DeviceChannel& channel) noexcept {
  return channel.kind == ChannelKind::kAngle || channel.kind == ChannelKind::kCurl ||
         channel.kind == ChannelKind::kSplay;
}

}  // namespace

SensorWatch::SensorWatch(const SafetySettings& settings, const ChannelMap& map, const HandParameters& hand,
                         std::vector<MotorWitness> witnesses)
    : settings_(settings), map_(&map), witness_(std::move(witnesses)) {
  const auto& channels = map.channels();
  channel_.resize(channels.size());
  witnessed_.resize(channels.size() * witness_.size());
  constexpr double kAnything = std::numeric_limits<double>::infinity();
  for (const DeviceChannel& channel : channels) {
    double least = -kAnything;
    double largest = kAnything;
    if (channel.kind == ChannelKind::kAngle) {
      least = hand.min_angle[idx(channel.index)] - settings.range_margin;
      largest = hand.max_angle[idx(channel.index)] + settings.range_margin;
    }
    least_.push_back(least);
    largest_.push_back(largest);
  }
}

bool SensorWatch::all_good() const noexcept {
  return started_ && clock_bad_ == 0 &&
         std::all_of(channel_.begin(), channel_.end(), [](const Channel& c) { return c.bad == 0; });
}

void SensorWatch::forget() noexcept {
  std::fill(channel_.begin(), channel_.end(), Channel{});
  clock_bad_ = 0;
  started_ = false;
}

/// Judges the newest raw value of one angle channel. @returns kNone or the fault
Fault SensorWatch::judge_angle(std::size_t c, double t) noexcept {
  Channel& channel = channel_[c];
  const DeviceChannel& sensor = map_->channels()[c];
  if (channel.raw < sensor.raw_min || channel.raw > sensor.raw_max) return Fault::kSensorRange;
  const double value = map_->value(c, channel.raw);
  if (!std::isfinite(value)) return Fault::kSampleNotFinite;
  if (value < least_[c] || value > largest_[c]) return Fault::kOutOfRange;
  if (channel.seen) {
    const double furthest =
        settings_.joint_speed * std::max(0.0, t - channel.time) + settings_.jump_allowance;
    if (std::abs(value - channel.value) > furthest) return Fault::kJump;
  }
  channel.seen = true;
  channel.value = value;
  channel.time = t;
  return Fault::kNone;
}

/// @returns the joint angle that the motor and the other joints it moves imply [rad]. The tendon's length
/// is  y = sum arm q,  so  q = (y - sum of the others) / arm. A linkage has its e(q), and the inverse.
double SensorWatch::moved_by(const MotorWitness& witness, std::size_t c) const noexcept {
  const auto joint = idx(map_->channels()[c].index);
  double wound = map_->value(idx(witness.channel), channel_[idx(witness.channel)].raw);
  for (std::size_t j = 0; j < witness.arm.size(); ++j) {
    if (j == joint || witness.arm[j] == 0.0) continue;
    const int other = map_->angle_channel(static_cast<int>(j));
    if (other < 0) continue;
    const double q = map_->value(idx(other), channel_[idx(other)].raw);
    const JointLinkage* linkage = witness.linkage_of(static_cast<int>(j));
    wound -= linkage != nullptr ? excursion(*linkage, q) : witness.arm[j] * q;
  }
  const JointLinkage* own = witness.linkage_of(static_cast<int>(joint));
  return own != nullptr ? angle_of_excursion(*own, wound) : wound / witness.arm[joint];
}

bool SensorWatch::stands_still(std::size_t c, double t) noexcept {
  const DeviceChannel& sensor = map_->channels()[c];
  if (sensor.kind != ChannelKind::kAngle || t - channel_[c].still_since < settings_.stuck_after) return false;
  for (std::size_t w = 0; w < witness_.size(); ++w) {
    double arm = witness_[w].arm[idx(sensor.index)];
    if (arm == 0.0) continue;
    if (const double least = witness_[w].least_arm[idx(sensor.index)]; least != 0.0) arm = least;
    const double believable =
        settings_.stuck_counts * std::abs(sensor.gain) + witness_[w].slack / std::abs(arm);
    if (std::abs(moved_by(witness_[w], c) - witnessed_[c * witness_.size() + w]) > believable) return true;
  }
  return false;
}

bool SensorWatch::disagrees(std::size_t c, double commanded, double allowance, double t) noexcept {
  const double bound = allowance + settings_.torque_error_part * std::abs(commanded);
  if (std::abs(map_->value(c, channel_[c].raw) - commanded) <= bound) {
    channel_[c].error_since = -1.0;
    return false;
  }
  if (channel_[c].error_since < 0.0) channel_[c].error_since = t;
  return t - channel_[c].error_since >= settings_.torque_error_time;
}

SensorFinding SensorWatch::judge(const DeviceSample& sample, const JointArray& torque,
                                 const DigitArray& force) noexcept {
  const bool backwards = started_ && sample.time_us <= last_time_us_;
  last_time_us_ = sample.time_us;
  if (backwards) {
    ++clock_bad_;
    return {clock_bad_ >= settings_.bad_samples ? Fault::kClockBackwards : Fault::kNone, -1};
  }
  clock_bad_ = 0;
  const double t = 1e-6 * static_cast<double>(sample.time_us);

  const auto& channels = map_->channels();
  SensorFinding finding;
  const auto found = [&](Fault fault, std::size_t c) {
    if (finding.fault == Fault::kNone) finding = {fault, static_cast<int>(c)};
  };
  for (std::size_t c = 0; c < channels.size(); ++c) {
    Channel& channel = channel_[c];
    if (!started_ || sample.raw[c] != channel.raw) channel.still_since = t;
    channel.raw = sample.raw[c];
  }
  started_ = true;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    Channel& channel = channel_[c];
    if (is_angle(channels[c])) {
      const Fault fault = judge_angle(c, t);
      channel.bad = fault == Fault::kNone ? 0 : channel.bad + 1;
      if (channel.bad >= settings_.bad_samples) found(fault, c);
      if (channel.still_since == t) {
        for (std::size_t w = 0; w < witness_.size(); ++w) {
          if (channels[c].kind == ChannelKind::kAngle && witness_[w].arm[idx(channels[c].index)] != 0.0)
            witnessed_[c * witness_.size() + w] = moved_by(witness_[w], c);
        }
      } else if (stands_still(c, t)) {
        found(Fault::kStuckSensor, c);
      }
    } else if (channels[c].kind == ChannelKind::kTorque) {
      const double wanted = sample.factor * torque[idx(channels[c].index)];
      if (disagrees(c, wanted, settings_.torque_error, t)) found(Fault::kTorqueDisagrees, c);
    } else if (channels[c].kind == ChannelKind::kForce) {
      const double wanted = sample.factor * force[idx(channels[c].index)];
      if (disagrees(c, wanted, settings_.force_error, t)) found(Fault::kTorqueDisagrees, c);
    }
  }
  return finding;
}

std::vector<MotorWitness> motor_witnesses(const Exoskeleton& exoskeleton,
                                          const std::vector<DeviceChannel>& channels, double largest_torque) {
  std::vector<MotorWitness> witnesses;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].kind != ChannelKind::kMotor || idx(channels[c].index) >= exoskeleton.motors.size())
      continue;
    const ExoMotor& motor = exoskeleton.motors[idx(channels[c].index)];
    std::array<double, kJoints> least{};
    for (const JointLinkage& linkage : motor.linkages) least[idx(linkage.joint)] = least_arm(linkage);
    // Each joint bounds the tension to its largest torque over its arm, at worst the least one of a linkage.
    double longest = 0.0;
    for (std::size_t j = 0; j < kJoints; ++j)
      longest = std::max(longest, std::abs(least[j] != 0.0 ? least[j] : motor.arm[j]));
    if (longest == 0.0) continue;
    const double tension = std::min(motor.force_limit, largest_torque / longest) + motor.bias;
    witnesses.push_back({.channel = static_cast<int>(c),
                         .arm = motor.arm,
                         .linkages = motor.linkages,
                         .least_arm = least,
                         .slack = 2.0 * tension / motor.tendon_stiffness + motor.backlash});
  }
  return witnesses;
}

}  // namespace phalanx
