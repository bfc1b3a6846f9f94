// SPDX-License-Identifier: Apache-2.0
#include "mesh/shapes/mesh_builder.h"
#include "mesh/shapes/newell_teapot.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx {

TriangleMesh make_teapot(double length, int triangles) {
  mesh::require_positive(length, "make_teapot", "length");
  mesh::require_triangles(triangles, "make_teapot");
  const mesh::Tube handle = mesh::newell_handle();
  const mesh::Tube spout = mesh::newell_spout();
  TriangleMesh mesh =
      mesh::fit_stitched_solid(mesh::newell_body(), {handle, spout}, triangles, "make_teapot");
  // Newell's units become metres about the middle of the box; both ends in x are kept vertices.
  const double rear = handle.point(0.5, *handle.keep).x();
  const double front = spout.point(0.5, *spout.keep).x();
  const double scale = length / (front - rear);
  const Vec3 centre{0.5 * (front + rear), 0.0, 0.5 * mesh::kNewellHeight};
  for (Vec3& v : mesh.vertices) v = scale * (v - centre);
  return mesh;
}

}  // namespace phalanx
