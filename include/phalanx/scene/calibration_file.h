// SPDX-License-Identifier: Apache-2.0
// A calibration file (TOML): what `phalanx device calibrate` writes and a station reads.
#pragma once

#include <filesystem>
#include <string>

#include "phalanx/device/calibration.h"

namespace phalanx {

/// Version of the format below; a file with another one is refused.
inline constexpr int kCalibrationFormat = 1;

/// The file's text:
///   format = 1
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
///   poses = [ { name = "fist", raw = 3021.5, value = 1.05 }, ... ]
/// Numbers read back to the same bits. @throws std::invalid_argument if a channel cannot stand in such a
/// file.
[[nodiscard]] std::string calibration_text(const Calibration& calibration);

/// Reads a calibration file.
/// @throws SceneError naming file, line, key, value and remedy: no such file, broken TOML, unknown or missing
/// key, another format, a date that is none, no channel or more than kMaxChannels, a channel twice, a number
/// that is not finite or out of range, a gain of 0. Set-up only.
[[nodiscard]] Calibration load_calibration(const std::filesystem::path& file);

/// The same from text; `origin` names it in messages.
[[nodiscard]] Calibration parse_calibration(const std::string& text, const std::string& origin);

}  // namespace phalanx
