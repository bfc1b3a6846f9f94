// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "phalanx/core/math.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

class Containment;
class ObjectTree;

/// Friction of one of the objects of an ObjectModel.
struct ObjectFriction {
  int first_triangle = 0;             ///< of the object; it ends where the next object begins
  std::optional<double> coefficient;  ///< Coulomb coefficient [-], 0 to 2; empty: ContactParameters::friction
};

/// All objects that the hand may touch, merged into one triangle mesh in the world, with its search tree and
/// its normals. Constant; copies share them.
class ObjectModel {
 public:
  /// Makes a world without objects. Set-up only.
  ObjectModel();

  /// Builds search tree and normals, and finds the closed parts. Set-up only.
  /// @param mesh          in world frame W [m]
  /// @param crease_angle  edges with a dihedral angle below it are smooth: normals are interpolated
  /// over them [rad]
  /// @param friction      of its objects, by ascending first triangle; empty: all have that of the parameters
  /// @throws std::invalid_argument if the mesh is empty or has an invalid index. Also if a vertex is not
  /// finite, or is farther than 10 km from the origin; or if a coefficient is not in 0 .. 2.
  explicit ObjectModel(TriangleMesh mesh, double crease_angle = kDefaultCreaseAngle,
                       std::vector<ObjectFriction> friction = {});

  // A move is a copy of the pointer, too, so that no object is without its parts.
  ObjectModel(const ObjectModel&) = default;
  ObjectModel& operator=(const ObjectModel&) = default;

  static constexpr double kDefaultCreaseAngle = 0.523598775598299;  // 30 degrees

  [[nodiscard]] const TriangleMesh& mesh() const noexcept;
  [[nodiscard]] int triangle_count() const noexcept;

  /// Returns the unit surface normal at the point with barycentric coordinates `weight` on a triangle. Where
  /// the corners' normals cancel out it is the first corner's. Real-time.
  [[nodiscard]] Vec3 normal_at(int triangle, const Vec3& weight) const noexcept;

  /// Returns the triangle's open edges, which no second face continues: bit k for the edge from corner k to
  /// the next one. Real-time.
  [[nodiscard]] int open_edges(int triangle) const noexcept;

  /// Returns the coefficient of friction of the triangle's object [-], or `otherwise` if it has none of its own.
  /// Real-time.
  [[nodiscard]] double friction(int triangle, double otherwise) const noexcept;

  /// Returns the search tree, for the contact search. Real-time.
  [[nodiscard]] const ObjectTree& tree() const noexcept;

  /// Returns the test whether a segment is inside the object, for the search's start. Set-up only.
  [[nodiscard]] const Containment& containment() const noexcept;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

}  // namespace phalanx
