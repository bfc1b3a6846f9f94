// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/hand_meshes.h"

#include <utility>

namespace phalanx {

void mirror(TriangleMesh& mesh) noexcept {
  for (Vec3& v : mesh.vertices) v.x() = -v.x();
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

void mirror(SegmentMeshes& meshes) noexcept {
  for (TriangleMesh& mesh : meshes) mirror(mesh);
}

}  // namespace phalanx
