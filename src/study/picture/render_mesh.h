// SPDX-License-Identifier: Apache-2.0
// Triangles as the ray tracer wants them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::picture {

using Vec3f = Eigen::Vector3f;

/// Triangles with a normal at every corner and a part number each; world frame [m].
struct RenderMesh {
  std::vector<Vec3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<Vec3f, 3>> normals;
  std::vector<int> part;
};

/// Appends `mesh` at pose X, every triangle bent into a curved (PN) patch of level * level flat ones that
/// follows the mesh's normals over smooth edges, as its makers' surfaces do: silhouettes come out round.
/// Edges at creases stay straight, so nothing tears.
///   Vlachos, Peters, Boyd, Mitchell: Curved PN Triangles, I3D 2001
void append_curved(RenderMesh& out, const TriangleMesh& mesh, const Pose& X, int part, int level);

/// A straight arrow from `tail` along unit vector `direction`: shaft and cone.
void append_arrow(RenderMesh& out, const Vec3& tail, const Vec3& direction, double length,
                  double shaft_radius, int part);

/// A ball.
void append_ball(RenderMesh& out, const Vec3& centre, double radius, int part);

}  // namespace phalanx::picture
