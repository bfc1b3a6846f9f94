// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene_problems.h"
#include "scene/scene_tree.h"

namespace phalanx {

/// Keys below `device.` and `patient.` but `file` are left to those files' readers.
/// A problem is each key that is in no row of key_table(), with the nearest one that is.
/// @throws SceneError  as `problems` does
void refuse_unknown_keys(const SceneTree& tree, SceneProblems& problems);

}  // namespace phalanx
