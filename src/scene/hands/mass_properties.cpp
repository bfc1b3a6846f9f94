// SPDX-License-Identifier: Apache-2.0
#include "scene/hands/mass_properties.h"

namespace phalanx {

MassProperties mass_properties(const TriangleMesh& mesh, double density) noexcept {
  const Vec3 o = mesh.vertices.front();  // about a point of the mesh, against cancellation of large terms
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[static_cast<std::size_t>(t[0])] - o;
    const Vec3 b = mesh.vertices[static_cast<std::size_t>(t[1])] - o;
    const Vec3 c = mesh.vertices[static_cast<std::size_t>(t[2])] - o;
    const double det = a.dot(b.cross(c));
    const Vec3 sum = a + b + c;
    volume += det / 6.0;
    first += det / 24.0 * sum;
    second +=
        det / 120.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  const Vec3 centre = first / volume;
  second -= volume * centre * centre.transpose();
  MassProperties result;
  result.mass = density * volume;
  result.centre = o + centre;
  result.inertia = density * (second.trace() * Mat3::Identity() - second);
  return result;
}

}  // namespace phalanx
