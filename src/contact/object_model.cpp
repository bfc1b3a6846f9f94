// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/object_model.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace phalanx {

ObjectModel::ObjectModel(TriangleMesh mesh, double crease_angle) : mesh_(std::move(mesh)) {
  check_mesh(mesh_, "object");
  constexpr double kFarthest =
      1e4;  // squares and products of larger numbers lose the micrometres that contacts are made of
  for (const Vec3& v : mesh_.vertices) {
    if (v.cwiseAbs().maxCoeff() > kFarthest) {
      throw std::invalid_argument(
          "object: a vertex is " + std::to_string(v.cwiseAbs().maxCoeff()) +
          " m from the world's origin, more than 10 km; give the object's size (size_mm)");
    }
  }
  tree_ = TriangleTree(mesh_, 1);
  normals_ = surface_normals(mesh_, crease_angle);
}

Vec3 ObjectModel::normal_at(int triangle, const Vec3& weight) const noexcept {
  const auto& normal = normals_.corner[static_cast<std::size_t>(triangle)];
  const Vec3 sum = weight[0] * normal[0] + weight[1] * normal[1] + weight[2] * normal[2];
  const double length = sum.norm();
  return length > 1e-9 ? Vec3(sum / length) : normal[0];
}

}  // namespace phalanx
