// SPDX-License-Identifier: Apache-2.0
// phalanx scene grasps: how hands of several sizes hold the objects of scenes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace phalanx {

/// Options of `phalanx scene grasps`.
struct SceneGraspsOptions {
  std::vector<std::string> scenes;    ///< empty: all in scenes/ with grasp.type
  std::vector<std::string> profiles;  ///< empty: the scene's own hand
  std::filesystem::path out;          ///< CSV; empty: none
};

/// Plays each scene with each hand until the end of its hold, and prints a table in Markdown: the digits that press with
/// their pads, the palm, and the closure margin.
/// @returns an exit code: kFailed if a hand does not hold an object
int tabulate_grasps(const SceneGraspsOptions& options);

}  // namespace phalanx
