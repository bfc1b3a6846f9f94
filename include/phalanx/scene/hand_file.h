// SPDX-License-Identifier: Apache-2.0
// A hand file: one person's lengths, breadths and ranges of motion, in mm and degrees.
#pragma once

#include <filesystem>
#include <string>

#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// Reads a hand file (TOML, see assets/hands/adult.toml) into SI units and radians.
/// @param name_or_path  a name in assets/hands ("adult") or a path (contains `/` or ends with .toml),
/// relative to `base`
/// @throws SceneError naming file, line, key, value and remedy: missing file, broken TOML, unknown, missing
/// or misplaced key, a number
///         that is not finite or out of range, an empty range of motion, an open angle outside it, `distal`
///         parallel to `dorsal`.
/// Set-up only.
[[nodiscard]] HandParameters load_hand_file(const std::string& name_or_path,
                                            const std::filesystem::path& base = ".");

/// The same from text; `origin` names it in messages. For tests and uploads.
[[nodiscard]] HandParameters parse_hand(const std::string& text, const std::string& origin);

}  // namespace phalanx
