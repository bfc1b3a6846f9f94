// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/core/math.h"

namespace phalanx {

/// Indices of a triangle's corners, counter-clockwise seen from outside.
using Triangle = std::array<std::int32_t, 3>;

/// An indexed triangle mesh; positions in metres in the frame that its owner states. A closed mesh's
/// triangles wind counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

/// Appends `part` to `mesh`, its vertices mapped by `X` (X_mesh_part). `part` may be `mesh` itself.
/// @throws std::invalid_argument if there would be more vertices than 32-bit indices reach.
void append(TriangleMesh& mesh, const TriangleMesh& part, const Pose& X = {});

/// Every edge is shared by exactly two triangles that run through it in opposite directions; false for an
/// empty mesh. O(n log n).
[[nodiscard]] bool is_closed(const TriangleMesh& mesh);

/// Volume enclosed by a closed mesh [m^3], positive if the triangles wind counter-clockwise seen from
/// outside: sum of (a x b) . c / 6 over the triangles. @pre valid indices.
[[nodiscard]] double signed_volume(const TriangleMesh& mesh);

/// Smallest and largest coordinate over the vertices [m]; of no vertices: +infinity and -infinity.
struct Bounds {
  Vec3 min;
  Vec3 max;
};
[[nodiscard]] Bounds bounds(const TriangleMesh& mesh);

/// Throws std::invalid_argument with a clear message that starts with `name` unless the mesh has at least one
/// triangle, finite vertices and valid indices.
void check_mesh(const TriangleMesh& mesh, const char* name);

}  // namespace phalanx
