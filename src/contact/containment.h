// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// Whether, their surfaces being apart, a closed segment mesh (placed by X_WS) lies inside the object, or
/// part of the object lies inside the segment. Inside: the triangles' solid angles, seen from the point, add
/// up to more than half the sphere (generalised winding number). Set-up only: O(vertices x triangles) at
/// worst.
[[nodiscard]] bool one_contains_the_other(const TriangleMesh& segment, const Pose& X_WS,
                                          const TriangleMesh& object);

/// The generalised winding number of a mesh around a point: 1 inside a closed mesh, 0 outside, fractions near
/// open ones.
[[nodiscard]] double winding_number(const TriangleMesh& mesh, const Vec3& point);

}  // namespace phalanx
