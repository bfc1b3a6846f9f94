// SPDX-License-Identifier: Apache-2.0
// Motions as CSV: a header `time_s` and joint names (any of them, in any order), times in s, angles in rad,
// any rate.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "phalanx/device/motion.h"
#include "phalanx/hand/sensor_mapping.h"

namespace phalanx {

/// Reads a motion. Without a mapping every column but `time_s` must be a joint's name; with one, the columns
/// that it names must be there and the others are ignored. Joints without a column stay at `open_angle`.
/// @param trial  a file whose time runs backwards holds several trials: which one to read, counted from 1.
/// Without it
///               such a file is refused with a message that says how many there are. Rows outside the trial
///               are only searched for time.
/// @throws SceneError naming file, line, column, value and remedy: missing or empty file, missing, unknown or
/// duplicate column, ragged
///         row, text or NaN or infinity in a number, time that stands still or runs backwards, no such trial,
///         a line of more than 64 KiB, an angle of more than a full turn (degrees taken for radians). Linear
///         in the file's size. Set-up only.
[[nodiscard]] Motion load_motion(const std::filesystem::path& file,
                                 const std::optional<SensorMapping>& mapping = {},
                                 std::optional<int> trial = {}, const JointArray& open_angle = {});

/// The same from memory; `origin` names it in messages. For fuzzing and uploads.
[[nodiscard]] Motion parse_motion(std::string_view text, const std::string& origin,
                                  const std::optional<SensorMapping>& mapping = {},
                                  std::optional<int> trial = {}, const JointArray& open_angle = {});

/// Writes `time_s` and all 20 joints with the digits that read back to the same bits. @throws
/// std::runtime_error if it cannot be written.
void write_motion_csv(const Motion& motion, const std::filesystem::path& file);

}  // namespace phalanx
