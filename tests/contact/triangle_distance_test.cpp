// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/triangle_distance.h"

#include <gmock/gmock.h>

#include <random>

namespace phalanx {
namespace {

/// How far p is from the triangle t: its best approximation by a dense search over barycentric coordinates,
/// refined.
bool lies_in(const Corners& t, const Vec3& p, double tolerance) {
  const Vec3 w = barycentric(t, p);
  return (w[0] * t[0] + w[1] * t[1] + w[2] * t[2] - p).norm() <= tolerance;
}

bool lies_on_an_edge(const Corners& t, const Vec3& p, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 u = t[(i + 1) % 3] - t[i];
    const double s = u.squaredNorm() > 0.0 ? std::clamp(u.dot(p - t[i]) / u.squaredNorm(), 0.0, 1.0) : 0.0;
    if ((t[i] + s * u - p).norm() <= tolerance) return true;
  }
  return false;
}

/// Two points are the closest of two convex sets if and only if each lies in its set and the slab between
/// them separates the sets: a proof of the answer that shares nothing with how it was found.
void expect_certificate(const Corners& a, const Corners& b, double scale) {
  const TriangleDistance found = triangle_distance(a, b);
  const double d = std::sqrt(found.squared);
  const double tolerance = 1e-12 * scale;
  EXPECT_TRUE(lies_in(a, found.on_a, tolerance) || lies_on_an_edge(a, found.on_a, tolerance));
  EXPECT_TRUE(lies_in(b, found.on_b, tolerance) || lies_on_an_edge(b, found.on_b, tolerance));
  EXPECT_NEAR((found.on_a - found.on_b).norm(), d, tolerance);
  if (d < 1e-9 * scale) return;  // they touch: the common point above is the proof
  const Vec3 n = (found.on_a - found.on_b) / d;
  const double slack =
      1e-9 * scale;  // the direction of a short difference is known to (rounding of the points) / d
  for (const Vec3& x : a) EXPECT_GE(n.dot(x - found.on_a), -slack);
  for (const Vec3& y : b) EXPECT_LE(n.dot(y - found.on_b), slack);
}

class SeededTriangles : public ::testing::TestWithParam<int> {
 protected:
  std::mt19937_64 random_{static_cast<std::uint64_t>(GetParam())};
  Vec3 point(double size) {
    std::uniform_real_distribution<double> u(-size, size);
    return {u(random_), u(random_), u(random_)};
  }
  Corners triangle(double size) { return {point(size), point(size), point(size)}; }
  Corners moved(Corners t, const Vec3& by) {
    for (Vec3& x : t) x += by;
    return t;
  }
};

TEST_P(SeededTriangles, HaveASeparatingSlabBetweenTheirClosestPoints) {
  for (int i = 0; i < 3000; ++i) {
    SCOPED_TRACE(::testing::Message() << "seed " << GetParam() << " case " << i);
    expect_certificate(triangle(1.0), moved(triangle(1.0), point(1.5)), 1.0);
  }
}

TEST_P(SeededTriangles, AreExactFarFromTheOriginAndSmall) {
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(::testing::Message() << "seed " << GetParam() << " case " << i);
    const Vec3 far = Vec3(10.0, -10.0, 10.0);
    expect_certificate(moved(triangle(0.01), far), moved(triangle(0.01), far + point(0.015)), 1.0);
    expect_certificate(triangle(1e-4), moved(triangle(1e-4), point(1.5e-4)), 1e-4);
  }
}

TEST_P(SeededTriangles, MayBeSegmentsOrPoints) {
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(::testing::Message() << "seed " << GetParam() << " case " << i);
    Corners segment = triangle(1.0);
    segment[2] = 0.3 * segment[0] + 0.7 * segment[1];
    Corners dot = triangle(1.0);
    dot[1] = dot[2] = dot[0];
    expect_certificate(segment, moved(triangle(1.0), point(2.0)), 1.0);
    expect_certificate(moved(triangle(1.0), point(2.0)), dot, 1.0);
    expect_certificate(segment, dot, 1.0);
  }
}

