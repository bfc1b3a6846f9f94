// SPDX-License-Identifier: Apache-2.0
// From what a device measures to joint angles: the same for a recording's columns and for a live device's
// sensors.
#pragma once

#include <string>
#include <vector>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// One joint's angle from one source:  q = gain * sign * raw + offset, then clamped.
struct JointMapping {
  int joint = 0;           ///< which joint
  std::string source;      ///< the recording's column or the device's sensor
  double sign = 1.0;       ///< +1 or -1: which way the source counts
  double gain = 1.0;       ///< [rad per unit of the source] > 0
  double offset = 0.0;     ///< [rad]
  double clamp_min = 0.0;  ///< [rad]; used if `clamped`
  double clamp_max = 0.0;  ///< [rad]; used if `clamped`
  bool clamped = false;
};

/// The joints that have a source, at most one each; the others stay at the open hand.
struct SensorMapping {
  std::string name;
  std::vector<JointMapping> joints;
};

/// Angle of a mapped joint for the raw value of its source [rad]; NaN in, NaN out, also where it is clamped.
/// Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] double mapped_angle(const JointMapping& mapping, double raw) noexcept;

/// Every joint reads the column of its own name, in rad: what a motion file without a mapping means.
[[nodiscard]] SensorMapping identity_mapping();

/// @throws std::invalid_argument naming the joint if a joint appears twice, a source is empty, a number is
/// not finite, a sign is not
///         +1 or -1, a gain is not above 0, or a clamp is empty.
void check_mapping(const SensorMapping& mapping);

}  // namespace phalanx
