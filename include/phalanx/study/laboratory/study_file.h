// SPDX-License-Identifier: Apache-2.0
// Reading a study file (TOML). docs/cli.md describes its form.
#pragma once

#include <filesystem>
#include <string>

#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// Reads a study. run_study() checks later whether its keys and values fit the scene.
/// @throws SceneError naming file and line, key, value and remedy; for an unknown key also the nearest known
/// one.
[[nodiscard]] Study load_study(const std::filesystem::path& file);

/// Reads a study from text; `origin` names it in messages.
[[nodiscard]] Study parse_study(const std::string& text, const std::string& origin,
                                const std::filesystem::path& folder);

/// @returns the scene as load_scene() takes it: a name, or an absolute path.
[[nodiscard]] std::string scene_of(const Study& study);

/// Largest number of trials if stability is monotone, for a point and for the whole study.
struct TrialEstimate {
  int per_point = 0;
  long long all = 0;
};
/// @returns the largest numbers of trials of a study.
[[nodiscard]] TrialEstimate most_trials(const Study& study);

}  // namespace phalanx
