// SPDX-License-Identifier: Apache-2.0
// A hand file: one person's lengths, breadths and ranges of motion, in mm and degrees.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// Where a hand file's segment meshes are: its table [meshes].
struct HandMeshFiles {
  std::string place;                           ///< "FILE:LINE: meshes", for messages
  std::filesystem::path collision;             ///< a path in which `{segment}` stands for the segment's name
  std::filesystem::path display;               ///< the same; empty: the collision meshes are shown
  std::filesystem::path skin;                  ///< the continuous skin's file; empty: there is none
  double unit = 1e-3;                          ///< one unit of the files [m]
  Handedness handedness = Handedness::kRight;  ///< which hand the files show

  /// `pattern` (collision or display) with the segment's WebXR name in the place of `{segment}`.
  [[nodiscard]] static std::filesystem::path of_segment(const std::filesystem::path& pattern, int segment);
};

/// What a hand file says.
struct HandFile {
  HandParameters parameters;
  std::optional<HandMeshFiles> meshes;  ///< none: the hand is made of capsules
};

/// Reads a hand file, its table [meshes] too; the mesh files themselves are not opened.
/// @throws SceneError as load_hand_file().
[[nodiscard]] HandFile read_hand_file(const std::string& name_or_path,
                                      const std::filesystem::path& base = ".");

/// The same from text; `origin` names it in messages, the mesh files' paths are relative to `folder`.
[[nodiscard]] HandFile parse_hand_file(const std::string& text, const std::string& origin,
                                       const std::filesystem::path& folder = ".");

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
