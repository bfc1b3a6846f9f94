// SPDX-License-Identifier: Apache-2.0
// An independent mesh-mesh oracle: FCL's exact collision and distance of triangle meshes. Tests only.
#pragma once

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance.h>

#include <memory>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::test {

/// FCL computes in millimetres: in metres it treats triangles with edges below 0.2 mm as degenerate, and may report that
/// they collide though they are apart.
class FclMesh {
 public:
  explicit FclMesh(const TriangleMesh& mesh) : model_(std::make_shared<Model>()) {
    std::vector<fcl::Triangle> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
      triangles.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                             static_cast<std::size_t>(t[2]));
    }
    model_->beginModel();
    std::vector<Vec3> vertices = mesh.vertices;
    for (Vec3& x : vertices) x *= kScale;
    model_->addSubModel(vertices, triangles);
    model_->endModel();
  }

  /// Whether the surfaces cross, this mesh placed by X, the other in the world.
  [[nodiscard]] bool collides(const Pose& X, const FclMesh& other) const {
    const fcl::CollisionObject<double> a = object(X);
    const fcl::CollisionObject<double> b = other.object(Pose{});
    fcl::CollisionRequest<double> request;
    fcl::CollisionResult<double> result;
    return fcl::collide(&a, &b, request, result) > 0;
  }

  /// Smallest distance [m].
  [[nodiscard]] double distance(const Pose& X, const FclMesh& other) const {
    const fcl::CollisionObject<double> a = object(X);
    const fcl::CollisionObject<double> b = other.object(Pose{});
    fcl::DistanceRequest<double> request;
    fcl::DistanceResult<double> result;
    return fcl::distance(&a, &b, request, result) / kScale;
  }

 private:
  using Model = fcl::BVHModel<fcl::OBBRSS<double>>;
  static constexpr double kScale = 1e3;

  [[nodiscard]] fcl::CollisionObject<double> object(const Pose& X) const {
    fcl::Transform3<double> T = fcl::Transform3<double>::Identity();
    T.linear() = X.R;
    T.translation() = kScale * X.p;
    return fcl::CollisionObject<double>(model_, T);
  }

  std::shared_ptr<Model> model_;
};

}  // namespace phalanx::test
