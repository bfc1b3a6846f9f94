// SPDX-License-Identifier: Apache-2.0
// A hand as URDF and as MJCF, for other people's simulators.                                 docs/hands.md
#pragma once

#include <string>

#include "phalanx/scene/hand_meshes.h"

namespace phalanx {

/// Assumed for every segment's inertia [kg/m^3]: our own round number for soft tissue and bone together.
inline constexpr double kHandDensity = 1100.0;

/// Where the meshes lie, relative to the exported file: folders that hold `<segment>.obj`, in metres, each in
/// its segment's frame.
struct ExportedMeshes {
  std::string collision = "meshes";
  std::string display = "meshes";
};

/// URDF: the root link `wrist` is the palm in H; 15 segment links with our segments' (WebXR's) names, whose
/// frames are our segment frames S at any angle; 20 revolute joints with our joints' names, angles [rad],
/// axes and limits. The two joints of a digit's first segment have a link without mass between them,
/// `<joint>_link`. Efforts and velocities are LimitParameters' defaults. Masses and inertias come from the
/// collision meshes' volume and kHandDensity. Numbers have 17 digits.
/// @pre closed collision meshes (load_hand() has made sure). Set-up only.
[[nodiscard]] std::string urdf_text(const LoadedHand& hand, const ExportedMeshes& meshes);

/// MJCF for MuJoCo: the same frames, names, limits and inertias, each body with one inertial; a digit's first
/// body has both its joints. `meshes.collision` and `.display` are relative to the file. Collision geoms are
/// in group 3, display geoms in group 2; MuJoCo takes the convex hull of a collision mesh. Pairs that touch
/// by construction are excluded: the palm with every segment, the first segments of neighbouring digits with
/// each other.
/// @pre as urdf_text(). Set-up only.
[[nodiscard]] std::string mjcf_text(const LoadedHand& hand, const ExportedMeshes& meshes);

}  // namespace phalanx
