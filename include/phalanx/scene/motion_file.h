// SPDX-License-Identifier: Apache-2.0
// Motions as CSV (comma-separated values): a header with `time_s` and names of joints (any, in any order),
// times in s, angles in rad, any rate. Lines that begin with # are comments.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "phalanx/device/motion.h"
#include "phalanx/hand/sensor_mapping.h"

namespace phalanx {

/// Reads a motion. Without a mapping, every column but `time_s` must be a joint's name. With a mapping, the
/// columns that it names must exist, and others are ignored. Completed joints follow. Joints without a column
/// stay at `open_angle`. Motion::angle_origin states which joints are measured. Linear in the file's size.
/// Set-up only.
/// @param trial  number of the trial, counted from 1, in a file whose time runs backwards: it holds several
/// trials. Without it, such a file is refused, and the message states how many there are. Of the rows outside
/// the trial, only the time is read.
/// @throws SceneError naming file, line, column, value and remedy. It refuses a missing or empty file, a
/// missing, unknown or duplicate column, a ragged row, and text, NaN or infinity in place of a number. It
/// refuses time that does not increase, an unknown trial, and a line of more than 64 KiB. It also refuses an
/// angle of more than a full turn (degrees instead of radians).
[[nodiscard]] Motion load_motion(const std::filesystem::path& file,
                                 const std::optional<SensorMapping>& mapping = {},
                                 std::optional<int> trial = {}, const JointArray& open_angle = {});

/// Reads a motion from memory; `origin` names it in messages. For fuzzing and uploads.
[[nodiscard]] Motion parse_motion(std::string_view text, const std::string& origin,
                                  const std::optional<SensorMapping>& mapping = {},
                                  std::optional<int> trial = {}, const JointArray& open_angle = {});

}  // namespace phalanx
