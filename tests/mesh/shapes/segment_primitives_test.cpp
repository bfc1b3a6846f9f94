// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "mesh/mesh_checks.h"
#include "phalanx/core/constants.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx {
namespace {

// Distance from the convex hull of two spheres on the z axis: the largest support gap over the directions in
// the point's half plane, sampled; only for points at the surface, where it is 0.
double off_capsule(const Vec3& p, double length, double a, double b) {
  const double rho = p.head<2>().norm();
  double gap = -1.0;
  constexpr int kDirections = 20000;
  for (int i = 0; i <= kDirections; ++i) {
    const double angle = kPi * i / kDirections;
    const double along = rho * std::sin(angle) + p.z() * std::cos(angle);
    gap = std::max(gap, along - std::max(a, -length * std::cos(angle) + b));
  }
  return gap;
}

TEST(TaperedCapsule, HasTheTriangleCountOfItsGrid) {
  for (const auto& [around, caps, side] : {std::array{3, 1, 1}, std::array{8, 2, 3}, std::array{16, 5, 4}})
    EXPECT_EQ(make_tapered_capsule(0.04, 0.01, 0.007, around, caps, side).triangles.size(),
              static_cast<std::size_t>(2 * around * (2 * caps + side - 1)));
}

TEST(TaperedCapsule, IsAClosedSphereLikeManifoldThatDoesNotCrossItself) {
  for (const auto& [a, b] : {std::pair{0.01, 0.007}, std::pair{0.007, 0.01}, std::pair{0.008, 0.008}}) {
    for (const int around : {3, 8, 24}) {
      const TriangleMesh mesh = make_tapered_capsule(0.04, a, b, around, 3, 4);
      EXPECT_EQ(test::manifold_flaw(mesh), "");
      EXPECT_EQ(test::euler_characteristic(mesh), 2);
      EXPECT_GT(test::worst_shape(mesh), 0.02);
      EXPECT_EQ(test::self_intersections(mesh), 0U);
      EXPECT_GT(signed_volume(mesh), 0.0);
    }
  }
}

TEST(TaperedCapsule, RunsFromTheBaseSphereToTheTipSphereAlongMinusZ) {
  const Bounds b = bounds(make_tapered_capsule(0.04, 0.01, 0.007, 8, 3, 4));
  EXPECT_DOUBLE_EQ(b.max.z(), 0.01);
  EXPECT_DOUBLE_EQ(b.min.z(), -0.047);
}

TEST(TaperedCapsule, HasItsVerticesOnTheHullOfTheTwoSpheres) {
  for (const auto& [a, b] : {std::pair{0.01, 0.007}, std::pair{0.007, 0.01}}) {
    for (const Vec3& v : make_tapered_capsule(0.04, a, b, 7, 4, 5).vertices)
      ASSERT_NEAR(off_capsule(v, 0.04, a, b), 0.0, 5e-7) << v.transpose();
  }
}

// Two spheres of radius r and a cylinder: 4/3 pi r^3 + pi r^2 l.
TEST(TaperedCapsule, WithEqualRadiiHasTheCapsulesVolume) {
  const double exact = 4.0 / 3.0 * kPi * std::pow(0.008, 3) + kPi * 0.008 * 0.008 * 0.04;
  EXPECT_NEAR(signed_volume(make_tapered_capsule(0.04, 0.008, 0.008, 200, 60, 4)) / exact, 1.0, 1e-3);
}

TEST(TaperedCapsule, RefusesASphereInsideTheOther) {
  EXPECT_THROW((void)make_tapered_capsule(0.003, 0.01, 0.007, 8, 2, 2), std::invalid_argument);
  EXPECT_NO_THROW((void)make_tapered_capsule(0.0031, 0.01, 0.007, 8, 2, 2));
  EXPECT_THROW((void)make_tapered_capsule(0.03, 0.01, 0.007, 2, 2, 2), std::invalid_argument);
}

TEST(RoundedSlab, HasItsSectionsAndCapsAndIsClosed) {
  const TriangleMesh mesh = make_rounded_slab(0.09, {0.05, 0.03}, {0.08, 0.025}, 16, 4, 5);
  EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(2 * 16 * (2 * 4 + 5 - 1)));
  EXPECT_EQ(test::manifold_flaw(mesh), "");
  EXPECT_EQ(test::euler_characteristic(mesh), 2);
  EXPECT_EQ(test::self_intersections(mesh), 0U);
  const Bounds b = bounds(mesh);
  EXPECT_DOUBLE_EQ(b.max.z(), 0.015);
  EXPECT_DOUBLE_EQ(b.min.z(), -0.1025);
  EXPECT_DOUBLE_EQ(b.max.x(), 0.04);   // the tip's half breadth
  EXPECT_DOUBLE_EQ(b.max.y(), 0.015);  // the base's half thickness
}

// Prismatoid between ellipses pi/4 b t with b and t linear along it, and two half ellipsoids 2/3 pi (b/2)
// (t/2) (t/2).
TEST(RoundedSlab, VolumeConvergesToTheExactOne) {
  const double b0 = 0.05, t0 = 0.03, b1 = 0.08, t1 = 0.025;
  const double middle = 0.25 * (b0 + b1) * (t0 + t1);
  const double between =
      kPi / 4.0 * 0.09 / 6.0 * (b0 * t0 + 4.0 * middle + b1 * t1);  // Simpson: exact, it is quadratic
  const double caps = kPi / 12.0 * (b0 * t0 * t0 + b1 * t1 * t1);
  const auto miss = [&](int k) {
    return signed_volume(make_rounded_slab(0.09, {b0, t0}, {b1, t1}, 12 * k, 3 * k, 4 * k)) /
               (between + caps) -
           1.0;
  };
  EXPECT_LT(std::abs(miss(8)), 2e-3);
  EXPECT_NEAR(miss(4) / miss(8), 4.0, 0.2);
}

}  // namespace
}  // namespace phalanx
