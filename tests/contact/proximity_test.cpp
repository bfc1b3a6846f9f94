// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/proximity.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "contact/containment.h"
#include "phalanx/contact/triangle_distance.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx {
namespace {

double brute_force(const TriangleTree& a, const TriangleTree& b) {
  double best = 1e300;
  for (int i = 0; i < a.size(); ++i) {
    for (int j = 0; j < b.size(); ++j)
      best = std::min(best, triangle_distance(a.corners(i), b.corners(j)).squared);
  }
  return std::sqrt(best);
}

struct Case {
  TriangleMesh segment = make_tapered_capsule(0.03, 0.008, 0.006, 10, 3, 2);
  ObjectModel object{make_torus(0.08, 0.02, 600)};
  TriangleTree at_rest{segment, 1};
  TriangleTree placed{at_rest};
};

Pose random_pose(std::mt19937_64& random, double size) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> u(-size, size);
  const Vec3 axis = Vec3(normal(random), normal(random), normal(random)).normalized();
  return Pose{rotation_about(axis, u(random) / size * 3.0), Vec3(u(random), u(random), u(random))};
}

TEST(Proximity, DistanceEqualsBruteForceAtSeededPoses) {
  Case c;
  std::mt19937_64 random(7);
  for (int i = 0; i < 150; ++i) {
    c.placed.place(c.at_rest, random_pose(random, 0.08));
    const double expected = brute_force(c.placed, c.object.tree());
    EXPECT_EQ(distance(c.placed, c.object.tree(), 1.0), expected) << "seed 7 case " << i;
    EXPECT_EQ(distance(c.placed, c.object.tree(), 0.5 * expected), 0.5 * expected)
        << "a cap below it comes back";
  }
}

TEST(Proximity, ASafeAdvanceNeverGoesBelowTheFloor) {
  Case c;
  const StopBand band = stop_band(50e-6);
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int advanced = 0;
  for (int i = 0; i < 300; ++i) {
    // A single joint at `centre` turning about `axis`: exact motion, speed and acceleration.
    const Pose start = random_pose(random, 0.07);
    c.placed.place(c.at_rest, start);
    const double clearance = distance(c.placed, c.object.tree(), 1.0);
    if (clearance <= band.margin) continue;
    const Vec3 centre = start.p + 0.05 * Vec3(u(random), u(random), u(random));
    const Vec3 axis = Vec3(u(random), u(random), u(random)).normalized();
    const double rate = 1.5 * u(random);
    double radius = 0.0;
    for (const Vec3& v : c.segment.vertices) radius = std::max(radius, (start * v - centre).norm());
    const SegmentMotion motion{.angular = rate * axis,
                               .linear = -rate * axis.cross(centre),
                               .speed = std::abs(rate) * radius,
                               .acceleration = rate * rate * radius};
    const Advance advance = safe_advance(c.placed, c.object.tree(), motion, 1.0, band);
    EXPECT_FALSE(advance.blocked);
    if (advance.step > 0.0) ++advanced;
    for (int n = 0; n <= 20; ++n) {
      const double s = advance.step * n / 20.0;
      const Mat3 R = rotation_about(axis, rate * s);
      c.placed.place(c.at_rest, Pose{R, centre - R * centre} * start);
      ASSERT_GE(distance(c.placed, c.object.tree(), 1.0), band.floor - 1e-12)
          << "seed 11 case " << i << " s " << s;
    }
  }
  EXPECT_GT(advanced, 100);
}

TEST(Proximity, OnlyClosingMotionIsBlockedWithinTheMargin) {
  // A capsule 40 um above a floor, margin 50 um.
  const ObjectModel floor(make_box(Vec3(1.0, 1.0, 1.0), 12));
  const TriangleMesh segment = make_tapered_capsule(0.03, 0.008, 0.008, 12, 3, 2);
  const TriangleTree at_rest(segment, 1);
  TriangleTree placed(at_rest);
  const double lowest = bounds(segment).min.y();
  placed.place(at_rest, Pose{Mat3::Identity(), Vec3(0.0, 0.5 - lowest + 40e-6, 0.0)});
  const auto moving = [](const Vec3& v) { return SegmentMotion{.linear = v, .speed = v.norm()}; };
  const StopBand band = stop_band(50e-6);
  EXPECT_TRUE(safe_advance(placed, floor.tree(), moving(Vec3(0, -1e-3, 0)), 1.0, band).blocked);
  EXPECT_FALSE(safe_advance(placed, floor.tree(), moving(Vec3(0, 1e-3, 0)), 1.0, band).blocked);
  const Advance sideways = safe_advance(placed, floor.tree(), moving(Vec3(1e-3, 0, 0)), 1.0, band);
  EXPECT_FALSE(sideways.blocked);
  EXPECT_EQ(sideways.step, 1.0);
}

