// SPDX-License-Identifier: Apache-2.0
// The poses of a calibration, and the value of each channel in each pose.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// One pose of a calibration.
struct CalibrationPose {
  std::string name;                          ///< for example "fist" or "index_pip_flexion bent"
  std::string instruction;                   ///< one sentence to the wearer
  std::vector<std::optional<double>> value;  ///< value of each channel, in its unit; none: unknown
                                             ///< in this pose
};

/// Makes the poses: open hand, fist, spread, then the two end stops of each joint or digit that a channel
/// measures. Poses without a known value of any channel are left out.
///   open hand  the hand's open angles
///   fist       largest flexion of the fingers; the thumb has its end stops for that
///   spread     largest abduction; the middle finger stays where it is
///   end stops  the hand's largest and smallest angle (curl 1 and 0, splay 1 and -1)
/// @param hand  the wearer's hand; its range of motion is taken as exact. Set-up only.
[[nodiscard]] std::vector<CalibrationPose> calibration_poses(std::span<const DeviceChannel> channels,
                                                             const HandParameters& hand);

}  // namespace phalanx
