// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "phalanx/core/math.h"

namespace phalanx::mesh {

/// Cuts a polygon, convex or not, into its n - 2 triangles by clipping ears, in the polygon's own direction.
/// If no sides cross, the triangles cover exactly the polygon. A self-crossing polygon has no inside and is
/// cut anyway. Flat corners and coincident corners give flat triangles.
/// @param corners  at least 3, finite; nearly in one plane, that of the polygon's vector area (Newell)
/// @returns indices into `corners`
/// O(n r) for r reflex corners; deterministic. Set-up only.
[[nodiscard]] std::vector<std::array<int, 3>> cut_polygon(const std::vector<Vec3>& corners);

}  // namespace phalanx::mesh
