// SPDX-License-Identifier: Apache-2.0
// Mapping of raw sensor values to joint angles, for a recording's columns and a live device's sensors.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// Mapping of one value to one joint's angle:  q = gain * sign * value + offset, then clamped. The value is
/// the raw value of a source or, for a joint without one, the angle of a measured joint of the same digit.
/// The latter is a completion, such as the distal interphalangeal joint (DIP) from the proximal one (PIP).
struct JointMapping {
  int joint = 0;            ///< number of the joint
  std::string source = {};  ///< the recording's column or the device's sensor; empty: the joint is completed
  double sign = 1.0;        ///< +1 or -1: the direction in which the value counts
  double gain = 1.0;        ///< [rad per unit of the source], of a completion [rad/rad] > 0
  double offset = 0.0;      ///< [rad]
  double clamp_min = 0.0;   ///< [rad]; used if `clamped`
  double clamp_max = 0.0;   ///< [rad]; used if `clamped`
  bool clamped = false;
  bool computed = false;  ///< the device computes the source from other sensors: the angle is not measured
  /// Number of the measured joint from which this joint is completed.
  std::optional<int> completed_from = std::nullopt;
};

/// Mapping of joints that have a source or are completed, each at most once. The others stay at the open
/// hand's angles.
struct SensorMapping {
  std::string name;
  std::vector<JointMapping> joints;
};

/// Returns the angle of a mapped joint [rad]. NaN gives NaN, even if clamped.
/// @param value  raw value of the source; for a completion, angle of `completed_from` [rad]
/// Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] double mapped_angle(const JointMapping& mapping, double value) noexcept;

/// Returns the mapping of a motion file without a mapping: each joint reads the column of its own
/// name, in rad.
[[nodiscard]] SensorMapping identity_mapping();

/// States what is wrong with `entry.completed_from`, with the remedy; empty: nothing. It must name another
/// joint of the same digit that is measured: with a source in `mapping` that is not computed. Set-up only.
/// @pre entry.completed_from has a value, and entry.joint is the number of a joint
[[nodiscard]] std::string completion_problem(const SensorMapping& mapping, const JointMapping& entry);

/// Checks a mapping. Set-up only.
/// @throws std::invalid_argument naming the joint, if an entry is invalid. A joint may appear once, and has
/// either a source or a completion without completion_problem(). Its numbers must be finite, its sign +1 or
/// -1, its gain above 0, and its clamp not empty.
void check_mapping(const SensorMapping& mapping);

}  // namespace phalanx
