// SPDX-License-Identifier: Apache-2.0
// The hand that a scene names: its numbers, which hand it is, and its meshes out of files.
#pragma once

#include <optional>

#include "phalanx/hand/hand_meshes.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/hand/hand_skin.h"
#include "phalanx/scene/hand_file.h"
#include "phalanx/scene/scene.h"

namespace phalanx {

/// A hand's numbers without its meshes: what a motion needs.
struct HandNumbers {
  HandParameters parameters;                   ///< of a right hand
  Handedness handedness = Handedness::kRight;  ///< which hand it is
};

struct LoadedHand {
  HandParameters parameters;                   ///< of a right hand
  Handedness handedness = Handedness::kRight;  ///< which hand it is
  HandMeshes meshes;                           ///< of that hand
};

/// The numbers of the hand that a scene describes: its hand file's, or its profile's. Opens no mesh.
/// @throws SceneError as read_hand_file(), load_profile() and fit_profile(). Set-up only.
[[nodiscard]] HandNumbers load_hand_numbers(const HandDescription& hand);

/// The hand that a scene describes, with both sets of meshes, fitted if it names a profile. If its hand file
/// names none, or the scene says `hand.meshes = "capsules"`, both are capsules of about `hand.triangles`
/// triangles. Display meshes that the hand file leaves out are the collision meshes.
/// @throws SceneError as load_hand_numbers(); if `hand.triangles` is stated for a hand whose meshes are
/// files; or naming the mesh file, its value and the remedy: no such file, not readable, a collision mesh
/// that is not closed or winds inwards, a vertex more than 300 mm from the segment's joint or a largest
/// extent below 3 mm (then the unit is wrong). Set-up only: one forked reader a file.
[[nodiscard]] LoadedHand load_hand(const HandDescription& hand);

/// The collision meshes of load_hand() alone: half of the files. Throws as load_hand().
[[nodiscard]] SegmentMeshes load_collision_meshes(const HandDescription& hand);

/// The display meshes of load_hand() alone: what a picture draws in the segments' frames. Throws as
/// load_hand().
/// @param collision  of the same hand: what is shown where it has no other meshes to be shown
[[nodiscard]] SegmentMeshes load_display_meshes(const HandDescription& hand, const SegmentMeshes& collision);

/// The continuous skin of the hand that a scene describes, fitted if it names a profile, of its handedness.
/// None if its hand file names none, or the scene says `hand.meshes = "capsules"`.
/// @throws SceneError as load_hand_numbers(), or naming the skin file, the element, its value and the remedy:
/// no such file, larger than 16 MB, broken JSON, a missing or misshapen entry, an unknown segment, an index
/// without a vertex, weights that are not above 0 or whose sum is not 1 to 0.001, a vertex more than 300 mm
/// from the wrist's centre. Set-up only.
[[nodiscard]] std::optional<HandSkin> load_hand_skin(const HandDescription& hand);

}  // namespace phalanx
