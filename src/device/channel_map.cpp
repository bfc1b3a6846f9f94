// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/channel_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "phalanx/core/index.h"
#include "phalanx/device/exoskeleton.h"

namespace phalanx {
namespace {

constexpr int kMotorsAtMost = 256;  ///< the link's index has 8 bits

std::string_view kind_name(ChannelKind kind) {
  constexpr std::array<std::string_view, 6> kNames{"angle", "torque", "force", "motor", "curl", "splay"};
  const auto k = static_cast<std::size_t>(kind);
  return k < kNames.size() ? kNames[k] : "unknown kind";
}

/// @returns the number of joints, digits or motors that an index may select.
int indices(ChannelKind kind) {
  switch (kind) {
    case ChannelKind::kAngle:
    case ChannelKind::kTorque:
      return kJoints;
    case ChannelKind::kForce:
    case ChannelKind::kCurl:
    case ChannelKind::kSplay:
      return kDigits;
    case ChannelKind::kMotor:
      return kMotorsAtMost;
  }
  return 0;
}

[[noreturn]] void refuse(std::size_t c, const DeviceChannel& channel, const std::string& what) {
  throw std::invalid_argument(
      fmt::format("channel {} ({} {}): {}", c, kind_name(channel.kind), channel.index, what));
}

void check(std::size_t c, const DeviceChannel& channel) {
  const int most = indices(channel.kind);
  if (channel.index < 0 || channel.index >= most)
    refuse(c, channel, fmt::format("its index must be 0 .. {}; correct the device's channels", most - 1));
  if (!std::isfinite(channel.gain) || channel.gain == 0.0)
    refuse(c, channel,
           fmt::format("its gain {} must be finite and not 0; calibrate the device", channel.gain));
  if (!std::isfinite(channel.offset))
    refuse(c, channel, fmt::format("its offset {} must be finite; calibrate the device", channel.offset));
  if (channel.raw_min >= channel.raw_max)
    refuse(c, channel,
           fmt::format("raw_min {} must be below raw_max {}; correct the device's channels", channel.raw_min,
                       channel.raw_max));
}

/// @returns true if the channel sets this joint of its digit.
bool sets(const DeviceChannel& channel, int joint) noexcept {
  switch (channel.kind) {
    case ChannelKind::kAngle:
      return channel.index == joint;
    case ChannelKind::kCurl:
      return channel.index == digit_of_joint(joint) && joint % kJointsPerDigit != kAbductionJoint;
    case ChannelKind::kSplay:
      return joint == joint_index(channel.index, kAbductionJoint);
    case ChannelKind::kTorque:
    case ChannelKind::kForce:
    case ChannelKind::kMotor:
      return false;
  }
  return false;
}

void check_followers(const JointFollowers& followers) {
  for (const CoupledJoint& joint : followers.coupled) {
    const bool known = joint.joint >= 0 && joint.joint < kJoints && joint.of >= 0 && joint.of < kJoints;
    if (!known || !std::isfinite(joint.ratio) || !std::isfinite(joint.offset))
      throw std::invalid_argument(fmt::format(
          "coupled joint {} of {}: both must be 0 .. {}, ratio {} and offset {} finite; correct the device "
          "file",
          joint.joint, joint.of, kJoints - 1, joint.ratio, joint.offset));
  }
  for (std::size_t d = 0; d < followers.copy.size(); ++d) {
    const DigitCopy& copy = followers.copy[d];
    const auto finite = [](double x) { return std::isfinite(x); };
    if (!std::all_of(copy.way.begin(), copy.way.end(), finite) ||
        !std::all_of(copy.way_of.begin(), copy.way_of.end(), finite) ||
        !(copy.least_share <= copy.most_share))
      throw std::invalid_argument(
          fmt::format("copy of the {}: its way is not finite or has no range; correct the motion",
                      digit_name(static_cast<int>(d))));
    if (copy.of >= kDigits || !std::isfinite(copy.gain))
      throw std::invalid_argument(
          fmt::format("copy of the {}: digit {} must be below {} and the gain {} finite; correct the device "
                      "file",
                      digit_name(static_cast<int>(d)), copy.of, kDigits, copy.gain));
  }
}

constexpr double kLeastWay = 0.05;  // of the joints that are measured [rad]

/// Returns the square of the way of the measured joints of the digit that is copied [rad^2]; 0: too little to follow it.
double measured_square(const DigitCopy& copy, const std::array<bool, kJoints>& measured) noexcept {
  double square = 0.0;
  for (int i = 0; i < kJointsPerDigit; ++i)
    if (measured[idx(joint_index(copy.of, i))]) square += copy.way_of[idx(i)] * copy.way_of[idx(i)];
  return square >= kLeastWay * kLeastWay ? square : 0.0;
}

/// Returns how far along its way a digit is that copies another: 0 at the open hand, 1 at its end.
double share_of_way(const DigitCopy& copy, const std::array<bool, kJoints>& measured, double square,
                    const JointArray& open, const JointArray& angle) noexcept {
  double along = 0.0;
  for (int i = 0; i < kJointsPerDigit; ++i) {
    const auto from = idx(joint_index(copy.of, i));
    if (measured[from]) along += copy.way_of[idx(i)] * (angle[from] - open[from]);
  }
  return std::clamp(copy.gain * along / square, copy.least_share, copy.most_share);
}

/// Sets the joints that are not measured from those that they follow: coupled joints, then copied digits.
void follow(std::span<const CoupledJoint> coupled, const std::array<DigitCopy, kDigits>& copies,
            const std::array<bool, kJoints>& measured, const JointArray& open, JointArray& angle) noexcept {
  for (const CoupledJoint& joint : coupled)
    if (!measured[idx(joint.joint)])
      angle[idx(joint.joint)] = joint.ratio * angle[idx(joint.of)] + joint.offset;
  for (int digit = 0; digit < kDigits; ++digit) {
    const DigitCopy& copy = copies[idx(digit)];
    if (copy.of < 0) continue;
    const double square = measured_square(copy, measured);
    const double share = square > 0.0 ? share_of_way(copy, measured, square, open, angle) : 0.0;
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const auto from = idx(joint_index(copy.of, i));
      const auto to = idx(joint_index(digit, i));
      if (measured[to]) continue;
      if (square > 0.0)
        angle[to] = open[to] + share * copy.way[idx(i)];
      else
        angle[to] = open[to] + copy.gain * (angle[from] - open[from]);
    }
  }
}

/// Sets the origins of the joints that follow() sets. A joint that follows a fixed one is fixed.
void follow_origins(std::span<const CoupledJoint> coupled, const std::array<DigitCopy, kDigits>& copies,
                    const std::array<bool, kJoints>& measured, AngleOrigins& origin) noexcept {
  const auto follow_one = [&](std::size_t to, AngleOrigin of) {
    if (!measured[to]) origin[to] = of == AngleOrigin::kFixed ? AngleOrigin::kFixed : AngleOrigin::kCompleted;
  };
  for (const CoupledJoint& joint : coupled)
    follow_one(idx(joint.joint), joint.ratio == 0.0 ? AngleOrigin::kFixed : origin[idx(joint.of)]);
  for (int digit = 0; digit < kDigits; ++digit) {
    const DigitCopy& copy = copies[idx(digit)];
    if (copy.of < 0) continue;
    for (int i = 0; i < kJointsPerDigit; ++i) {
      AngleOrigin of = origin[idx(joint_index(copy.of, i))];
      if (measured_square(copy, measured) > 0.0)
        of = copy.way[idx(i)] == 0.0 ? AngleOrigin::kFixed : AngleOrigin::kCompleted;
      follow_one(idx(joint_index(digit, i)), copy.gain == 0.0 ? AngleOrigin::kFixed : of);
    }
  }
}

}  // namespace

