// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/triangle_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace phalanx::mesh {
namespace {

TEST(NearestOnTriangle, IsNoFartherThanAnyPointOfADenseGrid) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const auto point = [&] { return Vec3(u(random), u(random), u(random)); };
  for (int i = 0; i < 2000; ++i) {
    const Vec3 a = point();
    const Vec3 b = i % 5 == 0 ? a : point();  // also degenerate
    const Vec3 c = point();
    const Vec3 p = 2.0 * point();
    const Vec3 q = nearest_on_triangle(p, a, b, c);
    double least = 1e9;
    constexpr int kGrid = 40;
    for (int j = 0; j <= kGrid; ++j)
      for (int k = 0; j + k <= kGrid; ++k)
        least = std::min(least, (p - (a + (b - a) * j / kGrid + (c - a) * k / kGrid)).norm());
    EXPECT_LE((p - q).norm(), least + 1e-12) << "case " << i;
    EXPECT_GE((p - q).norm(), least - 4.0 / kGrid) << "case " << i;
  }
}

}  // namespace
}  // namespace phalanx::mesh
