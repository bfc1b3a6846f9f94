// SPDX-License-Identifier: Apache-2.0
// Open surfaces are met from both sides: the force points back to the side the finger came from, and the
// finger stays there.
#include <gmock/gmock.h>

#include <functional>
#include <random>

#include "phalanx/mesh/primitives.h"
#include "support/lone_finger.h"
#include "support/reference/raw_triangles.h"

namespace phalanx {
namespace {

using test::Approach;
using test::LoneFinger;
using test::Press;

const Vec3 kSheetX = Vec3::UnitX();
const Vec3 kSheetY = Vec3::UnitY();
const Vec3 kSheetZ = Vec3::UnitZ();

/// Cells of a square grid of side 60 mm in z = 0 for which keep(x, y) holds at the cell's centre.
TriangleMesh sheet(const std::function<bool(double, double)>& keep) {
  constexpr int kCells = 20;
  TriangleMesh mesh;
  for (int i = 0; i <= kCells; ++i) {
    for (int j = 0; j <= kCells; ++j) mesh.vertices.emplace_back(0.003 * i - 0.03, 0.003 * j - 0.03, 0.0);
  }
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      if (!keep(0.003 * i - 0.0285, 0.003 * j - 0.0285)) continue;
      const int a = i * (kCells + 1) + j;
      mesh.triangles.push_back({a, a + kCells + 1, a + kCells + 2});
      mesh.triangles.push_back({a, a + kCells + 2, a + 1});
    }
  }
  return mesh;
}
TriangleMesh whole_sheet() {
  return sheet([](double, double) { return true; });
}
TriangleMesh flipped(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

Approach from_side(double side, double x, double y) {
  return {.from = Vec3(x, y, side * 0.012), .along = -side * kSheetZ, .heading = kSheetY, .reach = 0.02};
}

/// All corners of the index finger's distal segment are on the side of z = 0 where it came from.
void expect_on_side(const LoneFinger& finger, const Snapshot& s, double side, double height) {
  const auto tip = static_cast<std::size_t>(segment_index(test::kIndex, 2));
  for (const Vec3& v : const_cast<LoneFinger&>(finger).model().hand.mesh(static_cast<int>(tip)).vertices)
    ASSERT_GE(side * ((s.gdp_pose[tip] * v).z() - height), 50e-6 - 10e-9);
}

TEST(Sheet, PressesBackAlikeFromBothSidesWhicheverWayItIsWound) {
  for (const TriangleMesh& mesh : {whole_sheet(), flipped(whole_sheet())}) {
    LoneFinger finger{ObjectModel(mesh)};
    for (const double x : {-0.02, 0.0, 0.0131}) {
      const std::optional<Press> above = finger.press(from_side(1.0, x, 0.004), 1e-3);
      const std::optional<Press> below = finger.press(from_side(-1.0, x, 0.004), 1e-3);
      ASSERT_TRUE(above && below);
      EXPECT_GT(above->force.z(), 0.9);
      EXPECT_LT((above->force.normalized() - kSheetZ).norm(), 1e-9);
      EXPECT_LT((below->force.normalized() + kSheetZ).norm(), 1e-9);
      // The same press turned over, but for where on the fingertip's facets the contact's middle comes to
      // lie: that moves its lever of 77 mm by less than 0.1 mm.
      EXPECT_NEAR(below->force.norm(), above->force.norm(), 0.1 / 77.0);
      expect_on_side(finger, above->snapshot, 1.0, 0.0);
      expect_on_side(finger, below->snapshot, -1.0, 0.0);
    }
  }
}

TEST(Sheet, IsNeverCrossedHoweverDeepTheFingerGoes) {
  LoneFinger finger{ObjectModel(whole_sheet())};
  for (const double side : {1.0, -1.0}) {
    for (const double depth : {1e-3, 5e-3, 20e-3}) {
      const std::optional<Press> press = finger.press(from_side(side, 0.002, 0.004), depth);
      ASSERT_TRUE(press);
      expect_on_side(finger, press->snapshot, side, 0.0);
      EXPECT_GT(side * press->force.z(), 0.9 * 1000.0 * depth);
    }
  }
}

TEST(Sheet, IsNotFeltThroughTheMiddleOfAHoleAndPushesSidewaysAtItsRim) {
  const auto ring = [](double x, double y) {
    return std::max(std::abs(x), std::abs(y)) > 0.01;
  };  // a hole of 18 mm
  LoneFinger finger{ObjectModel(sheet(ring))};
  for (const double side : {1.0, -1.0}) {
    Approach middle = from_side(side, 0.0, 0.0);
    middle.reach = 0.014;  // the fingertip's centre goes 2 mm through
    EXPECT_FALSE(finger.press(middle, 1e-3)) << "the fingertip is 10 mm wide";
    // The fingertip's centre 3 mm inside the rim at x = 9 mm: the rim meets the ball of 5 mm at 37 degrees
    // from below.
    const std::optional<Press> rim = finger.press(from_side(side, 0.006, 0.0), 1e-3);
    ASSERT_TRUE(rim);
    const Vec3 n = rim->force.normalized();
    EXPECT_LT(n.x(), -0.3) << "towards the hole's middle";
    EXPECT_GT(side * n.z(), 0.6) << "and back";
    // It is the direction of closest approach, up to 15 degrees of the fingertip's own facets.
    EXPECT_LT(std::acos(n.dot(Vec3(-3, 0, side * 4).normalized())), 0.27);
  }
}

TEST(Sheet, OfTwoSheetsTheNearerOneStopsTheFinger) {
  TriangleMesh two = whole_sheet();
  append(two, whole_sheet(), Pose{Mat3::Identity(), Vec3(0, 0, 0.2e-3)});
  LoneFinger finger{ObjectModel(two)};
  LoneFinger one{ObjectModel(whole_sheet())};
  for (const double side : {1.0, -1.0}) {
    const std::optional<Press> press = finger.press(from_side(side, 0.002, 0.004), 1e-3);
    const std::optional<Press> alone = one.press(from_side(side, 0.002, 0.004), 1e-3);
    ASSERT_TRUE(press && alone);
    expect_on_side(finger, press->snapshot, side, side > 0.0 ? 0.2e-3 : 0.0);
    EXPECT_LT((press->force.normalized() - side * kSheetZ).norm(), 1e-9);
    EXPECT_NEAR(press->force.norm(), alone->force.norm(), 0.03)
        << "0.2 mm earlier on the fingertip's arc, up to a facet farther on the fingertip";
  }
}

TEST(Sheet, ThinnerThanTheMarginIsMetLikeOne) {
  for (const double thickness : {0.0, 1e-6, 20e-6, 49e-6}) {
    TriangleMesh two = flipped(whole_sheet());  // faces down
    append(two, whole_sheet(), Pose{Mat3::Identity(), Vec3(0, 0, thickness)});
    LoneFinger finger{ObjectModel(two)};
    for (const double side : {1.0, -1.0}) {
      const std::optional<Press> press = finger.press(from_side(side, 0.002, 0.004), 1e-3);
      ASSERT_TRUE(press);
      EXPECT_LT((press->force.normalized() - side * kSheetZ).norm(), 1e-9) << "thickness " << thickness;
      EXPECT_NEAR(press->force.norm(), 1.0, 0.1);
      expect_on_side(finger, press->snapshot, side, side > 0.0 ? thickness : 0.0);
    }
  }
}

/// What is left of a ball of this radius within 25 degrees of its top.
TriangleMesh bowl(double radius) {
  TriangleMesh mesh = make_sphere(2.0 * radius, 4000);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    Vec3 sum = Vec3::Zero();
    for (const std::int32_t v : t) sum += mesh.vertices[static_cast<std::size_t>(v)];
    return sum.normalized().z() < std::cos(25.0 * std::numbers::pi / 180.0);
  });
  return mesh;
}

