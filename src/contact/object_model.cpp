// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/object_model.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

#include "contact/compact_normals.h"
#include "contact/containment.h"
#include "phalanx/contact/object_tree.h"

namespace phalanx {

struct ObjectModel::Parts {
  TriangleMesh mesh;
  ObjectTree tree;
  CompactNormals normals;
  Containment containment;  ///< refers to `mesh`
  std::vector<ObjectFriction> friction;
};

namespace {

/// Returns the mesh.
/// @throws std::invalid_argument as ObjectModel
TriangleMesh checked(TriangleMesh mesh) {
  check_mesh(mesh, "object");
  // Farther out, squares and products lose the micrometres that a contact needs.
  constexpr double kFarthest = 1e4;
  for (const Vec3& v : mesh.vertices) {
    if (v.cwiseAbs().maxCoeff() > kFarthest) {
      throw std::invalid_argument(
          "object: a vertex is " + std::to_string(v.cwiseAbs().maxCoeff()) +
          " m from the world's origin, more than 10 km; give the object's size (size_mm)");
    }
  }
  return mesh;
}

}  // namespace

ObjectModel::ObjectModel() : parts_(std::make_shared<const Parts>()) {}

ObjectModel::ObjectModel(TriangleMesh mesh, double crease_angle, std::vector<ObjectFriction> friction) {
  for (const ObjectFriction& object : friction) {
    if (object.coefficient && !(*object.coefficient >= 0.0 && *object.coefficient <= 2.0))
      throw std::invalid_argument("object: a coefficient of friction is " +
                                  std::to_string(*object.coefficient) + "; it is 0 to 2");
  }
  if (!std::is_sorted(friction.begin(), friction.end(), [](const ObjectFriction& a, const ObjectFriction& b) {
        return a.first_triangle < b.first_triangle;
      }))
    throw std::invalid_argument("object: the objects' frictions are not in the order of their triangles");
  auto parts = std::make_shared<Parts>();
  parts->friction = std::move(friction);
  parts->mesh = checked(std::move(mesh));
  parts->tree = ObjectTree(parts->mesh);
  parts->normals = CompactNormals(surface_normals(parts->mesh, crease_angle));
  parts->containment = Containment(parts->mesh);
  parts_ = std::move(parts);
}

const TriangleMesh& ObjectModel::mesh() const noexcept { return parts_->mesh; }

int ObjectModel::triangle_count() const noexcept { return static_cast<int>(parts_->mesh.triangles.size()); }

const ObjectTree& ObjectModel::tree() const noexcept { return parts_->tree; }

const Containment& ObjectModel::containment() const noexcept { return parts_->containment; }

Vec3 ObjectModel::normal_at(int triangle, const Vec3& weight) const noexcept {
  const CompactNormals& normals = parts_->normals;
  const Vec3 first = normals.normal(triangle, 0);
  const Vec3 sum =
      weight[0] * first + weight[1] * normals.normal(triangle, 1) + weight[2] * normals.normal(triangle, 2);
  const double length = sum.norm();
  return length > 1e-9 ? Vec3(sum / length) : first;
}

double ObjectModel::friction(int triangle, double otherwise) const noexcept {
  const std::vector<ObjectFriction>& objects = parts_->friction;
  const auto next =
      std::upper_bound(objects.begin(), objects.end(), triangle,
                       [](int index, const ObjectFriction& object) { return index < object.first_triangle; });
  return next == objects.begin() ? otherwise : std::prev(next)->coefficient.value_or(otherwise);
}

int ObjectModel::open_edges(int triangle) const noexcept { return parts_->normals.open_edges(triangle); }

}  // namespace phalanx
