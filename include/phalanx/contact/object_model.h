// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "phalanx/contact/compact_normals.h"
#include "phalanx/contact/object_tree.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// What the hand meets: one triangle mesh in the world (several objects merged), its search tree, and its
/// normals. Constant.
class ObjectModel {
 public:
  /// No object: nothing is ever met.
  ObjectModel() = default;

  /// @param mesh          in world frame W [m]
  /// @param crease_angle  normals are interpolated over edges whose dihedral is below it [rad]
  /// @throws std::invalid_argument if the mesh is empty, has a vertex that is not finite, or an invalid
  /// index.
  explicit ObjectModel(TriangleMesh mesh, double crease_angle = kDefaultCreaseAngle);

  static constexpr double kDefaultCreaseAngle = 0.523598775598299;  // 30 degrees

  [[nodiscard]] const TriangleMesh& mesh() const noexcept { return mesh_; }
  [[nodiscard]] const ObjectTree& tree() const noexcept { return tree_; }
  [[nodiscard]] int triangle_count() const noexcept { return static_cast<int>(mesh_.triangles.size()); }

  /// The surface normal at the point with barycentric coordinates `weight` on a triangle, unit length (or the
  /// triangle's own where the corner normals cancel). Real-time.
  [[nodiscard]] Vec3 normal_at(int triangle, const Vec3& weight) const noexcept;

  /// Which edges of the triangle no second face continues: bit k for the edge from corner k to the next one
  /// (SurfaceNormals::open_edges). Real-time.
  [[nodiscard]] int open_edges(int triangle) const noexcept { return normals_.open_edges(triangle); }

 private:
  TriangleMesh mesh_;
  ObjectTree tree_;
  CompactNormals normals_;
};

}  // namespace phalanx
