// SPDX-License-Identifier: Apache-2.0
// The poses that a wearer is led through, and what each channel must say there.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

struct CalibrationPose {
  std::string name;                          ///< "fist", "index_pip_flexion bent"
  std::string instruction;                   ///< one sentence to the wearer
  std::vector<std::optional<double>> value;  ///< of each channel, in its unit; none: not known in this pose
};

/// Open hand, fist, spread, then the two end stops of each joint or digit that a channel measures; without
/// those in which no channel's value is known.
///   open hand  the hand's open angles
///   fist       largest flexion of the fingers; the thumb has its end stops for that
///   spread     largest abduction; the middle finger stays where it is
///   end stops  the hand's largest and smallest angle (curl 1 and 0, splay 1 and -1)
/// @param hand  the wearer's: its range of motion is believed. Set-up only.
[[nodiscard]] std::vector<CalibrationPose> calibration_poses(std::span<const DeviceChannel> channels,
                                                             const HandParameters& hand);

}  // namespace phalanx
