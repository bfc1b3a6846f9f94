// SPDX-License-Identifier: Apache-2.0
// A patient's profile: handedness, sizes, and range of motion of a hand.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "phalanx/hand/fit.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// Content of a profile, in SI units and radians.
struct Profile {
  std::string name;
  std::string hand = "adult";    ///< the base hand file: a name in assets/hands, or a path
  std::filesystem::path folder;  ///< folder of the profile; a relative path in `hand` starts here
  std::string origin;            ///< the profile's file, for messages
  Handedness handedness = Handedness::kRight;
  HandSize size;
  std::array<std::string, kSegments - 1>
      breadth_stated_at;  ///< "FILE:LINE: KEY", for messages; empty: not stated
  std::array<std::optional<std::pair<double, double>>, kJoints> range;  ///< stated ranges of motion [rad]
};

/// The hand fitted to a profile.
struct FittedHand {
  HandParameters parameters;  ///< as a right hand, named after the profile
  HandFit fit;                ///< changes of the base hand
};

/// Reads a profile (TOML):
///   name = "..."  hand = "adult"  handedness = "right"
///   hand_length_mm = 190  hand_breadth_mm = 85
///   segments = [ { name = "index-finger-phalanx-proximal", length_mm = 41, breadth_mm = 19 } ]
///   [range_of_motion]
///   index_pip_flexion = [0, 60]
/// `name` and `handedness` are required. fit.h explains lengths and breadths; ranges are in degrees.
/// @param name_or_path  a name in assets/profiles or a path (contains `/` or ends with .toml),
/// relative to `base`
/// @throws SceneError naming file, line, key, value and remedy: missing file, broken TOML, an unknown or a
/// missing key, a segment twice, or implausible values. Sizes must lie within the published mean +- 4
/// standard deviations (SD), and angles within the anatomically possible range
/// (anthropometry.h). Set-up only.
[[nodiscard]] Profile load_profile(const std::string& name_or_path, const std::filesystem::path& base = ".");

/// Reads a profile from text; `origin` names it in messages, and paths are relative to `folder`.
[[nodiscard]] Profile parse_profile(const std::string& text, const std::string& origin,
                                    const std::filesystem::path& folder = ".");

/// Fits the base hand to the profile: its sizes, and its stated ranges of motion. An open angle outside a
/// @throws SceneError naming the profile, the segment, the value and its range. It refuses a size that
/// follows from the stated ones and is implausible, and a segment that is too short for its
/// breadth. Set-up only.
/// the stated ones is implausible, or a segment is too short for its breadth. Set-up only.
[[nodiscard]] FittedHand fit_profile(const Profile& profile, const HandParameters& base);

}  // namespace phalanx
