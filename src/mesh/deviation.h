// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/mesh/mesh_report.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Nearest point of a triangle to p (Voronoi regions of corners, edges and face). Triangles may be
/// degenerate.
[[nodiscard]] Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

/// Exact distances to the other surface from each surface's vertices, centroids and edge midpoints. The
/// greatest is a lower bound of the Hausdorff distance: a surface may bulge between the points. O(n log n).
[[nodiscard]] SurfaceDeviation measure_deviation(const TriangleMesh& original, const TriangleMesh& decimated);

}  // namespace phalanx::mesh
