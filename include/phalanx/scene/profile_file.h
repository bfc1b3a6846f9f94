// SPDX-License-Identifier: Apache-2.0
// A patient's profile: whose hand it is, how large, and how far its joints move.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "phalanx/hand/fit.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// What a profile states, in SI units and radians.
struct Profile {
  std::string name;
  std::string hand = "adult";    ///< the base hand file: a name in assets/hands, or a path
  std::filesystem::path folder;  ///< of the profile: a relative path in `hand` starts here
  std::string origin;            ///< the profile's file, for messages
  Handedness handedness = Handedness::kRight;
  HandSize size;
  std::array<std::string, kSegments - 1>
      breadth_stated_at;  ///< "FILE:LINE: KEY", for messages; empty: nowhere
  std::array<std::optional<std::pair<double, double>>, kJoints> range;  ///< of motion, where stated [rad]
};

/// The hand of a profile.
struct FittedHand {
  HandParameters parameters;  ///< of a right hand, named after the profile
  HandFit fit;                ///< what was done to the base hand
};

/// Reads a profile (TOML):
///   name = "..."  hand = "adult"  handedness = "right"
///   hand_length_mm = 190  hand_breadth_mm = 85
///   segments = [ { name = "index-finger-phalanx-proximal", length_mm = 41, breadth_mm = 19 } ]
///   [range_of_motion]
///   index_pip_flexion = [0, 60]
/// `name` and `handedness` must be there. Lengths and breadths: fit.h; ranges: degrees.
/// @param name_or_path  a name in assets/profiles or a path (contains `/` or ends with .toml), relative to
/// `base`
/// @throws SceneError naming file, line, key, value and remedy: missing file, broken TOML, unknown or missing
/// key, a segment twice, and values that are implausible: sizes outside the published mean +- 4 SD, angles
/// outside what is anatomically possible (anthropometry.h). Set-up only.
[[nodiscard]] Profile load_profile(const std::string& name_or_path, const std::filesystem::path& base = ".");

/// The same from text; `origin` names it in messages, paths are relative to `folder`.
[[nodiscard]] Profile parse_profile(const std::string& text, const std::string& origin,
                                    const std::filesystem::path& folder = ".");

/// The base hand fitted to the profile: sizes, and the ranges of motion that it states. An open angle outside
/// a stated range moves to the range's nearer end.
/// @throws SceneError naming the profile, the segment, the value and its range if a size that only follows
/// from the stated ones is implausible, or a segment is too short for its breadth. Set-up only.
[[nodiscard]] FittedHand fit_profile(const Profile& profile, const HandParameters& base);

}  // namespace phalanx
