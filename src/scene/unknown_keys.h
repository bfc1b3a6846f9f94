// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene_tree.h"

namespace phalanx {

/// Keys below `device.` and `patient.` but `file` are left to those files' readers.
/// @throws SceneError for the first key that is in no row of key_table(), naming the nearest one.
void refuse_unknown_keys(const SceneTree& tree);

}  // namespace phalanx
