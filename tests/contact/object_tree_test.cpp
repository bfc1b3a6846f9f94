// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/object_tree.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace phalanx {
namespace {

/// A flat sheet of 2 n^2 triangles, 1 mm each way, at a slant to every axis.
TriangleMesh slanted_sheet(int n, const Vec3& normal) {
  const Vec3 u = normal.unitOrthogonal();
  const Vec3 v = normal.cross(u);
  TriangleMesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      mesh.vertices.push_back(Vec3(0.3, 0.2, 0.1) +
                              1e-3 * (static_cast<double>(i) * u + static_cast<double>(j) * v));
  const auto at = [n](int i, int j) { return i * (n + 1) + j; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

// A box bounds what is in it by a slab across the mean normal, too. Of a flat sheet the slab has no thickness
// but for single precision's rounding, while the boxes are millimetres thick.
TEST(ObjectTree, TheSlabsOfAFlatSheetLieAlongItAndAreThin) {
  const Vec3 normal = Vec3(1.0, 2.0, 3.0).normalized();
  const ObjectTree tree(slanted_sheet(12, normal));
  ASSERT_EQ(tree.size(), 288);
  int lanes = 0;
  for (std::vector<int> open = {0}; !open.empty();) {
    const BoxNode& node = tree.nodes()[open.back()];
    open.pop_back();
    for (int lane = 0; lane < kWide; ++lane) {
      if (node.min[0][lane] > node.max[0][lane]) continue;  // empty
      ++lanes;
      EXPECT_NEAR(node.high[lane] - node.low[lane], 0.0, 1e-7);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(std::abs(node.axis[k][lane]), normal[k], 1e-6);
      if (node.child[lane] >= 0) open.push_back(node.child[lane]);
    }
  }
  EXPECT_GT(lanes, 288 / kWide);
}

}  // namespace
}  // namespace phalanx
