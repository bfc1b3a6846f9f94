// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene_problems.h"
#include "scene/scene_tree.h"

namespace phalanx {

/// Refuses each key that has no row in scene_keys(), naming the nearest known one. Keys below `device.` and
/// `patient.`, except `file`, are left to those files' readers.
/// @throws SceneError  as `problems` does
void refuse_unknown_keys(const SceneTree& tree, SceneProblems& problems);

}  // namespace phalanx
