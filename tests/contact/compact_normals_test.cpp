// SPDX-License-Identifier: Apache-2.0
#include "contact/compact_normals.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>
#include <utility>

#include "phalanx/mesh/objects.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx {
namespace {

constexpr double kCrease = 0.5235987755982988;  // 30 degrees

using Bits = std::array<std::uint64_t, 3>;

Bits bits_of(const Vec3& n) {
  return {std::bit_cast<std::uint64_t>(n.x()), std::bit_cast<std::uint64_t>(n.y()),
          std::bit_cast<std::uint64_t>(n.z())};
}

void expect_the_same_bits(const SurfaceNormals& normals) {
  const CompactNormals compact(normals);
  for (std::size_t t = 0; t < normals.corner.size(); ++t) {
    const int triangle = static_cast<int>(t);
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_EQ(bits_of(compact.normal(triangle, static_cast<int>(k))), bits_of(normals.corner[t][k])) << t;
    ASSERT_EQ(compact.open_edges(triangle), normals.open_edges[t]) << t;
  }
}

/// Triangles left out, turned over, doubled and drawn out to a line.
TriangleMesh damaged(const TriangleMesh& clean, std::mt19937_64& random) {
  std::uniform_int_distribution<int> what(0, 19);
  TriangleMesh out{clean.vertices, {}};
  for (const Triangle& t : clean.triangles) {
    const int kind = what(random);
    if (kind == 0) continue;
    out.triangles.push_back(kind == 1 ? Triangle{t[1], t[0], t[2]} : t);
    if (kind == 2) out.triangles.push_back(t);
    if (kind == 3) out.triangles.push_back({t[0], t[1], t[0]});
  }
  return out;
}

/// Every triangle with vertices of its own.
TriangleMesh soup(const TriangleMesh& mesh) {
  TriangleMesh out;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::int32_t>(out.vertices.size());
    for (const std::int32_t v : t) out.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    out.triangles.push_back({first, first + 1, first + 2});
  }
  return out;
}

double bytes_per_triangle(const TriangleMesh& mesh) {
  return static_cast<double>(CompactNormals(surface_normals(mesh, kCrease)).bytes()) /
         static_cast<double>(mesh.triangles.size());
}

TEST(CompactNormals, AreTheSurfaceNormalsToTheLastBit) {
  std::mt19937_64 random(1);
  for (const TriangleMesh& mesh : {make_box({0.1, 0.2, 0.3}, 1200), make_torus(0.08, 0.03, 3000),
                                   make_mug(0.08, 0.09, 5000), make_teapot(0.2, 6000)}) {
    SCOPED_TRACE(testing::Message() << mesh.triangles.size() << " triangles, seed 1");
    expect_the_same_bits(surface_normals(mesh, kCrease));
    expect_the_same_bits(surface_normals(damaged(mesh, random), kCrease));
    expect_the_same_bits(surface_normals(soup(mesh), kCrease));
    expect_the_same_bits(surface_normals(mesh, 0.0));
  }
}

TEST(CompactNormals, KeepEveryPatternOfOpenEdges) {
  SurfaceNormals normals;
  for (std::uint8_t bits = 0; bits < 8; ++bits) {
    normals.corner.push_back({Vec3::UnitX(), Vec3::UnitY(), Vec3(-0.0, 0.0, 1.0)});
    normals.open_edges.push_back(bits);
  }
  expect_the_same_bits(normals);
  EXPECT_EQ(CompactNormals(normals).distinct(), 3U);
}

// A box lies along the axes, so that its faces' normals come out without rounding: six.
TEST(CompactNormals, OfABoxAreSix) {
  EXPECT_EQ(CompactNormals(surface_normals(make_box({1, 1, 1}, 4800), kCrease)).distinct(), 6U);
}

// One normal a vertex, and half as many vertices as triangles (less 2): 12 + 24 / 2 bytes.
TEST(CompactNormals, TakeTwentyFourBytesATriangleOnASmoothBall) {
  const TriangleMesh ball = make_sphere(0.1, 100'000);
  ASSERT_GT(ball.triangles.size(), 90'000U);
  EXPECT_LE(CompactNormals(surface_normals(ball, kCrease)).distinct(), ball.vertices.size());
  EXPECT_LT(bytes_per_triangle(ball), 24.01);
}

// Nothing is shared: one normal a triangle, 12 + 24 bytes.
TEST(CompactNormals, TakeAtMostThirtySixBytesATriangleWhereEachHasItsOwn) {
  EXPECT_LE(bytes_per_triangle(soup(make_torus(0.08, 0.03, 100'000))), 36.0);
}

TEST(CompactNormals, OfNoTriangleHoldNothing) {
  EXPECT_EQ(CompactNormals().bytes(), 0U);
  EXPECT_EQ(CompactNormals(SurfaceNormals{}).distinct(), 0U);
}

}  // namespace
}  // namespace phalanx
