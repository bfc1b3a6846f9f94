// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// Test whether a segment lies inside the object, or part of the object inside the segment, while their
/// surfaces are apart. Only closed parts of the object contain anything. A point is inside if the
/// triangles' solid angles, seen from it, sum to more than half the sphere. Set-up only: O(vertices x
/// triangles) at worst.
class Containment {
 public:
  explicit Containment(const TriangleMesh& object);

  /// @returns true if one contains a point of the other
  /// @param segment  closed, in its own frame; placed in the world by X_WS
  [[nodiscard]] bool with(const TriangleMesh& segment, const Pose& X_WS) const;

 private:
  std::vector<Vec3> points_;          ///< the object's vertices in use by a triangle
  std::vector<TriangleMesh> closed_;  ///< the object's closed parts
};

/// Returns the generalised winding number of a mesh around a point: +-1 inside a closed mesh, 0 outside, a
/// fraction near an open one.
[[nodiscard]] double winding_number(const TriangleMesh& mesh, const Vec3& point);

}  // namespace phalanx
