// SPDX-License-Identifier: Apache-2.0
// A hand's collision meshes and display meshes.
#pragma once

#include "phalanx/hand/hand_model.h"

namespace phalanx {

/// Both sets of meshes of one hand, of one handedness, each mesh in its segment's frame S [m]. The collision
/// meshes are closed and wind outwards. The display meshes may be open. Often both sets are the same.
struct HandMeshes {
  SegmentMeshes collision;
  SegmentMeshes display;
};

/// Mirrors exactly in the plane x = 0: negates each x, and reverses each triangle so that an outward
/// winding stays outward. A right hand's segment becomes a left hand's. Applied twice, it gives the same
/// bits again. Set-up only.
void mirror(TriangleMesh& mesh) noexcept;
void mirror(SegmentMeshes& meshes) noexcept;

}  // namespace phalanx
