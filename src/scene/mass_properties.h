// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

struct MassProperties {
  double mass = 0.0;            ///< [kg]
  Vec3 centre = Vec3::Zero();   ///< of mass, in the mesh's frame [m]
  Mat3 inertia = Mat3::Zero();  ///< about the centre of mass, along the mesh's axes [kg m^2]
};

/// Of a solid of one density [kg/m^3], as the sum over the tetrahedra between a point and the triangles:
/// with v the three corners and D their determinant, volume D / 6, first moment D (v1 + v2 + v3) / 24, second
/// moment D (v1 v1' + v2 v2' + v3 v3' + s s') / 120, s = v1 + v2 + v3.
/// @pre closed, winding outwards
[[nodiscard]] MassProperties mass_properties(const TriangleMesh& mesh, double density) noexcept;

}  // namespace phalanx
