// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/object_model.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace phalanx {

ObjectModel::ObjectModel(TriangleMesh mesh, double crease_angle) : mesh_(std::move(mesh)) {
  check_mesh(mesh_, "object");
  // Farther out, squares and products lose the micrometres that a contact needs.
  constexpr double kFarthest = 1e4;
  for (const Vec3& v : mesh_.vertices) {
    if (v.cwiseAbs().maxCoeff() > kFarthest) {
      throw std::invalid_argument(
          "object: a vertex is " + std::to_string(v.cwiseAbs().maxCoeff()) +
          " m from the world's origin, more than 10 km; give the object's size (size_mm)");
    }
  }
  tree_ = ObjectTree(mesh_);
  normals_ = CompactNormals(surface_normals(mesh_, crease_angle));
}

Vec3 ObjectModel::normal_at(int triangle, const Vec3& weight) const noexcept {
  const Vec3 first = normals_.normal(triangle, 0);
  const Vec3 sum =
      weight[0] * first + weight[1] * normals_.normal(triangle, 1) + weight[2] * normals_.normal(triangle, 2);
  const double length = sum.norm();
  return length > 1e-9 ? Vec3(sum / length) : first;
}

}  // namespace phalanx
