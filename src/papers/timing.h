// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "phalanx/papers/experiments.h"
#include "phalanx/scene/scene.h"

namespace phalanx {

/// Finds the `triangles` to request from a mesh generator so that it makes as near to `target` as possible.
/// It returns the request near the target with the smallest error.
/// @param made  number of triangles that the generator makes for a request
[[nodiscard]] int best_request(int target, int (*made)(int request, const SceneDescription& scene),
                               const SceneDescription& scene);

/// @returns the triangles of the scene's hand for a request.
[[nodiscard]] int hand_triangles(int request, const SceneDescription& scene);
/// @returns the triangles of the scene's first object for a request.
[[nodiscard]] int object_triangles(int request, const SceneDescription& scene);

/// Runs the scene's motion with smoothing and without, and fills in the result's counts and runs.
void run_timing(const SceneDescription& scene, TimingResult& result);

}  // namespace phalanx
