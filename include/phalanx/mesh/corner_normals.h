// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// Normals of a mesh that approximates a smooth surface with creases.
struct SurfaceNormals {
  std::vector<std::array<Vec3, 3>> corner;  ///< at the three corners of every triangle, unit [-]
  /// Open edges of every triangle, over which no second face continues the surface: bit k for the edge from
  /// corner k to the next one. Such an edge belongs to one triangle or to three or more. It may also belong
  /// to two triangles that run through it in the same direction, or are folded back by more than 91 degrees.
  std::vector<std::uint8_t> open_edges;
};

/// Computes the unit normal at the three corners of every triangle. It is the angle-weighted mean over the
/// triangles around the vertex that smooth edges connect with this one.
/// An edge is smooth if exactly two triangles share it, run through it in opposite directions, and have at
/// most `crease_angle` between their normals. The tolerance for rounding is 1e-6 rad; at 0 no edge is smooth.
/// Normals on both sides of any other edge are independent.
/// A triangle has no normal of its own if it is too low: below a millionth of its longest extent, or 2^-22 of
/// the mesh's (files have single precision). It takes its neighbours' normal, or unit z without neighbours.
/// If it lies in an edge of two other triangles, that edge still counts as shared by two.
/// @param mesh          valid indices, finite vertices; need not be closed
/// @param crease_angle  [rad], 0 (all flat) to pi
/// @throws std::invalid_argument if the mesh or the angle is invalid
/// O(n log n), deterministic; set-up only.
[[nodiscard]] SurfaceNormals surface_normals(const TriangleMesh& mesh, double crease_angle);

/// Returns surface_normals().corner. Set-up only.
[[nodiscard]] std::vector<std::array<Vec3, 3>> corner_normals(const TriangleMesh& mesh, double crease_angle);

}  // namespace phalanx
