// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "phalanx/scene/scene.h"
#include "phalanx/study/experiments.h"

namespace phalanx {

/// The `triangles` to ask a maker for so that it makes as near to `target` as it can: the request near the
/// target with the smallest error.
/// @param made  what the maker makes of a request
[[nodiscard]] int best_request(int target, int (*made)(int request, const SceneDescription& scene),
                               const SceneDescription& scene);

/// Triangles of the scene's hand and of its first object for a request.
[[nodiscard]] int hand_triangles(int request, const SceneDescription& scene);
[[nodiscard]] int object_triangles(int request, const SceneDescription& scene);

/// Runs the scene's motion with smoothing and without, the result's counts and runs filled in.
void run_timing(const SceneDescription& scene, TimingResult& result);

}  // namespace phalanx
