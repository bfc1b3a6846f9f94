// SPDX-License-Identifier: Apache-2.0
// The mug and the teapot: bodies with handles and spout stitched into holes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "mesh/mesh_checks.h"
#include "mesh/shapes/mug_shape.h"
#include "mesh/shapes/newell_teapot.h"
#include "phalanx/core/constants.h"
#include "phalanx/mesh/primitives.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

using mesh::RevolvedSurface;
using mesh::Tube;

TriangleMesh mug(int n) { return make_mug(0.082, 0.095, n); }
TriangleMesh teapot(int n) { return make_teapot(0.25, n); }

class StitchedSolid : public ::testing::TestWithParam<TriangleMesh (*)(int)> {};

TEST_P(StitchedSolid, IsOneClosedManifoldOfGenusOneFrom300TrianglesOn) {
  for (double n = 300; n < 70'000; n *= test::kSlowBuild ? 1.9 : 1.13) {
    const TriangleMesh mesh = GetParam()(static_cast<int>(n));
    ASSERT_EQ(test::manifold_flaw(mesh), "") << n;
    ASSERT_EQ(test::euler_characteristic(mesh), 0) << n;
    ASSERT_GT(test::worst_shape(mesh), 0.05) << n;
  }
}

TEST_P(StitchedSolid, HasAboutAsManyTrianglesAsAskedUpToAMillion) {
  constexpr int kMost = test::kSlowBuild ? 100'000 : 1'000'000;
  for (double n = 300; n <= kMost; n *= 1.5) {
    const TriangleMesh mesh = GetParam()(static_cast<int>(n));
    EXPECT_NEAR(static_cast<double>(mesh.triangles.size()) / n, 1.0, 0.15) << n;
  }
  const TriangleMesh most = GetParam()(kMost);
  EXPECT_NEAR(static_cast<double>(most.triangles.size()), kMost, 0.02 * kMost);
  EXPECT_TRUE(is_closed(most));
  EXPECT_GT(test::worst_shape(most), 0.02);
}

