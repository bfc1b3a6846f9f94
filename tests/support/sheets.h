// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::test {

/// An open square of side 60 mm in z = 0, or an arch over the y axis of the given radius.
inline TriangleMesh grid_sheet(int cells, double radius) {
  TriangleMesh mesh;
  const double half = 0.03;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      const double x = half * (2.0 * i / cells - 1.0);
      const double y = half * (2.0 * j / cells - 1.0);
      const double z = radius > 0.0 ? std::sqrt(radius * radius - x * x) - radius : 0.0;
      mesh.vertices.emplace_back(x, y, z);
    }
  }
  const auto at = [&](int i, int j) { return i * (cells + 1) + j; };
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

}  // namespace phalanx::test