ChannelMap::ChannelMap(std::vector<DeviceChannel> channels, JointFollowers followers,
                       const HandParameters& hand)
    : channels_(std::move(channels)),
      followers_(std::move(followers)),
      open_(hand.open_angle),
      min_(hand.min_angle),
      max_(hand.max_angle) {
  if (channels_.size() > kMaxChannels)
    throw std::invalid_argument(
        fmt::format("{} channels: a device has at most {}; leave some out", channels_.size(), kMaxChannels));
  check_followers(followers_);
  angle_channel_.fill(-1);
  angle_origin_.fill(AngleOrigin::kFixed);
  std::array<int, kJoints> setter{};
  setter.fill(-1);
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    check(c, channels_[c]);
    for (int joint = 0; joint < kJoints; ++joint) {
      if (!sets(channels_[c], joint)) continue;
      if (setter[idx(joint)] >= 0)
        refuse(c, channels_[c],
               fmt::format("channel {} sets {} already; leave one of the two out", setter[idx(joint)],
                           joint_name(joint)));
      setter[idx(joint)] = static_cast<int>(c);
      angle_origin_[idx(joint)] =
          channels_[c].kind == ChannelKind::kCurl ? AngleOrigin::kCompleted : AngleOrigin::kMeasured;
      if (channels_[c].kind == ChannelKind::kAngle) angle_channel_[idx(joint)] = static_cast<int>(c);
    }
  }
  for (std::size_t j = 0; j < setter.size(); ++j) measured_[j] = setter[j] >= 0;
  follow_origins(followers_.coupled, followers_.copy, measured_, angle_origin_);
}

