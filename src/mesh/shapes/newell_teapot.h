// SPDX-License-Identifier: Apache-2.0
// Martin Newell's teapot: control points of its bicubic Bezier patches, in his units, z up, spout to +x. The
// body stands on z = 0 and is 4 units wide. make_teapot() stitches body, handle and spout. M. E. Newell, "The
// Utilization of Procedure Models in Digital Image Synthesis", PhD thesis, University of Utah, 1975. Internal
// to src/mesh and its tests.
#pragma once

#include "mesh/shapes/stitched_solid.h"

namespace phalanx::mesh {

/// Returns the body with its profile from the bottom's centre to the lid's top. Its pieces are 0 bottom, 1
/// lower body, 2 upper body, 3 rim, 4 bridge, 5 lid, 6 knob. The bridge is ours: Newell leaves a gap between
/// the rim's inner edge and the lid's edge, and a straight line closes it.
[[nodiscard]] RevolvedSurface newell_body();

/// Returns Newell's patches of the handle or of the spout as a tube. The half with y < 0 is a = 0 .. 1/2, and
/// v covers both patches. The spout's end section (plane z = 2.4) is closed by a flat disc (ours).
[[nodiscard]] Tube newell_handle();
[[nodiscard]] Tube newell_spout();

inline constexpr double kNewellHeight = 3.15;  ///< from the bottom to the knob's top, in Newell's units

}  // namespace phalanx::mesh
