// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/mesh/mesh_report.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Measures exact distances to the other surface from each surface's vertices, centroids and edge midpoints.
/// The greatest is a lower bound of the Hausdorff distance, because a surface may bulge between these points.
/// O(n log n).
[[nodiscard]] SurfaceDeviation measure_deviation(const TriangleMesh& original, const TriangleMesh& decimated);

}  // namespace phalanx::mesh
