// SPDX-License-Identifier: Apache-2.0
// From a device's raw counts to the sample that step() takes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/device/device.h"
#include "phalanx/hand/angle_origin.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/hand/joints.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// A joint that is not sensed but follows a sensed one, for example the distal interphalangeal joint (DIP)
/// from the proximal one (PIP):  q = ratio q_of + offset.
struct CoupledJoint {
  int joint = 0;        ///< joint_index() of the joint that follows
  int of = 0;           ///< joint_index() of one of the device's joints
  double ratio = 1.0;   ///< [-]
  double offset = 0.0;  ///< [rad]
};

/// Rule for a digit that the device does not have. It shows the angles of another digit, joint by joint,
///   q = q_open + gain (q_of - q_of,open),
/// or goes along a way of its own.
struct DigitCopy {
  int of = -1;        ///< digit that is copied; -1: none, this digit stays at the open hand
  double gain = 1.0;  ///< [-] >= 0; 0: this digit stays at the open hand
  /// Displacements of this digit and of the other one in a planned grasp [rad]. If `way_of` is not zero, this digit goes
  /// as far along its way as the other one along its own:
  ///   q = q_open + s way,  s = gain ((q_of - q_of,open) . way_of) / |way_of|^2  within `least_share` and `most_share`.
  /// Only joints count that the device measures; where these have no way, the digit is copied joint by joint.
  DigitAngles way{};
  DigitAngles way_of{};
  double least_share = 0.0;  ///< from here ..
  double most_share = 1.0;   ///< .. to here all joints of this digit are within their range of motion
};

/// Rules for all joints that a device does not sense.
struct JointFollowers {
  std::vector<CoupledJoint> coupled;
  std::array<DigitCopy, kDigits> copy{};
};

/// Sets the joints of an angle, a curl or a splay at a value; other channels set none. Real-time.
/// @param min, max  the hand's range of motion [rad]
void put_angles(const DeviceChannel& channel, double value, const JointArray& min, const JointArray& max,
                JointArray& angle) noexcept;

/// Map from raw counts, through gain and offset, to all joint angles and the optional channels:
///   angle channel   sets its joint
///   curl c          sets its digit's flexion joints to  min + c (max - min)
///   splay s         sets its digit's abduction to  middle of its range + s half of its range
/// Coupled joints, then copied digits, follow; all other joints stay at the open hand. A joint that a channel
/// sets does not follow. Motor channels do not affect the hand.
class ChannelMap {
 public:
  /// @throws std::invalid_argument naming the channel if an index or a number is out of range, or two
  /// channels set one joint. Set-up only.
  ChannelMap(std::vector<DeviceChannel> channels, JointFollowers followers, const HandParameters& hand);

  /// @returns the channels as given.
  [[nodiscard]] const std::vector<DeviceChannel>& channels() const noexcept { return channels_; }
  /// @returns the value of a channel in its own unit. Real-time.
  /// @pre channel < channels().size()
  [[nodiscard]] double value(std::size_t channel, std::int32_t raw) const noexcept {
    return channels_[channel].gain * static_cast<double>(raw) + channels_[channel].offset;
  }
  /// Sets all of `out`; its time is the device's clock [s]. Raw values outside a channel's range are
  /// converted like any other. Real-time: no allocation, lock, throw or I/O.
  void convert(const DeviceSample& raw, Sample& out) const noexcept;
  /// @returns the origin of each joint's angle, which convert() writes to each sample. Measured: an angle or
  /// a splay. Completed: a curl, which sets several joints from one sensor, and joints that follow a joint
  /// that is not fixed.
  [[nodiscard]] const AngleOrigins& angle_origins() const noexcept { return angle_origin_; }
  /// @returns the angle channel of this joint; -1: none. Real-time.
  /// @pre 0 <= joint < kJoints
  [[nodiscard]] int angle_channel(int joint) const noexcept {
    return angle_channel_[static_cast<std::size_t>(joint)];
  }

 private:
  void measure(std::size_t channel, double value, Sample& out) const noexcept;

  std::vector<DeviceChannel> channels_;
  JointFollowers followers_;
  JointArray open_{};
  JointArray min_{};
  JointArray max_{};
  std::array<int, kJoints> angle_channel_{};
  std::array<bool, kJoints> measured_{};  ///< a channel sets the joint
  AngleOrigins angle_origin_{};
};

}  // namespace phalanx
