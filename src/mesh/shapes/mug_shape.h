// SPDX-License-Identifier: Apache-2.0
// Exact surfaces of a mug's vertices. Internal to src/mesh and its tests.
#pragma once

#include "mesh/shapes/stitched_solid.h"

namespace phalanx::mesh {

/// Lengths of a mug [m]. It stands along z, centred at the origin, its handle on the +x side.
struct MugShape {
  double radius = 0.0;  ///< outer
  double half_height = 0.0;
  double wall = 0.0;                   ///< thickness; the rim is a half circle over it
  double floor = 0.0;                  ///< thickness
  double foot_fillet = 0.0;            ///< radius of the outer bottom edge
  double inner_fillet = 0.0;           ///< radius of the inner bottom edge
  double handle_half_span = 0.0;       ///< half axis along z of the handle's centre line, a half ellipse
  double handle_reach = 0.0;           ///< its half axis along x, from the outer wall
  double handle_half_width = 0.0;      ///< half axis of its elliptic section along y
  double handle_half_thickness = 0.0;  ///< half axis of its elliptic section across y
  double flare = 0.0;                  ///< growth of the section towards the wall [-]
};

[[nodiscard]] MugShape mug_shape(double diameter, double height);
[[nodiscard]] RevolvedSurface mug_body(const MugShape& shape);
[[nodiscard]] Tube mug_handle(const MugShape& shape);

}  // namespace phalanx::mesh
