// SPDX-License-Identifier: Apache-2.0
// A hand as URDF (Unified Robot Description Format) and as MJCF (MuJoCo), for other simulators. docs/hands.md
#pragma once

#include <string>

#include "phalanx/scene/hand_meshes.h"

namespace phalanx {

/// Assumed density of every segment [kg/m^3]: a round value of this project for soft tissue
/// and bone together.
inline constexpr double kHandDensity = 1100.0;

/// Folders of the meshes, relative to the exported file. They hold `<segment>.obj` in metres, each in
/// its segment's frame.
struct ExportedMeshes {
  std::string collision = "meshes";
  std::string display = "meshes";
};

/// Writes a hand as URDF. The root link `wrist` is the palm in H. The 15 segment links have the segments'
/// WebXR names, and their frames are the segment frames S at any angle. The 20 revolute joints have the
/// joints' names, angles [rad], axes and limits. The two joints of a digit's first segment have a link
/// without mass between them, `<joint>_link`. Efforts and velocities are LimitParameters' defaults. Masses
/// and inertias come from the collision meshes' volume and kHandDensity. Numbers have 17 digits.
/// @pre closed collision meshes (which load_hand() checks). Set-up only.
[[nodiscard]] std::string urdf_text(const LoadedHand& hand, const ExportedMeshes& meshes);

/// Writes a hand as MJCF, with the same frames, names, limits and inertias. Each body has one inertial; a
/// digit's first body has both its joints. `meshes.collision` and `.display` are relative to the file.
/// Collision geoms are in group 3, display geoms in group 2; MuJoCo uses the convex hull of a collision mesh.
/// Pairs that touch by construction are excluded: the palm with every segment, and the first segments
/// of neighbouring digits.
/// @pre as urdf_text(). Set-up only.
[[nodiscard]] std::string mjcf_text(const LoadedHand& hand, const ExportedMeshes& meshes);

}  // namespace phalanx
