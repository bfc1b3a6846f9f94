// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "phalanx/hand/sensor_mapping.h"

namespace phalanx {

/// Reads a mapping file (TOML). It has a `description` and one table a joint:
///   [index_pip_flexion]
///   source = "index_pip"     # column or sensor
///   sign = -1                # 1 (default) or -1
///   gain = 1.0               # > 0, rad per unit of the source; default 1
///   offset_rad = 0.0         # or offset_deg; default 0
///   clamp_deg = [0, 100]     # or clamp_rad; optional
/// @param name_or_path  a name in assets/mappings or a path (contains `/` or ends with .toml),
/// relative to `base`
/// @throws SceneError naming file, line, key, value and remedy. Set-up only.
[[nodiscard]] SensorMapping load_mapping_file(const std::string& name_or_path,
                                              const std::filesystem::path& base = ".");

/// Reads a mapping from text; `origin` names it in messages.
[[nodiscard]] SensorMapping parse_mapping(const std::string& text, const std::string& origin);

}  // namespace phalanx
