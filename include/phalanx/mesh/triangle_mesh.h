// SPDX-License-Identifier: Apache-2.0
// Indexed triangle mesh. The folder `mesh` makes and imports meshes; all of it is set-up and may throw:
// 1. primitives.h and objects.h generate meshes of exact dimensions.
// 2. import.h reads mesh files through Assimp, in an isolated process. It repairs the triangles: it welds
//    vertices, closes cracks and turns shells outward. It can also reduce their number.
// 3. mesh_report.h reports defects that were found and repaired.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "phalanx/core/math.h"

namespace phalanx {

/// Indices of a triangle's corners, counter-clockwise seen from outside.
using Triangle = std::array<std::int32_t, 3>;

/// Indexed triangle mesh with positions in metres, in the frame that its owner states. Triangles of a closed
/// mesh wind counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

/// Makes a mesh from arrays as engines and libraries hold them, in any frame. Set-up only.
/// @param coordinates  x, y, z of each vertex, one vertex after the other [m]
/// @param indices      three vertices a triangle, counted from 0, counter-clockwise seen from outside
/// @throws std::invalid_argument if a length is not a multiple of three, and as check_mesh()
[[nodiscard]] TriangleMesh mesh_from_arrays(std::span<const double> coordinates,
                                            std::span<const std::int32_t> indices);

/// Appends `part` to `mesh`, its vertices mapped by `X` (X_mesh_part). `part` may be `mesh`
/// itself. Set-up only.
/// @throws std::invalid_argument if there would be more vertices than 32-bit indices reach
void append(TriangleMesh& mesh, const TriangleMesh& part, const Pose& X = {});

/// @returns true if every edge is shared by exactly two triangles that run through it in opposite directions;
/// false for an empty mesh. O(n log n); set-up only.
[[nodiscard]] bool is_closed(const TriangleMesh& mesh);

/// Returns the volume enclosed by a closed mesh [m^3]: the sum of (a x b) . c / 6 over the triangles. It is
/// positive if they wind counter-clockwise seen from outside.
/// @pre valid indices
[[nodiscard]] double signed_volume(const TriangleMesh& mesh);

/// Smallest and largest coordinates of a mesh's vertices [m]; +infinity and -infinity without vertices.
struct Bounds {
  Vec3 min;
  Vec3 max;
};
[[nodiscard]] Bounds bounds(const TriangleMesh& mesh);

/// Checks that a mesh has at least one triangle, finite vertices and valid indices. Set-up only.
/// @throws std::invalid_argument with a message that starts with `name`, if it does not
void check_mesh(const TriangleMesh& mesh, const char* name);

}  // namespace phalanx
