// SPDX-License-Identifier: Apache-2.0
// Triangles in the form that the ray tracer needs.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::picture {

using Vec3f = Eigen::Vector3f;

/// Triangles with a normal at every corner and a part number each; world frame [m].
struct RenderMesh {
  std::vector<Vec3f> vertices;
  std::vector<Vec3f> albedo;  ///< of each vertex, in linear light
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<Vec3f, 3>> normals;
  std::vector<int> part;
};

/// Options of drawing a surface.
struct CurvedLook {
  int level = 1;                           ///< number of parts into which each edge is divided
  double crease = std::numbers::pi / 3.0;  ///< an edge of a larger dihedral angle stays sharp [rad]
  std::function<int(std::size_t triangle)> part = {};  ///< part of a triangle of the mesh; none: 0
  /// Colour at a point [m], W, with its barycentric coordinates in a triangle of the mesh; none: white.
  std::function<Vec3f(std::size_t triangle, const Vec3& share, const Vec3f& point)> albedo = {};
};

/// Appends `mesh` at pose X. Every triangle becomes a curved (PN) patch of level * level flat triangles,
/// which follows the mesh's normals over smooth edges. Silhouettes therefore look round. Edges at creases
/// stay straight, so that no gap opens.
///   Vlachos, Peters, Boyd, Mitchell: Curved PN Triangles, I3D 2001
void append_curved(RenderMesh& out, const TriangleMesh& mesh, const Pose& X, const CurvedLook& look);

/// Appends a straight white arrow from `tail` along unit vector `direction`: shaft and cone.
void append_arrow(RenderMesh& out, const Vec3& tail, const Vec3& direction, double length,
                  double shaft_radius, int part);

/// Appends a white ball.
void append_ball(RenderMesh& out, const Vec3& centre, double radius, int part);

}  // namespace phalanx::picture