TEST_P(StitchedSolid, DoesNotCrossItself) {
  for (double n = 300; n < 20'000; n *= test::kSlowBuild ? 1.9 : 1.31)
    ASSERT_EQ(test::self_intersections(GetParam()(static_cast<int>(n))), 0U) << n;
}

TEST_P(StitchedSolid, VolumeIsPositiveAndConverges) {
  const double coarse = signed_volume(GetParam()(2'000));
  const double middle = signed_volume(GetParam()(16'000));
  const double fine = signed_volume(GetParam()(128'000));
  EXPECT_GT(coarse, 0.0);
  EXPECT_LT(std::abs(fine - middle), 0.6 * std::abs(middle - coarse));
  EXPECT_LT(std::abs(fine / middle - 1.0), 0.01);
}

INSTANTIATE_TEST_SUITE_P(All, StitchedSolid, ::testing::Values(&mug, &teapot),
                         [](const auto& each) { return each.param == &mug ? "Mug" : "Teapot"; });

/// Distance from p to the surface f over [0, 1] x [v0, v1]: a dense scan, then shrinking pattern search from
/// the best few samples.
double distance(const Vec3& p, const std::function<Vec3(double, double)>& f, double v0, double v1) {
  struct Sample {
    double d, u, v;
  };
  constexpr int kU = 64;
  constexpr int kV = 48;
  std::vector<Sample> samples;
  for (int i = 0; i <= kU; ++i) {
    for (int j = 0; j <= kV; ++j) {
      const double u = static_cast<double>(i) / kU;
      const double v = v0 + (v1 - v0) * j / kV;
      samples.push_back({(f(u, v) - p).squaredNorm(), u, v});
    }
  }
  std::partial_sort(samples.begin(), samples.begin() + 3, samples.end(),
                    [](auto& a, auto& b) { return a.d < b.d; });
  double best = samples[0].d;
  for (int s = 0; s < 3; ++s) {
    Sample at = samples[static_cast<std::size_t>(s)];
    double du = 1.0 / kU;
    double dv = (v1 - v0) / kV;
    for (int k = 0; k < 400 && du > 1e-15; ++k) {
      bool moved = false;
      for (const auto& [su, sv] :
           {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}) {
        const double u = std::clamp(at.u + su * du, 0.0, 1.0);
        const double v = std::clamp(at.v + sv * dv, v0, v1);
        const double d = (f(u, v) - p).squaredNorm();
        if (d < at.d) {
          at = {d, u, v};
          moved = true;
        }
      }
      if (!moved) {
        du *= 0.5;
        dv *= 0.5;
      }
    }
    best = std::min(best, at.d);
  }
  return std::sqrt(best);
}

double distance_to_body(const Vec3& p, const RevolvedSurface& body) {
  double best = 1e9;
  for (std::size_t piece = 0; piece < body.least_bands.size(); ++piece) {
    const auto t = static_cast<double>(piece);
    best = std::min(
        best, distance(p, [&](double w, double v) { return body.point(w == 1.0 ? 0.0 : w, v); }, t, t + 1.0));
  }
  return best;
}

double distance_to_tube(const Vec3& p, const Tube& tube) {
  const auto f = [&](double a, double v) { return tube.point(a, v); };
  return std::min(distance(p, f, 0.0, 0.5), distance(p, f, 0.5, 1.0));
}

TEST(Mug, HasItsExactDiameterAndHeightAndItsHandleOnTheXSide) {
  for (const int n : {300, 1000, 10000}) {
    const TriangleMesh mesh = mug(n);
    const Bounds b = bounds(mesh);
    EXPECT_DOUBLE_EQ(b.max.z(), 0.0475) << n;
    EXPECT_DOUBLE_EQ(b.min.z(), -0.0475) << n;
    EXPECT_DOUBLE_EQ(b.max.y(), 0.041) << n;
    EXPECT_DOUBLE_EQ(b.min.y(), -0.041) << n;
    EXPECT_DOUBLE_EQ(b.min.x(), -0.041) << n;
    const mesh::MugShape shape = mesh::mug_shape(0.082, 0.095);
    EXPECT_DOUBLE_EQ(b.max.x(), 0.041 + shape.handle_reach + shape.handle_half_thickness) << n;
  }
}

// By hand, in mm. Of a diameter of 80 and a height of 100 the least is 80: wall 0.05, foot 0.06, inner fillet
// 0.1, floor 0.07, handle 0.075 and 0.052 of it; the handle spans 0.29 of the height to both sides and
// reaches 0.3 of the diameter out, but at most 0.9 of its half span: 15.66 where the mug is 100 wide and 60
// high.
TEST(MugShape, FollowsFromDiameterAndHeight) {
  const mesh::MugShape s = mesh::mug_shape(80, 100);
  const std::pair<double, double> numbers[] = {{s.radius, 40},
                                               {s.half_height, 50},
                                               {s.wall, 4},
                                               {s.floor, 5.6},
                                               {s.foot_fillet, 4.8},
                                               {s.inner_fillet, 8},
                                               {s.handle_reach, 24},
                                               {s.handle_half_span, 29},
                                               {s.handle_half_width, 6},
                                               {s.handle_half_thickness, 4.16},
                                               {s.flare, 0.45}};
  for (const auto& [number, expected] : numbers) EXPECT_NEAR(number, expected, 1e-12);
  EXPECT_NEAR(mesh::mug_shape(100, 60).handle_reach, 15.66, 1e-12);
}

// The same mug, with c = cos 45 degrees: bottom, foot, outer wall, rim, inner wall, inner fillet, floor.
TEST(MugShape, HasABodyOfSevenPiecesByHand) {
  const RevolvedSurface body = mesh::mug_body(mesh::mug_shape(80, 100));
  const double c = std::sqrt(0.5);
  struct Place {
    double t, r, z;
  };
  for (const Place& p : {Place{0.0, 0, -50},
                         {0.5, 17.6, -50},
                         {1.0, 35.2, -50},
                         {1.5, 40 - 4.8 * (1 - c), -50 + 4.8 * (1 - c)},
                         {2.0, 40, -45.2},
                         {2.5, 40, 1.4},
                         {3.0, 40, 48},
                         {3.25, 40 - 2 * (1 - c), 50 - 2 * (1 - c)},
                         {3.5, 38, 50},
                         {4.0, 36, 48},
                         {4.5, 36, 5.8},
                         {5.0, 36, -36.4},
                         {5.5, 36 - 8 * (1 - c), -44.4 + 8 * (1 - c)},
                         {6.0, 28, -44.4},
                         {6.5, 14, -44.4},
                         {7.0, 0, -44.4}}) {
    EXPECT_NEAR(body.profile(p.t).x(), p.r, 1e-12) << p.t;
    EXPECT_NEAR(body.profile(p.t).y(), p.z, 1e-12) << p.t;
  }
  EXPECT_LT((body.quarter(0.5) - Eigen::Vector2d(c, c)).norm(), 1e-12);
  EXPECT_EQ(body.wall_begin, 2);
  EXPECT_EQ(body.wall_end, 3);
}

// The same mug's handle: stubs of 2 mm inside the wall, a half ellipse of 24 x 29 mm, and a section that
// is 1.45 times as large at the wall. At 45 degrees of it the outward normal goes with (29, 24); where it has
// come 6 mm out, the section is 1 + 0.45 (1 - 6 / 13.2)^2 times as large.
TEST(MugShape, HasAHandleByHand) {
  const Tube handle = mesh::mug_handle(mesh::mug_shape(80, 100));
  const auto expect = [&](double a, double v, const Vec3& p) {
    EXPECT_LT((handle.point(a, v) - p).norm(), 1e-9) << a << " " << v;
  };
  expect(0.5, 0.0, {38, 0, 29 + 1.45 * 4.16});
  expect(0.0, 0.0, {38, 0, 29 - 1.45 * 4.16});
  expect(0.25, 0.0, {38, 1.45 * 6, 29});
  expect(0.5, 0.06, {40, 0, 29 + 1.45 * 4.16});
  expect(0.5, 0.5, {64 + 4.16, 0, 0});
  expect(0.0, 0.5, {64 - 4.16, 0, 0});
  expect(0.25, 0.5, {64, 6, 0});
  expect(0.75, 0.5, {64, -6, 0});
  expect(0.5, 1.0, {38, 0, -29 - 1.45 * 4.16});
  const double c = std::sqrt(0.5);
  const Vec3 out = Vec3(29, 0, 24).normalized();
  expect(0.5, 0.06 + 0.88 * 0.25, Vec3(40 + 24 * c, 0, 29 * c) + 4.16 * out);
  const double angle = std::asin(0.25);
  const double blend = 1.0 - 6.0 / 13.2;
  const double scale = 1.0 + 0.45 * blend * blend;
  expect(0.25, 0.06 + 0.88 * angle / kPi, {46, 6 * scale, 29 * std::cos(angle)});
  EXPECT_TRUE(handle.returns);
}

TEST(Mug, HasEveryVertexOnItsBodyOrItsHandle) {
  const mesh::MugShape shape = mesh::mug_shape(0.082, 0.095);
  const RevolvedSurface body = mesh::mug_body(shape);
  const Tube handle = mesh::mug_handle(shape);
  for (const Vec3& v : mug(700).vertices)
    ASSERT_LT(std::min(distance_to_body(v, body), distance_to_tube(v, handle)), 1e-9) << v.transpose();
}

// A hand's finger must fit through the handle, and the wall between inside and outside must be there.
TEST(Mug, IsMadeForTheWholeRangeOfProportions) {
  for (const double ratio : {0.5, 0.8, 1.0, 1.5, 2.0, 3.0}) {
    for (const int n : {500, 3000}) {
      const TriangleMesh mesh = make_mug(0.08, 0.08 * ratio, n);
      EXPECT_EQ(test::manifold_flaw(mesh), "") << ratio;
      EXPECT_EQ(test::euler_characteristic(mesh), 0) << ratio;
      EXPECT_EQ(test::self_intersections(mesh), 0U) << ratio;
    }
  }
}

TEST(Teapot, HasItsExactLengthAndIsCentred) {
  for (const int n : {300, 2000, 10000}) {
    const Bounds b = bounds(teapot(n));
    EXPECT_NEAR(b.max.x(), 0.125, 1e-12) << n;
    EXPECT_NEAR(b.min.x(), -0.125, 1e-12) << n;
    EXPECT_NEAR(b.max.z() + b.min.z(), 0.0, 1e-12) << n;
    EXPECT_NEAR((b.max.z() - b.min.z()) / 0.25, 0.4896, 1e-4) << n;
    EXPECT_NEAR(b.max.y() + b.min.y(), 0.0, 1e-12) << n;
  }
}

TEST(Teapot, HasEveryVertexOnANewellPatchOrOnTheBridgeOrInTheSpoutsMouth) {
  const RevolvedSurface body = mesh::newell_body();
  const Tube handle = mesh::newell_handle();
  const Tube spout = mesh::newell_spout();
  // Back to Newell's units: z = 0 .. 3.15 and the ends of handle and spout.
  const double rear = handle.point(0.5, *handle.keep).x();
  const double front = spout.point(0.5, *spout.keep).x();
  int in_mouth = 0;
  for (const Vec3& v : make_teapot(front - rear, 700).vertices) {
    const Vec3 p = v + Vec3{0.5 * (front + rear), 0.0, 0.5 * mesh::kNewellHeight};
    const bool mouth = std::abs(p.z() - 2.4) < 1e-12 && std::abs(p.x() - 3.0) < 0.2 && std::abs(p.y()) < 0.12;
    if (mouth) ++in_mouth;
    ASSERT_TRUE(mouth || std::min({distance_to_body(p, body), distance_to_tube(p, handle),
                                   distance_to_tube(p, spout)}) < 1e-9)
        << p.transpose();
  }
  EXPECT_GE(in_mouth, 5);  // at the least its centre and the rim but for the two ends
}

// Newell's own control points at the patches' corners, by hand.
TEST(Teapot, SurfacesPassThroughNewellsCornerPoints) {
  const RevolvedSurface body = mesh::newell_body();
  EXPECT_LT((body.point(0.0, 3.0) - Vec3(1.5, 0, 2.4)).norm(), 1e-15);
  EXPECT_LT((body.point(0.25, 2.0) - Vec3(0, 2.0, 0.9)).norm(), 1e-15);
  EXPECT_LT((body.point(0.5, 1.0) - Vec3(-1.5, 0, 0.15)).norm(), 1e-15);
  EXPECT_LT((body.point(0.0, 7.0) - Vec3(0, 0, 3.15)).norm(), 1e-15);
  EXPECT_LT((mesh::newell_handle().point(0.0, 0.0) - Vec3(-1.6, 0, 2.025)).norm(), 1e-15);
  EXPECT_LT((mesh::newell_handle().point(0.5, 0.5) - Vec3(-3.0, 0, 1.8)).norm(), 1e-15);
  EXPECT_LT((mesh::newell_spout().point(0.5, 1.0) - Vec3(3.2, 0, 2.4)).norm(), 1e-15);
}

// In the middle of a cubic the four control points weigh 1, 3, 3, 1 over 8, in the middle of a patch rows and
// points alike. Of the handle's upper patch for one: the rows' means in x are -1.55, -2.4, -2.85 and -2.85,
// and theirs is -20.15 / 8. Newell's numbers, each of which counts here.
TEST(Teapot, SurfacesPassThroughTheMiddlesOfNewellsPatches) {
  const RevolvedSurface body = mesh::newell_body();
  const std::pair<double, double> middles[] = {{1.284375, 0.046875},  {1.75, 0.384375}, {1.84375, 1.621875},
                                               {1.403125, 2.4984375}, {1.35, 2.4},      {0.825, 2.55},
                                               {0.325, 2.98125}};
  double t = 0.5;
  for (const auto& [r, z] : middles) {
    EXPECT_LT((body.profile(t) - Eigen::Vector2d(r, z)).norm(), 1e-12) << t;
    t += 1.0;
  }
  EXPECT_LT((body.quarter(0.5) - Eigen::Vector2d(0.71, 0.71)).norm(), 1e-12);
  for (const double side : {-1.0, 1.0}) {
    const double a = 0.5 + 0.25 * side;
    const auto expect = [&](const Tube& tube, double v, double x, double y, double z) {
      EXPECT_LT((tube.point(a, v) - Vec3(x, side * y, z)).norm(), 1e-12) << a << " " << v;
    };
    expect(mesh::newell_handle(), 0.25, -2.51875, 0.225, 2.0953125);
    expect(mesh::newell_handle(), 0.75, -2.634375, 0.225, 1.25390625);
    expect(mesh::newell_spout(), 0.25, 2.5375, 0.34125, 1.621875);
    expect(mesh::newell_spout(), 0.75, 3.1265625, 0.15, 2.466796875);
  }
}

}  // namespace
}  // namespace phalanx
