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

  /// O(parts) if segment and parts are outside the boxes around each other. Otherwise O(triangles) of a closed
  /// part that the segment may be in, and of the segment for each part that may be in it.
  /// @returns true if one contains the other, or a part of the other
  /// @param segment  closed, in its own frame; placed in the world by X_WS. Of a segment in several parts only
  /// the part with its first vertex is tested for being inside the object.
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
