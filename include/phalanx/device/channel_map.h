// SPDX-License-Identifier: Apache-2.0
// From a device's raw counts to the sample that step() takes.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "phalanx/device/device.h"
#include "phalanx/device/exoskeleton.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// What a device's joints say of those that it does not sense: Exoskeleton's `coupled` and `copy`.
struct JointFollowers {
  std::vector<CoupledJoint> coupled;
  std::array<DigitCopy, kDigits> copy{};
};

/// Every joint's angle and the optional channels, from raw counts through gain and offset:
///   angle channels set their joint;  a curl c sets its digit's flexion joints to  min + c (max - min);  a
///   splay s sets its abduction to the middle of its range + s half of it;  coupled joints and copied digits
///   follow; all others stay at the open hand.
/// A joint that a channel sets does not follow. Motor channels say nothing about the hand.
class ChannelMap {
 public:
  /// @throws std::invalid_argument naming the channel if an index or a number is out of range, or two
  /// channels set one joint. Set-up only.
  ChannelMap(std::vector<DeviceChannel> channels, JointFollowers followers, const HandParameters& hand);

  /// As given.
  [[nodiscard]] const std::vector<DeviceChannel>& channels() const noexcept { return channels_; }
  /// Value of a channel in its own unit. Real-time.
  [[nodiscard]] double value(std::size_t channel, std::int32_t raw) const noexcept {
    return channels_[channel].gain * static_cast<double>(raw) + channels_[channel].offset;
  }
  /// All of `out`; its time is the device's clock [s]. Raw values outside a channel's range are converted
  /// like any other. Real-time: no allocation, lock, throw or I/O.
  void convert(const DeviceSample& raw, Sample& out) const noexcept;
  /// The angle channel of this joint; -1: none.
  [[nodiscard]] int angle_channel(int joint) const noexcept {
    return angle_channel_[static_cast<std::size_t>(joint)];
  }

 private:
  void measure(std::size_t channel, double value, Sample& out) const noexcept;
  void follow(JointArray& angle) const noexcept;

  std::vector<DeviceChannel> channels_;
  JointFollowers followers_;
  JointArray open_{};
  JointArray min_{};
  JointArray max_{};
  std::array<int, kJoints> angle_channel_{};
  std::array<bool, kJoints> measured_{};  ///< a channel sets the joint
};

/// Followers of a device file.
[[nodiscard]] JointFollowers followers_of(const Exoskeleton& exoskeleton);

}  // namespace phalanx