TEST_P(SeededTriangles, MayBeParallelCoplanarOrShareACorner) {
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(::testing::Message() << "seed " << GetParam() << " case " << i);
    Corners a = triangle(1.0);
    for (Vec3& x : a) x.z() = 0.0;
    Corners b = triangle(1.0);
    for (Vec3& x : b) x.z() = 0.0;
    expect_certificate(a, moved(b, Vec3(2.5, 0.0, 0.0)), 1.0);   // coplanar, apart
    expect_certificate(a, moved(b, Vec3(0.0, 0.0, 0.25)), 1.0);  // parallel planes
    Corners c = triangle(1.0);
    c[1] = a[2];
    EXPECT_NEAR(triangle_distance(a, c).squared, 0.0, 1e-24);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, SeededTriangles, ::testing::Values(1, 2, 3));

TEST(TriangleDistance, OfACornerAboveAFaceIsItsHeight) {
  const Corners floor = {Vec3(-1, -1, 0), Vec3(2, -1, 0), Vec3(-1, 2, 0)};
  const Corners spike = {Vec3(0, 0, 0.5), Vec3(-1, 0, 3), Vec3(1, 0, 3)};
  const TriangleDistance found = triangle_distance(spike, floor);
  EXPECT_DOUBLE_EQ(found.squared, 0.25);
  EXPECT_EQ(found.on_a, Vec3(0, 0, 0.5));
  EXPECT_EQ(found.on_b, Vec3(0, 0, 0));
}

// One triangle over another: every pair of corners is as near. The first in the fixed order gives the points.
TEST(TriangleDistance, OfPairsThatTieTakesTheFirst) {
  const Corners low = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const Corners high = {Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(0, 1, 1)};
  const TriangleDistance found = triangle_distance(high, low);
  EXPECT_EQ(found.squared, 1.0);
  EXPECT_EQ(found.on_a, Vec3(0, 0, 1));
  EXPECT_EQ(found.on_b, Vec3(0, 0, 0));
}

// (0, 0, 0) and (1, 1, 1) are nearest, whichever corners of their triangles they are.
TEST(TriangleDistance, OfTwoCornersIsBetweenThoseWhateverTheirPlaces) {
  const Corners a = {Vec3(0, 0, 0), Vec3(-3, 0, 0), Vec3(0, -3, 0)};
  const Corners b = {Vec3(1, 1, 1), Vec3(4, 1, 1), Vec3(1, 4, 1)};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Corners mine = {a[i], a[(i + 1) % 3], a[(i + 2) % 3]};
      const Corners theirs = {b[j], b[(j + 1) % 3], b[(j + 2) % 3]};
      const TriangleDistance found = triangle_distance(mine, theirs);
      EXPECT_EQ(found.squared, 3.0) << i << j;
      EXPECT_EQ(found.on_a, Vec3(0, 0, 0)) << i << j;
      EXPECT_EQ(found.on_b, Vec3(1, 1, 1)) << i << j;
    }
  }
}

TEST(TriangleDistance, OfCrossedEdgesIsTheirCommonPerpendicular) {
  const Corners a = {Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, -1)};
  const Corners b = {Vec3(0, -1, 2), Vec3(0, 1, 2), Vec3(0, 0, 3)};
  EXPECT_DOUBLE_EQ(triangle_distance(a, b).squared, 4.0);
}

TEST(TriangleDistance, IsZeroWhereAnEdgePiercesAFace) {
  const Corners floor = {Vec3(-1, -1, 0), Vec3(2, -1, 0), Vec3(-1, 2, 0)};
  const Corners pierced = {Vec3(0, 0, 0.5), Vec3(0, 0, -0.5), Vec3(5, 0, 5)};
  EXPECT_EQ(triangle_distance(pierced, floor).squared, 0.0);
  EXPECT_EQ(triangle_distance(floor, pierced).squared, 0.0);
}

}  // namespace
}  // namespace phalanx
