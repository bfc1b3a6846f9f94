// SPDX-License-Identifier: Apache-2.0
#include "mesh/import/polygon_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace phalanx::mesh {
namespace {

Vec3 vector_area(const Vec3& a, const Vec3& b, const Vec3& c) { return 0.5 * (b - a).cross(c - a); }

/// Triangles that all face like the polygon and together have its area cover it once and nothing else.
void expect_covers(const std::vector<Vec3>& polygon) {
  Vec3 whole = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    whole += vector_area(polygon[0], polygon[i], polygon[i + 1]);
  const auto triangles = cut_polygon(polygon);
  ASSERT_EQ(triangles.size(), polygon.size() - 2);
  double sum = 0.0;
  for (const auto& t : triangles) {
    const Vec3 part =
        vector_area(polygon[static_cast<std::size_t>(t[0])], polygon[static_cast<std::size_t>(t[1])],
                    polygon[static_cast<std::size_t>(t[2])]);
    EXPECT_GE(part.dot(whole.normalized()), -1e-12 * whole.norm());
    sum += part.norm();
  }
  EXPECT_NEAR(sum, whole.norm(), 1e-12 * whole.norm() * static_cast<double>(polygon.size()));
}

// A comb with square teeth, 400 of whose 3,000 square millimetres a well-known library loses.
TEST(CutPolygon, CoversACombWithSquareTeeth) {
  std::vector<Vec3> comb;
  for (int i = 0; i <= 10; ++i) {
    for (const int y : i % 2 == 0 ? std::array{20, 10} : std::array{10, 20})
      comb.emplace_back(10.0 * i, y, 0.0);
  }
  comb.erase(comb.begin());
  comb.emplace_back(100.0, 0.0, 0.0);
  comb.emplace_back(0.0, 0.0, 0.0);
  expect_covers(comb);
  for (Vec3& p : comb) p = rotation_about(Vec3(1, 2, 3).normalized(), 0.7) * p;
  expect_covers(comb);
  std::reverse(comb.begin(), comb.end());
  expect_covers(comb);
}

TEST(CutPolygon, CoversAQuadWithAReflexCorner) {
  expect_covers({{0, 0, 0}, {1, 0.2, 0}, {2, 0, 0}, {1, 2, 0}});
  expect_covers({{1, 0.2, 0}, {2, 0, 0}, {1, 2, 0}, {0, 0, 0}});
}

// Memory behind the last corner, here a corner that was removed again, is not read.
TEST(CutPolygon, LooksAtNothingBehindTheLastCorner) {
  std::vector<Vec3> polygon = {{1, 0.2, 0}, {2, 0, 0}, {1, 2, 0}, {0, 0, 0}, {1, 0.2, 1e6}};
  polygon.pop_back();
  expect_covers(polygon);
}

TEST(CutPolygon, CoversFlatCornersAndARepeatedOne) {
  expect_covers({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {0, 1, 0}});
}

TEST(CutPolygon, CoversASpiralAndSeededStars) {
  std::vector<Vec3> spiral;
  for (int i = 0; i <= 60; ++i)
    spiral.emplace_back((1.0 + 0.1 * i) * std::cos(0.3 * i), (1.0 + 0.1 * i) * std::sin(0.3 * i), 0.0);
  for (int i = 60; i >= 0; --i)
    spiral.emplace_back((1.3 + 0.1 * i) * std::cos(0.3 * i), (1.3 + 0.1 * i) * std::sin(0.3 * i), 0.0);
  expect_covers(spiral);
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> radius(0.2, 1.0);
    std::vector<Vec3> star;
    const int corners = 4 + static_cast<int>(seed % 60);
    for (int i = 0; i < corners; ++i) {
      const double a = 2.0 * std::numbers::pi * i / corners;
      const double r = radius(random);
      star.emplace_back(r * std::cos(a), 0.3, r * std::sin(a));
    }
    expect_covers(star);
  }
}

TEST(CutPolygon, EndsOnAPolygonThatCrossesItself) {
  EXPECT_EQ(cut_polygon({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2U);
  EXPECT_EQ(cut_polygon(std::vector<Vec3>(6, Vec3::Zero())).size(), 4U);
}

}  // namespace
}  // namespace phalanx::mesh