void put_angles(const DeviceChannel& channel, double value, const JointArray& min, const JointArray& max,
                JointArray& angle) noexcept {
  if (channel.kind == ChannelKind::kAngle) angle[idx(channel.index)] = value;
  if (channel.kind == ChannelKind::kCurl) {
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const auto j = idx(joint_index(channel.index, i));
      if (i != kAbductionJoint) angle[j] = min[j] + value * (max[j] - min[j]);
    }
  }
  if (channel.kind == ChannelKind::kSplay) {
    const auto j = idx(joint_index(channel.index, kAbductionJoint));
    angle[j] = 0.5 * (min[j] + max[j]) + value * 0.5 * (max[j] - min[j]);
  }
}

void ChannelMap::measure(std::size_t channel, double value, Sample& out) const noexcept {
  const DeviceChannel& c = channels_[channel];
  if (c.kind == ChannelKind::kTorque) out.measured_torque[idx(c.index)] = value;
  if (c.kind == ChannelKind::kForce) out.measured_force[idx(c.index)] = value;
  put_angles(c, value, min_, max_, out.angle);
}

void ChannelMap::convert(const DeviceSample& raw, Sample& out) const noexcept {
  out = Sample{};
  out.time_s = 1e-6 * static_cast<double>(raw.time_us);
  out.angle = open_;
  out.angle_origin = angle_origin_;
  for (std::size_t c = 0; c < channels_.size(); ++c) measure(c, value(c, raw.raw[c]), out);
  follow(followers_.coupled, followers_.copy, measured_, open_, out.angle);
}

JointArray sensed_angles(const Exoskeleton& exoskeleton, const JointArray& open,
                         const JointArray& angle) noexcept {
  JointArray sensed = open;
  std::array<bool, kJoints> measured{};
  for (const ExoJoint& joint : exoskeleton.joints) {
    sensed[idx(joint.joint)] = angle[idx(joint.joint)];
    measured[idx(joint.joint)] = true;
  }
  follow(exoskeleton.coupled, exoskeleton.controller.copy, measured, open, sensed);
  return sensed;
}

AngleOrigins sensed_origins(const Exoskeleton& exoskeleton) noexcept {
  AngleOrigins origin;
  origin.fill(AngleOrigin::kFixed);
  std::array<bool, kJoints> measured{};
  for (const ExoJoint& joint : exoskeleton.joints) {
    origin[idx(joint.joint)] = AngleOrigin::kMeasured;
    measured[idx(joint.joint)] = true;
  }
  follow_origins(exoskeleton.coupled, exoskeleton.controller.copy, measured, origin);
  return origin;
}

JointFollowers followers_of(const Exoskeleton& exoskeleton) {
  return {.coupled = exoskeleton.coupled, .copy = exoskeleton.controller.copy};
}

}  // namespace phalanx