TEST(Proximity, AFlatTouchPicksTheMiddle) {
  // A box lying 50 um above a larger one: every point of its lower face is closest. The middle must not
  // depend on how the faces are cut.
  for (const int table_triangles : {12, 48, 300}) {
    for (const int box_triangles : {12, 48, 200}) {
      const ObjectModel table(make_box(Vec3(0.2, 0.2, 0.2), table_triangles));
      const TriangleTree at_rest(make_box(Vec3(0.02, 0.02, 0.02), box_triangles), 1);
      TriangleTree placed(at_rest);
      placed.place(at_rest, Pose{Mat3::Identity(), Vec3(0.013, -0.007, 0.11 + 50e-6)});
      const ContactPatch patch = contact_patch(placed, table, 1e-3);
      EXPECT_NEAR(patch.distance, 50e-6, 1e-15);
      EXPECT_NEAR(patch.on_segment.x(), 0.013, 5e-6);
      EXPECT_NEAR(patch.on_segment.y(), -0.007, 5e-6);
      EXPECT_NEAR(patch.on_object.x(), 0.013, 5e-6);
      EXPECT_NEAR(patch.direction.z(), 1.0, 1e-12);
      EXPECT_NEAR(patch.object_normal.z(), 1.0, 1e-12);
    }
  }
}

TEST(Proximity, AnEdgeLyingOnAFacePicksTheMiddleOfTheEdge) {
  const ObjectModel table(make_box(Vec3(0.2, 0.2, 0.2), 300));
  const TriangleTree at_rest(make_box(Vec3(0.02, 0.02, 0.02), 12), 1);
  TriangleTree placed(at_rest);
  const Mat3 R = rotation_about(Vec3::UnitY(), std::numbers::pi / 4.0);
  placed.place(at_rest, Pose{R, Vec3(0.003, 0.004, 0.1 + 0.01 * std::numbers::sqrt2 + 50e-6)});
  const ContactPatch patch = contact_patch(placed, table, 1e-3);
  EXPECT_NEAR(patch.on_segment.x(), 0.003, 1e-5);
  EXPECT_NEAR(patch.on_segment.y(), 0.004, 1e-4);
}

TEST(Proximity, ASheetsNormalIsOnTheSideOfTheHand) {
  TriangleMesh sheet;
  sheet.vertices = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const ObjectModel object(sheet);
  const TriangleMesh segment = make_sphere(0.01, 200);
  const TriangleTree at_rest(segment, 1);
  TriangleTree placed(at_rest);
  for (const double side : {1.0, -1.0}) {
    placed.place(at_rest, Pose{Mat3::Identity(), Vec3(0.1, 0.2, side * 0.006)});
    const ContactPatch patch = contact_patch(placed, object, 1.0);
    EXPECT_NEAR(patch.object_normal.z(), side, 1e-12);
    EXPECT_NEAR(patch.direction.z(), side, 1e-12);
  }
}

TEST(WindingNumber, IsOneInsideZeroOutside) {
  const TriangleMesh torus = make_torus(0.08, 0.02, 800);
  EXPECT_NEAR(winding_number(torus, Vec3(0.04, 0, 0)), 1.0, 1e-9);
  EXPECT_NEAR(winding_number(torus, Vec3(0, 0, 0)), 0.0, 1e-9);
  EXPECT_NEAR(winding_number(torus, Vec3(0.2, 0.1, 0)), 0.0, 1e-9);
}

TEST(Containment, SeesASegmentInsideAnObjectAndAnObjectInsideASegment) {
  const TriangleMesh small = make_sphere(0.01, 100);
  const TriangleMesh large = make_sphere(0.1, 400);
  EXPECT_TRUE(Containment(large).with(small, Pose{}));
  EXPECT_TRUE(Containment(small).with(large, Pose{}));
  EXPECT_FALSE(Containment(large).with(small, Pose{Mat3::Identity(), Vec3(0.2, 0, 0)}));
}

TEST(Containment, DoesNotCountVerticesThatNoTriangleUses) {
  TriangleMesh sheet;  // 5 cm below the ball, and a stray vertex inside it
  sheet.vertices = {Vec3(-1, -1, -0.05), Vec3(1, -1, -0.05), Vec3(0, 1, -0.05), Vec3(0, 0, 0)};
  sheet.triangles = {{0, 1, 2}};
  EXPECT_FALSE(Containment(sheet).with(make_sphere(0.01, 100), Pose{}));
}

TEST(Containment, SeesThroughAnInsideOutSolidAndDuplicateFaces) {
  const TriangleMesh small = make_sphere(0.01, 100);
  TriangleMesh inside_out = make_sphere(0.1, 400);
  for (Triangle& t : inside_out.triangles) std::swap(t[1], t[2]);
  EXPECT_TRUE(Containment(inside_out).with(small, Pose{}));
  TriangleMesh sheet;  // a large table, every triangle twice, 3 cm away: contains nothing
  sheet.vertices = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 2, 3}};
  for (const double side : {0.03, -0.03}) {
    EXPECT_FALSE(Containment(sheet).with(small, Pose{Mat3::Identity(), Vec3(0, 0, side)}));
  }
}

}  // namespace
}  // namespace phalanx
