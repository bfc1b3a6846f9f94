// SPDX-License-Identifier: Apache-2.0
// A calibration file (TOML), which `phalanx device calibrate` writes and a station reads.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "phalanx/device/calibration.h"

namespace phalanx {

/// Version of the format below; a file of another version is refused.
inline constexpr int kCalibrationFormat = 2;

/// @returns true for a date such as "2026-05-04T09:30:00Z".
[[nodiscard]] bool is_calibration_date(std::string_view text);

/// Writes a calibration as the text of its file:
///   format = 2
///   device = "opengloves"            # DeviceInfo::name
///   serial = "0001"                  # of the one device that it is for
///   date = "2026-05-04T09:30:00Z"
///   phalanx = "0.1.0"
///   [[channel]]
///   kind = "angle"                   # angle, curl, splay
///   joint = "index_pip_flexion"      # angle; a curl or splay names its digit: digit = "index"
///   gain = 0.00042                   # value = gain raw + offset; an angle in rad
///   offset = -0.21
///   residual_rad = 0.011             # of the worst pose
///   method = "goniometer"            # jig, stops, goniometer
///   date = "2026-05-03T10:00:00Z"    # only of a channel that was kept from an earlier calibration
///   poses = [ { name = "index_pip_flexion first", raw = 3021.5, value = 1.05, residual_rad = 0.002 }, ... ]
/// Numbers are read back to the same bits.
/// @throws std::invalid_argument if the format cannot express a channel.
[[nodiscard]] std::string calibration_text(const Calibration& calibration);

/// Reads a calibration file.
/// @throws SceneError naming file, line, key, value and remedy. It refuses a missing file, broken TOML, an
/// unknown or a missing key, another format, and an invalid date. It refuses no channel, more than
/// kMaxChannels, and a channel twice. It also refuses a number that is not finite or out of range, and a gain
/// of 0. Set-up only.
[[nodiscard]] Calibration load_calibration(const std::filesystem::path& file);

/// Reads a calibration from text; `origin` names it in messages.
[[nodiscard]] Calibration parse_calibration(const std::string& text, const std::string& origin);

}  // namespace phalanx
