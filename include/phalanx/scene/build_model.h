// SPDX-License-Identifier: Apache-2.0
// From a scene's description to what step() and a simulation need.
#pragma once

#include <cstddef>

#include "phalanx/device/motion.h"
#include "phalanx/mesh/triangle_mesh.h"
#include "phalanx/scene/scene.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// Of all objects of a scene together: some 500 MB with their search tree, and twice that while a running
/// station changes from one to the next.
inline constexpr std::size_t kMostSceneTriangles = 4'000'000;

/// One object's mesh in its own frame O [m].
/// @throws SceneError or std::invalid_argument naming the file or the size and the remedy. Set-up only.
[[nodiscard]] TriangleMesh make_object_mesh(const ObjectDescription& object);

/// Every object of the scene in the world frame, merged [m], mirrored in x = 0 if the scene is (its key
/// `mirror`, or the profile of a left hand); empty if it has none. Throws as make_object_mesh() and
/// load_hand_numbers(), and SceneError beyond kMostSceneTriangles.
[[nodiscard]] TriangleMesh make_world_mesh(const SceneDescription& scene);

/// The scene's hand at its pose, its objects merged into one, and its parameters; hand and objects mirrored
/// as in make_world_mesh().
/// @throws SceneError or std::invalid_argument: hand file, mesh file, sizes. Whether the open hand is clear
/// of the object is for HapticState
///         to say. Set-up only.
[[nodiscard]] HapticModel build_model(const SceneDescription& scene);

/// The scene's motion: its file through its mapping if it names one, else the script.
/// @throws SceneError or std::invalid_argument. Set-up only.
[[nodiscard]] Motion build_motion(const SceneDescription& scene);

/// How long a simulation of the scene takes [s]: scene.seconds, or the motion's duration if that is 0.
[[nodiscard]] double simulation_seconds(const SceneDescription& scene, const Motion& motion);

}  // namespace phalanx
