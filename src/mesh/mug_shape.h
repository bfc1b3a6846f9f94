// SPDX-License-Identifier: Apache-2.0
// The exact surfaces that a mug's vertices lie on. Internal to src/mesh and its tests.
#pragma once

#include "mesh/stitched_solid.h"

namespace phalanx::mesh {

/// Lengths [m]; the mug stands along z, centred at the origin, its handle on the +x side.
struct MugShape {
  double radius = 0.0;  ///< outer
  double half_height = 0.0;
  double wall = 0.0;                   ///< thickness; the rim is a half circle over it
  double floor = 0.0;                  ///< thickness
  double foot_fillet = 0.0;            ///< radius of the outer bottom edge
  double inner_fillet = 0.0;           ///< radius of the inner bottom edge
  double handle_half_span = 0.0;       ///< the handle's centre line is a half ellipse: this half axis along z
  double handle_reach = 0.0;           ///< and this one along x, from the outer wall
  double handle_half_width = 0.0;      ///< of its elliptic section, along y
  double handle_half_thickness = 0.0;  ///< of its elliptic section, across
  double flare = 0.0;                  ///< by how much the section grows towards the wall [-]
};

[[nodiscard]] MugShape mug_shape(double diameter, double height);
[[nodiscard]] RevolvedSurface mug_body(const MugShape& shape);
[[nodiscard]] Tube mug_handle(const MugShape& shape);

}  // namespace phalanx::mesh
