// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "mesh/near_vertices.h"

namespace phalanx::mesh {

/// Height of a triangle over its longest edge [m].
[[nodiscard]] double height_of(const TriangleMesh& mesh, std::size_t triangle) noexcept;
[[nodiscard]] std::size_t count_flat_faces(const TriangleMesh& mesh, double flat);
/// Longest edge of a triangle lower than `flat` [m].
[[nodiscard]] Spot longest_flat_face(const TriangleMesh& mesh, double flat);

/// Takes triangles lower than `flat` [m] out of manifold surfaces without opening them: where the third
/// corner lies on the longest edge, that edge is flipped with the triangle beyond it if neither of the two
/// new ones is flat; where two corners are within the allowance's reach, they become one. What cannot be done
/// without changing how the surface hangs together stays, as do flat triangles at a vertex of very many.
/// Every change leaves fewer triangles or fewer flat ones: none is undone by a later one.
/// @returns how many flat triangles went
Mended remove_flat_faces(TriangleMesh& mesh, double flat, Allowance& allowance);

}  // namespace phalanx::mesh
