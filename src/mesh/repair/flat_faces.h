// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "mesh/repair/near_vertices.h"

namespace phalanx::mesh {

/// Returns the height of a triangle over its longest edge [m].
[[nodiscard]] double height_of(const TriangleMesh& mesh, std::size_t triangle) noexcept;
/// Returns the number of triangles lower than `flat` [m].
[[nodiscard]] std::size_t count_flat_faces(const TriangleMesh& mesh, double flat);
/// Returns the longest edge of a triangle lower than `flat` [m].
[[nodiscard]] Spot longest_flat_face(const TriangleMesh& mesh, double flat);

/// Removes triangles lower than `flat` [m] from manifold surfaces without opening them. If the third corner
/// lies on the longest edge, that edge is flipped with the triangle beyond it, provided that neither new
/// triangle is flat. If two corners are within the allowance's reach, they become one.
/// A flat triangle stays if its removal would change the topology, or if it is at a vertex of very
/// many triangles. Every change reduces the number of triangles or of flat ones, so that no later
/// change undoes it.
/// @returns the number of flat triangles removed
Mended remove_flat_faces(TriangleMesh& mesh, double flat, Allowance& allowance);

}  // namespace phalanx::mesh
