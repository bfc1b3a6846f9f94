// SPDX-License-Identifier: Apache-2.0
// What the mesh tests ask of a surface, by brute force and without the code under test.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::test {

/// V - E + F.
[[nodiscard]] int euler_characteristic(const TriangleMesh& mesh);

/// Empty if every edge is run through once in each direction, every vertex is used and the triangles around
/// every vertex form one closed fan; else what is wrong first.
[[nodiscard]] std::string manifold_flaw(const TriangleMesh& mesh);

/// Height over the longest side of the worst triangle; sqrt(3)/2 is equilateral, 0 degenerate.
[[nodiscard]] double worst_shape(const TriangleMesh& mesh);

/// Pairs of triangles that cross each other beyond the vertices and edges they share, or that are folded onto
/// each other.
[[nodiscard]] std::size_t self_intersections(const TriangleMesh& mesh);

/// Where all triangles' corners are, whatever the vertices' numbers.
[[nodiscard]] std::vector<Vec3> corner_positions(const TriangleMesh& mesh);

/// Largest coordinate minus the smallest, per axis.
[[nodiscard]] Vec3 extents(const TriangleMesh& mesh);

}  // namespace phalanx::test
