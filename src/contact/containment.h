// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// Whether, their surfaces being apart, a segment lies inside the object or part of the object lies inside
/// the segment. Only the object's closed parts contain anything; inside means that the triangles' solid
/// angles, seen from the point, add up to more than half the sphere. Set-up only: O(vertices x triangles) at
/// worst.
class Containment {
 public:
  explicit Containment(const TriangleMesh& object);

  /// @param segment  closed, in its own frame; placed in the world by X_WS
  [[nodiscard]] bool with(const TriangleMesh& segment, const Pose& X_WS) const;

 private:
  std::vector<Vec3> points_;  ///< the object's vertices that a triangle uses
  std::vector<TriangleMesh> closed_;
};

/// The generalised winding number of a mesh around a point: +-1 inside a closed mesh, 0 outside, fractions
/// near open ones.
[[nodiscard]] double winding_number(const TriangleMesh& mesh, const Vec3& point);

}  // namespace phalanx
