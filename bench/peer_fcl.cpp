// SPDX-License-Identifier: Apache-2.0
#include "peer_fcl.h"

#include <fcl/narrowphase/detail/primitive_shape_algorithm/triangle_distance.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <fcl/narrowphase/detail/traversal/distance/mesh_distance_traversal_node.h>
#include <fcl/narrowphase/distance.h>

namespace phalanx::bench {
namespace {

using Transform = fcl::Transform3<double>;
using Traversal = fcl::detail::MeshDistanceTraversalNodeOBBRSS<double>;

/// FCL computes in millimetres here. It treats a triangle as degenerate if the square of its doubled area is below 1e-15.
/// In metres that is so for edges of 0.18 mm, and FCL may then report the distance 0 for triangles that are apart.
constexpr double kScale = 1e3;

std::shared_ptr<FclEngine::Model> model_of(const TriangleMesh& mesh) {
  std::vector<Vec3> vertices = mesh.vertices;
  for (Vec3& x : vertices) x *= kScale;
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    triangles.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                           static_cast<std::size_t>(t[2]));
  }
  auto model = std::make_shared<FclEngine::Model>();
  model->beginModel();
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

Transform transform_of(const Pose& X) {
  Transform T = Transform::Identity();
  T.linear() = X.R;
  T.translation() = kScale * X.p;
  return T;
}

/// FCL's own distance traversal, except that the bound does not shrink and every pair within it is kept.
class PairCollector : public Traversal {
 public:
  PairCollector(double limit, const Pose& X_WS, std::vector<ClosePair>& pairs)
      : limit_(limit), X_WS_(X_WS), pairs_(pairs) {}

  [[nodiscard]] bool canStop(double bound) const override { return bound > kScale * limit_; }

  void leafTesting(int b1, int b2) const override {
    const int i = this->model1->getBV(b1).primitiveId();
    const int j = this->model2->getBV(b2).primitiveId();
    const fcl::Triangle& s = this->tri_indices1[i];
    const fcl::Triangle& t = this->tri_indices2[j];
    Vec3 on_segment;
    Vec3 on_object;
    const double distance =
        fcl::detail::TriangleDistance<double>::triDistance(
            this->vertices1[s[0]], this->vertices1[s[1]], this->vertices1[s[2]], this->vertices2[t[0]],
            this->vertices2[t[1]], this->vertices2[t[2]], this->tf, on_segment, on_object) /
        kScale;
    if (distance > limit_) return;
    pairs_.push_back({distance, X_WS_ * (on_segment / kScale), X_WS_ * (on_object / kScale), i, j});
  }

 private:
  double limit_;
  const Pose& X_WS_;
  std::vector<ClosePair>& pairs_;
};

}  // namespace

FclEngine::FclEngine(const HandModel& hand, const TriangleMesh& object) : object_(model_of(object)) {
  for (int s = 0; s < kSegments; ++s) segment_[static_cast<std::size_t>(s)] = model_of(hand.mesh(s));
}

Nearest FclEngine::nearest(int segment, const Pose& X_WS, double cap) {
  const fcl::DistanceRequest<double> request(true);
  fcl::DistanceResult<double> result(kScale * cap);  // the bound that FCL's traversal begins with
  fcl::distance<double>(segment_[static_cast<std::size_t>(segment)].get(), transform_of(X_WS), object_.get(),
                        Transform::Identity(), request, result);
  if (!(result.min_distance < kScale * cap)) return {.distance = cap};
  return {result.min_distance / kScale, result.nearest_points[0] / kScale, result.nearest_points[1] / kScale};
}

void FclEngine::pairs_within(int segment, const Pose& X_WS, double limit, std::vector<ClosePair>& pairs) {
  pairs.clear();
  PairCollector collector(limit, X_WS, pairs);
  fcl::DistanceResult<double> unused;
  if (!fcl::detail::initialize(collector, *segment_[static_cast<std::size_t>(segment)], transform_of(X_WS),
                               *object_, Transform::Identity(), fcl::DistanceRequest<double>(true), unused)) {
    return;
  }
  fcl::detail::distanceRecurse<double>(&collector, 0, 0, nullptr);
}

}  // namespace phalanx::bench