TEST(Sheet, AnOpenBowlPressesOutwardOutsideAndInwardInside) {
  constexpr double kRadius = 0.06;
  LoneFinger finger{ObjectModel(bowl(kRadius))};
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int outside = 0;
  int inside = 0;
  for (int n = 0; n < 60; ++n) {
    const Vec3 out = Vec3(0.15 * u(random), 0.15 * u(random), 1.0).normalized();
    const Vec3 heading = rotation_about(out, 3.1 * u(random)) * out.unitOrthogonal();
    for (const double side : {1.0, -1.0}) {
      std::optional<Press> press;
      try {
        press = finger.press(
            {.from = (kRadius + side * 0.012) * out, .along = -side * out, .heading = heading, .reach = 0.02},
            1e-3);
      } catch (const std::invalid_argument&) {
        continue;  // the rest of the finger does not fit into the bowl
      }
      if (!press || press->segment != 2) continue;
      (side > 0.0 ? outside : inside) += 1;
      EXPECT_GT(side * press->normal.dot(press->point.normalized()), 0.9) << "seed 8 case " << n;
      EXPECT_GT(press->force.norm(), 0.5);
      const auto tip = static_cast<std::size_t>(segment_index(test::kIndex, 2));
      const double gap = test::brute_force_gap(
          test::raw_of(finger.model().hand.mesh(static_cast<int>(tip)), press->snapshot.gdp_pose[tip]),
          test::raw_of(finger.model().object.mesh()), 1e-3);
      EXPECT_NEAR(gap, 50e-6, 10e-9) << "seed 8 case " << n;
    }
  }
  EXPECT_GE(outside, 50);
  EXPECT_GE(inside, 30);
}

TEST(Sheet, TheFootOfATeapotIsMetFromOutsideAndFromItsInside) {
  // All that is more than 12 mm above its foot is cut off: a dish that is open upwards.
  TriangleMesh foot = make_teapot(0.15, 3000);
  std::erase_if(foot.triangles, [&](const Triangle& t) {
    const auto z = [&](std::size_t k) { return foot.vertices[static_cast<std::size_t>(t[k])].z(); };
    return z(0) + z(1) + z(2) > -0.075;
  });
  LoneFinger finger{ObjectModel(foot)};
  const std::optional<Press> inside = finger.press(
      {.from = Vec3(-0.01, 0.002, 0.02), .along = -kSheetZ, .heading = kSheetX, .reach = 0.055}, 1e-3);
  const std::optional<Press> outside = finger.press(
      {.from = Vec3(-0.01, 0.002, -0.05), .along = kSheetZ, .heading = kSheetX, .reach = 0.02}, 1e-3);
  ASSERT_TRUE(inside && outside);
  EXPECT_GT(inside->force.normalized().z(), 0.9);
  EXPECT_LT(outside->force.normalized().z(), -0.9);
}

}  // namespace
}  // namespace phalanx
