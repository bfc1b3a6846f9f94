// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/mesh/mesh_report.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Returns the point of a triangle nearest to p (Voronoi regions of corners, edges and face). The triangle
/// may be degenerate.
[[nodiscard]] Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

/// Measures exact distances to the other surface from each surface's vertices, centroids and edge midpoints.
/// The greatest is a lower bound of the Hausdorff distance, because a surface may bulge between these points.
/// O(n log n).
[[nodiscard]] SurfaceDeviation measure_deviation(const TriangleMesh& original, const TriangleMesh& decimated);

}  // namespace phalanx::mesh
