// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// The normals of a mesh that stands for a smooth surface with creases.
struct SurfaceNormals {
  std::vector<std::array<Vec3, 3>> corner;  ///< of every triangle, at its three corners, unit [-]
  /// Of every triangle, the edges over which no second face carries the surface on: bit k for the edge from
  /// corner k to the next one. The edge of one triangle only, of three or more, of two that run through it in
  /// the same direction, or of two that are folded back by more than 91 degrees.
  std::vector<std::uint8_t> open_edges;
};

/// For every triangle, the unit normal at its three corners: the angle-weighted mean over those triangles
/// around the vertex that can be reached from it through smooth edges. An edge is smooth if it is shared by
/// exactly two triangles that run through it in opposite directions, with at most `crease_angle` between
/// their normals (1e-6 rad are given for rounding; 0 is all flat). Across any other edge the normals stay
/// apart. A triangle lower than a millionth of its longest extent, or than 2^-22 of the mesh's (files have
/// single precision), has no normal of its own: it takes its neighbours', or unit z if it has none, and where
/// it lies in an edge that two others share, the edge is still shared by two.
/// @param mesh          valid indices, finite vertices; need not be closed
/// @param crease_angle  [rad], 0 (all flat) to pi
/// @throws std::invalid_argument for an invalid mesh or angle. O(n log n), deterministic; set-up only.
[[nodiscard]] SurfaceNormals surface_normals(const TriangleMesh& mesh, double crease_angle);

/// surface_normals().corner.
[[nodiscard]] std::vector<std::array<Vec3, 3>> corner_normals(const TriangleMesh& mesh, double crease_angle);

}  // namespace phalanx
