// SPDX-License-Identifier: Apache-2.0
// The range of motion that a patient reached without help, measured on a calibrated device.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include "phalanx/device/channel_map.h"
#include "phalanx/device/device.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// Smallest and largest angle of a joint [rad].
struct AngleRange {
  double min = 0.0;
  double max = 0.0;
};

/// A range for each joint; none: it was not measured.
using JointRanges = std::array<std::optional<AngleRange>, kJoints>;

/// Content of a file with a patient's own range of motion. It belongs to one device and one calibration of it.
struct MeasuredRange {
  std::string device = {};       ///< DeviceInfo::name
  std::string serial = {};       ///< DeviceInfo::serial
  std::string calibration = {};  ///< Calibration::date of the calibration that it was measured with
  std::string patient = {};      ///< label of the patient, not a name; may be empty
  std::string date = {};         ///< UTC, as Calibration::date
  std::string phalanx = {};      ///< version of the program that made it
  JointRanges joint{};
};

/// Checks that a range was measured on this device with this calibration.
/// @param calibration  Calibration::date
/// @throws CalibrationError naming both and the remedy
void check_range(const MeasuredRange& range, const DeviceInfo& device, const std::string& calibration);

/// @returns the ranges with those of joints that follow a measured one, through ratio and offset.
[[nodiscard]] JointRanges with_followers(JointRanges ranges, std::span<const CoupledJoint> coupled);

}  // namespace phalanx
