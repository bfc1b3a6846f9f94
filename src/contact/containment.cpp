// SPDX-License-Identifier: Apache-2.0
#include "contact/containment.h"

#include <cmath>
#include <numbers>

namespace phalanx {

double winding_number(const TriangleMesh& mesh, const Vec3& point) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) {
    // Van Oosterom & Strackee 1983: tan(solid angle / 2) = a . (b x c) / (abc + (a.b)c + (b.c)a + (c.a)b)
    const Vec3 a = mesh.vertices[static_cast<std::size_t>(t[0])] - point;
    const Vec3 b = mesh.vertices[static_cast<std::size_t>(t[1])] - point;
    const Vec3 c = mesh.vertices[static_cast<std::size_t>(t[2])] - point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    sum += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4.0 * std::numbers::pi);
}

bool one_contains_the_other(const TriangleMesh& segment, const Pose& X_WS, const TriangleMesh& object) {
  if (object.triangles.empty()) return false;
  // The surfaces do not cross, so that one vertex of the connected segment speaks for it.
  if (winding_number(object, X_WS * segment.vertices.front()) > 0.5) return true;
  const Pose X_SW = X_WS.inverse();
  const Bounds box = bounds(segment);
  for (const Vec3& v : object.vertices) {
    const Vec3 p = X_SW * v;
    const bool in_box = (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
    if (in_box && std::abs(winding_number(segment, p)) > 0.5) return true;
  }
  return false;
}

}  // namespace phalanx
