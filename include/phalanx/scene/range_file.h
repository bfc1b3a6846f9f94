// SPDX-License-Identifier: Apache-2.0
// A file with a patient's own range of motion (TOML), which `phalanx device range` writes and a station reads.
#pragma once

#include <filesystem>
#include <string>

#include "phalanx/device/measured_range.h"

namespace phalanx {

/// Version of the format below; a file of another version is refused.
inline constexpr int kRangeFormat = 1;

/// Writes a range as the text of its file:
///   format = 1
///   device = "opengloves"                    # DeviceInfo::name
///   serial = "0001"                          # of the device that it was measured on
///   calibration = "2026-05-04T09:30:00Z"     # date of the calibration that was in use
///   patient = "P07"                          # a label, not a name; may be ""
///   date = "2026-05-04T09:45:00Z"
///   phalanx = "0.1.0"
///   [joints]
///   index_pip_flexion = [2.1, 40.3]          # smallest and largest angle that was held [deg]
[[nodiscard]] std::string range_text(const MeasuredRange& range);

/// Reads a range file.
/// @throws SceneError naming file, line, key, value and remedy: as load_calibration(), and if no joint is stated or if a
/// smallest angle is above the largest one. Set-up only.
[[nodiscard]] MeasuredRange load_range(const std::filesystem::path& file);

/// Reads a range from text; `origin` names it in messages.
[[nodiscard]] MeasuredRange parse_range(const std::string& text, const std::string& origin);

}  // namespace phalanx
