// SPDX-License-Identifier: Apache-2.0
// Every triangle of the segment against every triangle of the object: no tree, nothing to get wrong.
#pragma once

#include <array>
#include <vector>

#include "peer_engine.h"
#include "phalanx/contact/triangle_distance.h"
#include "phalanx/hand/hand_model.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::bench {

class BruteEngine : public DistanceEngine {
 public:
  BruteEngine(const HandModel& hand, const TriangleMesh& object);

  [[nodiscard]] Nearest nearest(int segment, const Pose& X_WS, double cap) override;
  void pairs_within(int segment, const Pose& X_WS, double limit, std::vector<ClosePair>& pairs) override;

 private:
  /// A triangle and the sphere around its corners' mean, the only thing by which a pair is rejected.
  struct Ball {
    Corners corners;
    Vec3 centre;
    double radius = 0.0;
  };
  [[nodiscard]] static std::vector<Ball> balls_of(const TriangleMesh& mesh, const Pose& X);
  template <class Visit>
  void for_each_pair(int segment, const Pose& X_WS, double limit, Visit&& visit) const;

  const HandModel& hand_;
  std::vector<Ball> object_;
};

}  // namespace phalanx::bench
