// SPDX-License-Identifier: Apache-2.0
// Reading a study file (TOML). Its form is in docs/cli.md.
#pragma once

#include <filesystem>
#include <string>

#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// Reads a study. Whether its keys and values make sense to the scene is not known before run_study() has
/// checked every point.
/// @throws SceneError naming file:line, key, value and remedy; an unknown key is answered with the nearest
/// known one.
[[nodiscard]] Study load_study(const std::filesystem::path& file);

/// The same from text; `origin` names it in messages.
[[nodiscard]] Study parse_study(const std::string& text, const std::string& origin,
                                const std::filesystem::path& folder);

/// The scene as load_scene() takes it: a name, or an absolute path.
[[nodiscard]] std::string scene_of(const Study& study);

/// The most trials that a point can need if stability is monotone, and of the whole study.
struct TrialEstimate {
  int per_point = 0;
  long long all = 0;
};
[[nodiscard]] TrialEstimate most_trials(const Study& study);

}  // namespace phalanx
