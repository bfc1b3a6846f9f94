// SPDX-License-Identifier: Apache-2.0
// Martin Newell's teapot: the control points of its bicubic Bezier patches, in his units, z up, spout to +x.
// M. E. Newell, "The Utilization of Procedure Models in Digital Image Synthesis", PhD thesis, University of
// Utah, 1975; the body stands on z = 0 and is 4 units wide. Internal to src/mesh and its tests.
#pragma once

#include "mesh/stitched_solid.h"

namespace phalanx::mesh {

/// The body's profile from the bottom's centre to the lid's top. Pieces: 0 bottom, 1 lower body, 2 upper
/// body, 3 rim (all Newell's), 4 the straight bridge from the rim's inner edge to the lid's edge (ours:
/// Newell leaves a gap there), 5 lid, 6 knob (Newell's).
[[nodiscard]] RevolvedSurface newell_body();
inline constexpr int kNewellBridge = 4;

/// Newell's patches of the handle and of the spout as tubes: a = 0 .. 1/2 runs over the half with y < 0, v
/// over both patches. The spout's end section (plane z = 2.4) is closed by a flat disc (ours).
[[nodiscard]] Tube newell_handle();
[[nodiscard]] Tube newell_spout();

inline constexpr double kNewellHeight = 3.15;

}  // namespace phalanx::mesh
