// SPDX-License-Identifier: Apache-2.0
// Named postures of a hand as CSV (comma-separated values), in degrees: a column `posture` with their names,
// `time_s` with their numbers, and a column for each of the 20 joints. assets/postures has some. With the
// mapping `degrees` such a file is a motion, too (motion_file.h).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// A posture of the whole hand.
struct Posture {
  std::string name;    ///< small letters, digits, '_' and '-'; the name of a picture's file
  JointArray angle{};  ///< [rad]
};

/// Reads postures, in the file's order.
/// @param name_or_path  a name in assets/postures ("adult") or a path (contains `/` or ends with .csv)
/// @throws SceneError if there is no such file, as parse_motion(), or naming file, line, name and remedy. It
/// refuses a missing column, times that do not increase, angles beyond a full turn, an empty name, one with
/// other characters or of more than 64, and a name that appears twice. Set-up only.
[[nodiscard]] std::vector<Posture> load_postures(const std::string& name_or_path,
                                                 const std::filesystem::path& base = ".");

/// Reads postures from memory; `origin` names them in messages.
[[nodiscard]] std::vector<Posture> parse_postures(std::string_view text, const std::string& origin);

}  // namespace phalanx
