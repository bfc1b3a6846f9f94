// SPDX-License-Identifier: Apache-2.0
// The grasp of a scene: with `grasp.type` wrist and motion are those of a planned grasp (docs/grasps.md).
#pragma once

#include <functional>
#include <string>

#include "phalanx/grasp/plan_grasp.h"
#include "phalanx/mesh/triangle_mesh.h"
#include "phalanx/scene/hand_meshes.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/scene/scene.h"

namespace phalanx {

/// Returns 16 hexadecimal digits that tell one planned grasp from another: a 64-bit FNV-1a hash of the type, whether
/// others are tried, the seed, the directions, the hand's chains, ranges of motion and meshes, and the objects' vertices,
/// in steps of 1 um and 1 urad. A hand and objects have the same as their mirror images in x = 0. Set-up only.
/// @pre grasp.type
/// @param mirrored  hand and world are the mirror image of the scene
[[nodiscard]] std::string grasp_checksum(const GraspDescription& grasp, const LoadedHand& hand,
                                         const TriangleMesh& world, bool mirrored);

/// Returns a planned grasp as a scene states it: the wrist's pose, the angles of the motion "posture", and the checksum.
/// @param mirrored  the grasp is of a mirrored scene, which is written as its mirror image
[[nodiscard]] Overrides grasp_values(const PlannedGrasp& grasp, bool mirrored, const std::string& checksum);

/// Plans a grasp of a resolved scene, whatever type, wrist and motion it states; seed and directions are the scene's.
/// @param progress  GraspOptions::progress; may be empty
/// @throws std::invalid_argument if there is no object. Set-up only.
[[nodiscard]] GraspSearch search_grasp(const ResolvedScene& scene, GraspType type,
                                       std::function<bool(double)> progress);

}  // namespace phalanx
