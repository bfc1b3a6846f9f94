// SPDX-License-Identifier: Apache-2.0
// The checks of a scene: every key of the tree against scene_keys(), then conditions on several keys.
#pragma once

#include <filesystem>
#include <string>

#include "scene/scene_problems.h"
#include "scene/scene_tree.h"

namespace phalanx {

/// Reads the scene of a tree. It does not open the files that the scene names.
/// @param origin  the scene's file: its name is the scene's
/// @param folder  relative paths in the scene are relative to it
/// @throws SceneError  as `problems` does
[[nodiscard]] SceneDescription read_scene(const SceneTree& tree, const std::string& origin,
                                          const std::filesystem::path& folder, SceneProblems& problems);

}  // namespace phalanx
