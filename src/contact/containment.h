// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// Test whether a segment lies inside the object, or part of the object inside the segment, while their
/// surfaces are apart. Only closed parts of the object contain anything. A point is inside if the
/// triangles' solid angles, seen from it, sum to more than half the sphere. Set-up only.
class Containment {
 public:
  /// An object without triangles.
  Containment() = default;
  /// Finds the parts of the object, connected by shared vertices. A triangle that occurs twice counts once.
  /// O(n log n).
  /// @param object  kept by reference: it must outlive the test, at its place
  explicit Containment(const TriangleMesh& object);
  explicit Containment(TriangleMesh&&) = delete;

  /// O(triangles of the object) at worst; O(parts) if the segment is outside the boxes around them.
  /// @returns true if one contains the other, or a part of the other
  /// @param segment  closed and connected, in its own frame; placed in the world by X_WS
  [[nodiscard]] bool with(const TriangleMesh& segment, const Pose& X_WS) const;

 private:
  struct ClosedPart {
    Bounds box;
    std::vector<std::int32_t> triangles;  ///< indices into the object's
  };
  const TriangleMesh* object_ = nullptr;
  std::vector<Vec3> point_;  ///< a vertex of each part
  std::vector<ClosedPart> closed_;
};

/// Returns the generalised winding number of a mesh around a point: +-1 inside a closed mesh, 0 outside, a
/// fraction near an open one.
[[nodiscard]] double winding_number(const TriangleMesh& mesh, const Vec3& point);

}  // namespace phalanx
