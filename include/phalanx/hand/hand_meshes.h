// SPDX-License-Identifier: Apache-2.0
// A hand's meshes: what collides, and what is shown.
#pragma once

#include "phalanx/hand/hand_model.h"

namespace phalanx {

/// One hand's two sets of meshes, each in its segment's frame S and of one handedness [m]. The collision
/// meshes are closed and wind outwards; the display meshes may be open. Often both are the same.
struct HandMeshes {
  SegmentMeshes collision;
  SegmentMeshes display;
};

/// The mirror image in the plane x = 0, exactly: the signs of x change, and each triangle runs the other way
/// round, so that an outward winding stays outward. A right hand's segment becomes a left hand's. Twice is
/// the identity, to the last bit. Set-up only.
void mirror(TriangleMesh& mesh) noexcept;
void mirror(SegmentMeshes& meshes) noexcept;

}  // namespace phalanx
