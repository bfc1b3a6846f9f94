// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/primitives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

#include "mesh/mesh_checks.h"
#include "mesh/shapes/maker_refusal.h"
#include "phalanx/core/constants.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

struct Solid {
  std::string name;
  std::function<TriangleMesh(int)> make;
  int euler;
  double volume;                           // exact [m^3]
  Vec3 extents;                            // exact [m]
  std::function<double(const Vec3&)> off;  // distance of a point from the exact surface [m]
};

double box_distance(const Vec3& p, const Vec3& half) { return (p.cwiseAbs() - half).maxCoeff(); }

const std::vector<Solid>& solids() {
  static const std::vector<Solid> kSolids = {
      {"sphere", [](int n) { return make_sphere(0.08, n); }, 2, kPi / 6.0 * std::pow(0.08, 3),
       Vec3::Constant(0.08), [](const Vec3& p) { return p.norm() - 0.04; }},
      {"box",
       [](int n) { return make_box({0.1, 0.05, 0.2}, n); },
       2,
       0.001,
       {0.1, 0.05, 0.2},
       [](const Vec3& p) { return box_distance(p, {0.05, 0.025, 0.1}); }},
      {"cylinder",
       [](int n) { return make_cylinder(0.06, 0.12, n); },
       2,
       kPi * 0.03 * 0.03 * 0.12,
       {0.06, 0.06, 0.12},
       [](const Vec3& p) { return std::max(p.head<2>().norm() - 0.03, std::abs(p.z()) - 0.06); }},
      {"torus",
       [](int n) { return make_torus(0.1, 0.03, n); },
       0,
       2.0 * kPi * kPi * 0.05 * 0.015 * 0.015,
       {0.13, 0.13, 0.03},
       [](const Vec3& p) { return std::hypot(p.head<2>().norm() - 0.05, p.z()) - 0.015; }},
  };
  return kSolids;
}

class Primitive : public ::testing::TestWithParam<Solid> {};

TEST_P(Primitive, IsAClosedManifoldOfItsGenusAtAnyResolution) {
  for (const int n : {1, 12, 50, 300, 1489, 5000, 20000}) {
    const TriangleMesh mesh = GetParam().make(n);
    EXPECT_TRUE(is_closed(mesh)) << n;
    EXPECT_EQ(test::manifold_flaw(mesh), "") << n;
    EXPECT_EQ(test::euler_characteristic(mesh), GetParam().euler) << n;
    EXPECT_GT(signed_volume(mesh), 0.0) << n;
    EXPECT_GT(test::worst_shape(mesh), 0.02) << n;
  }
}

TEST_P(Primitive, HasAboutAsManyTrianglesAsAsked) {
  for (int n = 300; n < (test::kSlowBuild ? 200'000 : 2'000'000); n = n * 7 / 3) {
    const auto count = static_cast<double>(GetParam().make(n).triangles.size());
    EXPECT_NEAR(count / n, 1.0, 0.10) << n;
  }
}

TEST_P(Primitive, HasItsExactExtentsAndItsVerticesOnTheSurface) {
  for (const int n : {40, 300, 4000}) {
    const TriangleMesh mesh = GetParam().make(n);
    EXPECT_LT((test::extents(mesh) - GetParam().extents).norm(), 1e-16) << n;
    const Bounds b = bounds(mesh);
    EXPECT_LT((b.min + b.max).norm(), 1e-16) << "not centred at " << n;
    for (const Vec3& v : mesh.vertices) ASSERT_LT(std::abs(GetParam().off(v)), 1e-15) << v.transpose();
  }
}

// Chords lie inside a convex surface by O(h^2), and h^2 goes with 1/n: 16 times the triangles, about 1/16 of
// the missing volume.
TEST_P(Primitive, VolumeConvergesToTheExactOneWithTheSquareOfTheEdge) {
  const double exact = GetParam().volume;
  const double coarse = std::abs(signed_volume(GetParam().make(1000)) / exact - 1.0);
  const double fine = std::abs(signed_volume(GetParam().make(16000)) / exact - 1.0);
  EXPECT_LT(coarse, 0.06);
  EXPECT_LT(fine, std::max(coarse / 11.0, 1e-13));
}

TEST_P(Primitive, DoesNotCrossItself) {
  for (const int n : {12, 300, 3000}) EXPECT_EQ(test::self_intersections(GetParam().make(n)), 0U) << n;
}

INSTANTIATE_TEST_SUITE_P(All, Primitive, ::testing::ValuesIn(solids()),
                         [](const auto& each) { return each.param.name; });

// With n vertices around the edge a cell there is 2 pi r / n wide, and the cap's rings are as far apart.
TEST(Cylinder, HasCapsWithCellsAsDeepAsWide) {
  for (const int n : {1000, 5000, 20'000}) {
    std::set<long> radii;  // [nm]
    int around = 0;
    for (const Vec3& v : make_cylinder(0.06, 0.12, n).vertices) {
      if (v.z() < 0.06) continue;
      const double r = v.head<2>().norm();
      radii.insert(std::lround(r * 1e9));
      if (r > 0.03 - 1e-9) ++around;
    }
    EXPECT_EQ(static_cast<long>(radii.size()) - 1, std::lround(around / (2.0 * kPi)))
        << n << ", and the centre";
  }
}

TEST(PrimitiveRefusals, NameTheMakerTheValueAndTheRemedy) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(maker_refusal([] { (void)make_sphere(-0.1, 100); }),
            "make_sphere: diameter is -0.1 m; give a finite length above 0");
  EXPECT_EQ(maker_refusal([&] { (void)make_box({0.1, kNan, 0.1}, 100); }),
            "make_box: an edge length is nan m; give a finite length above 0");
  EXPECT_EQ(maker_refusal([&] { (void)make_cylinder(0.1, kInf, 100); }),
            "make_cylinder: length is inf m; give a finite length above 0");
  EXPECT_EQ(maker_refusal([] { (void)make_sphere(0.1, 0); }),
            "make_sphere: triangles is 0; give 1 to 50000000");
  EXPECT_NE(maker_refusal([] { (void)make_torus(0.1, 0.1, 100); }).find("meet itself"), std::string::npos);
  EXPECT_NE(maker_refusal([] { (void)make_mug(0.08, 0.3, 1000); }).find("0.5 to 3 times"), std::string::npos);
  EXPECT_NE(maker_refusal([] { (void)make_teapot(0.0, 1000); }).find("length is 0 m"), std::string::npos);
}

}  // namespace
}  // namespace phalanx
