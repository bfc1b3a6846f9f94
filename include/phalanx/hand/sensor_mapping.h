// SPDX-License-Identifier: Apache-2.0
// Mapping of raw sensor values to joint angles, for a recording's columns and a live device's sensors.
#pragma once

#include <string>
#include <vector>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// Mapping of one source to one joint's angle:  q = gain * sign * raw + offset, then clamped.
struct JointMapping {
  int joint = 0;           ///< number of the joint
  std::string source;      ///< the recording's column or the device's sensor
  double sign = 1.0;       ///< +1 or -1: the direction in which the source counts
  double gain = 1.0;       ///< [rad per unit of the source] > 0
  double offset = 0.0;     ///< [rad]
  double clamp_min = 0.0;  ///< [rad]; used if `clamped`
  double clamp_max = 0.0;  ///< [rad]; used if `clamped`
  bool clamped = false;
};

/// Mapping of all joints that have a source, at most one each. The others stay at the open hand's angles.
struct SensorMapping {
  std::string name;
  std::vector<JointMapping> joints;
};

/// Returns the angle of a mapped joint for the raw value of its source [rad]. NaN gives NaN, even if clamped.
/// Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] double mapped_angle(const JointMapping& mapping, double raw) noexcept;

/// Returns the mapping of a motion file without a mapping: each joint reads the column of its own
/// name, in rad.
[[nodiscard]] SensorMapping identity_mapping();

/// Checks a mapping. Set-up only.
/// @throws std::invalid_argument naming the joint, if an entry is invalid. A joint may appear once and needs
/// a source. Its numbers must be finite, its sign +1 or -1, its gain above 0, and its clamp not empty.
void check_mapping(const SensorMapping& mapping);

}  // namespace phalanx
