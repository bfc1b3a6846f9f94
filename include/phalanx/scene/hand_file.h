// SPDX-License-Identifier: Apache-2.0
// A hand file: one person's lengths, breadths and ranges of motion, in mm and degrees.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// Files of a hand's segment meshes: the table [meshes] of a hand file.
struct HandMeshFiles {
  std::string place;                           ///< "FILE:LINE: meshes", for messages
  std::filesystem::path collision;             ///< path in which `{segment}` is the segment's name
  std::filesystem::path display;               ///< such a path; empty: the collision meshes are shown
  std::filesystem::path skin;                  ///< file of the continuous skin; empty: none
  double unit = 1e-3;                          ///< unit of the files [m]
  Handedness handedness = Handedness::kRight;  ///< the hand in the files

  /// @returns `pattern` (collision or display) with the segment's WebXR name in place of `{segment}`.
  [[nodiscard]] static std::filesystem::path of_segment(const std::filesystem::path& pattern, int segment);
};

/// Content of a hand file.
struct HandFile {
  HandParameters parameters;
  std::optional<HandMeshFiles> meshes;  ///< none: capsules
};

/// Reads a hand file with its table [meshes]; the mesh files themselves are not opened.
/// @throws SceneError as load_hand_file().
[[nodiscard]] HandFile read_hand_file(const std::string& name_or_path,
                                      const std::filesystem::path& base = ".");

/// Reads a hand file from text; `origin` names it in messages, and the mesh files' paths are
/// relative to `folder`.
[[nodiscard]] HandFile parse_hand_file(const std::string& text, const std::string& origin,
                                       const std::filesystem::path& folder = ".");

/// Reads a hand file (TOML, see assets/hands/adult.toml) into SI units and radians.
/// @param name_or_path  a name in assets/hands ("adult") or a path (contains `/` or ends with .toml),
/// @throws SceneError naming file, line, key, value and remedy. It refuses a missing file, broken TOML, an
/// unknown, missing or misplaced key, and a number that is not finite or out of range. It also refuses an
/// empty range of motion, an open angle outside it, `distal` parallel to `dorsal`, and a coupling without its
/// ratio, base or axis. Set-up only.
[[nodiscard]] HandParameters load_hand_file(const std::string& name_or_path,
                                            const std::filesystem::path& base = ".");

/// Reads a hand from text; `origin` names it in messages. For tests and uploads.
[[nodiscard]] HandParameters parse_hand(const std::string& text, const std::string& origin);

}  // namespace phalanx
