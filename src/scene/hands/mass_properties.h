// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// Mass properties of a segment.
struct MassProperties {
  double mass = 0.0;            ///< [kg]
  Vec3 centre = Vec3::Zero();   ///< centre of mass, in the mesh's frame [m]
  Mat3 inertia = Mat3::Zero();  ///< about the centre of mass, along the mesh's axes [kg m^2]
};

/// Computes the mass properties of a solid of one density [kg/m^3]. They are the sum over the tetrahedra
/// between a point and the triangles. With the three corners v1, v2, v3, their determinant D, and s = v1 +
/// v2 + v3:
///   volume D / 6,   first moment D s / 24,   second moment D (v1 v1' + v2 v2' + v3 v3' + s s') / 120
/// @pre closed, winding outwards
[[nodiscard]] MassProperties mass_properties(const TriangleMesh& mesh, double density) noexcept;

}  // namespace phalanx
