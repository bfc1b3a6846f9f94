// SPDX-License-Identifier: Apache-2.0
// What a scene states, flat, for whoever shows it.
#pragma once

#include <string>

#include "phalanx/scene/scene.h"

namespace phalanx {

/// Every value that the scene's file or an override states, as TOML text, by its path ("objects.0.size_mm");
/// what is left out has its default (scene_keys()). Values are not checked: load_scene() does.
/// @throws SceneError: no such scene, or no TOML. Set-up only.
[[nodiscard]] Overrides scene_values(const std::string& scene, const Overrides& overrides);

}  // namespace phalanx
