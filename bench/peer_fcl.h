// SPDX-License-Identifier: Apache-2.0
// FCL 0.7, BVHModel<OBBRSS>, as a peer: its trees, its traversal and its distance of two triangles.
#pragma once

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>

#include <array>
#include <memory>

#include "peer_engine.h"
#include "phalanx/hand/hand_model.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::bench {

class FclEngine : public DistanceEngine {
 public:
  using Model = fcl::BVHModel<fcl::OBBRSS<double>>;

  FclEngine(const HandModel& hand, const TriangleMesh& object);

  [[nodiscard]] Nearest nearest(int segment, const Pose& X_WS, double cap) override;
  void pairs_within(int segment, const Pose& X_WS, double limit, std::vector<ClosePair>& pairs) override;

 private:
  std::array<std::shared_ptr<Model>, kSegments> segment_;
  std::shared_ptr<Model> object_;
};

}  // namespace phalanx::bench
