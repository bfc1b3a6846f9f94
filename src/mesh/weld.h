// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Makes vertices at exactly equal positions one, in the order of their first use by a triangle; drops
/// vertices that no triangle uses and triangles two of whose corners fall on one vertex (they have no area).
/// Coordinates must not be NaN. O(n log n), deterministic.
[[nodiscard]] TriangleMesh weld(const TriangleMesh& soup);

}  // namespace phalanx::mesh
