// SPDX-License-Identifier: Apache-2.0
// From a scene's description to the model of step() and the motion of a simulation.
#pragma once

#include <cstddef>

#include "phalanx/device/motion.h"
#include "phalanx/mesh/triangle_mesh.h"
#include "phalanx/scene/scene.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// Largest number of triangles of all objects together. They need some 500 MB with their search tree, and
/// twice that while a running station exchanges them.
inline constexpr std::size_t kMostSceneTriangles = 4'000'000;

/// Makes one object's mesh in its own frame O [m].
/// @throws SceneError or std::invalid_argument naming the file or the size and the remedy. Set-up only.
[[nodiscard]] TriangleMesh make_object_mesh(const ObjectDescription& object);

/// Makes the mesh of all objects in the world frame, merged [m]; it is empty if there are none. The mesh is
/// mirrored in x = 0 if the scene is (its key `mirror`, or the profile of a left hand).
/// @throws as make_object_mesh(). Also SceneError for a hand file or profile that cannot be read, and beyond
/// kMostSceneTriangles. Set-up only.
[[nodiscard]] TriangleMesh make_world_mesh(const SceneDescription& scene);

/// Builds the model: the scene's hand at its pose, and its objects merged into one, both mirrored as in
/// make_world_mesh(). Its parameters are SceneDescription::parameters.
/// @throws SceneError or std::invalid_argument: hand file, mesh file, sizes. HapticState's constructor checks
/// that the open hand does not touch the object. Set-up only; where resolve() plans a grasp it takes seconds.
[[nodiscard]] HapticModel build_model(const SceneDescription& scene);

/// Builds the scene's motion: its file, through its mapping if it names one, else the script.
/// Where the scene has its grasp planned, it plans it as resolve() does; to have model and motion, resolve once.
/// @throws SceneError or std::invalid_argument. Set-up only.
[[nodiscard]] Motion build_motion(const SceneDescription& scene);

/// @returns the length of a simulation of the scene [s]: scene.seconds, or the motion's duration if
/// that is 0.
[[nodiscard]] double simulation_seconds(const SceneDescription& scene, const Motion& motion);

}  // namespace phalanx
