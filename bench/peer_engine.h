// SPDX-License-Identifier: Apache-2.0
// The seam between the rules of the GDP, as the peers keep them, and what answers questions of distance.
#pragma once

#include <limits>
#include <vector>

#include "phalanx/core/math.h"

namespace phalanx::bench {

/// The nearest points of a segment and the object, in W [m].
struct Nearest {
  double distance = std::numeric_limits<double>::infinity();  ///< the cap if nothing is nearer than it
  Vec3 on_segment = Vec3::Zero();
  Vec3 on_object = Vec3::Zero();
};

/// One pair of triangles with its nearest points, in W [m].
struct ClosePair {
  double distance = 0.0;
  Vec3 on_segment = Vec3::Zero();
  Vec3 on_object = Vec3::Zero();
  int segment_triangle = 0;  ///< in the segment's mesh
  int object_triangle = 0;   ///< in the object's mesh

  /// From the object to the segment, unit length; zero where they touch.
  [[nodiscard]] Vec3 direction() const {
    return distance > 0.0 ? Vec3((on_segment - on_object) / distance) : Vec3(Vec3::Zero());
  }
};

/// Distances of the hand's segments, at any pose, from the object. Each answer is exact to rounding.
class DistanceEngine {
 public:
  DistanceEngine() = default;
  DistanceEngine(const DistanceEngine&) = delete;
  DistanceEngine& operator=(const DistanceEngine&) = delete;
  virtual ~DistanceEngine() = default;

  /// The nearest pair if it is nearer than `cap` [m].
  [[nodiscard]] virtual Nearest nearest(int segment, const Pose& X_WS, double cap) = 0;

  /// Every pair of triangles not farther apart than `limit` [m], into `pairs`, which is cleared first.
  virtual void pairs_within(int segment, const Pose& X_WS, double limit, std::vector<ClosePair>& pairs) = 0;
};

}  // namespace phalanx::bench
