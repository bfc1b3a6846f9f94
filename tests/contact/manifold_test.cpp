// SPDX-License-Identifier: Apache-2.0
// Contact points of a segment, where they can be worked out by hand.
#include "contact/manifold.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/mesh/primitives.h"
#include "support/reference/surface_bound.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

constexpr double kGap = 60e-6;
constexpr double kReach = 100e-6;

/// A segment above objects.
class Placed {
 public:
  Placed(const TriangleMesh& segment, TriangleMesh object)
      : tree_(segment), object_(std::move(object)), scratch_(tree_) {}

  Manifold at(const Pose& X_WS, int most = Manifold::kMost) {
    X_WS_ = X_WS;
    Manifold manifold;
    find_manifold({tree_, X_WS_, scratch_}, object_.tree(), kReach, kReach, most, near_, manifold);
    return manifold;
  }
  NearPairs& near() { return near_; }
  [[nodiscard]] PlacedSegment placed() { return {tree_, X_WS_, scratch_}; }
  [[nodiscard]] const ObjectModel& object() const { return object_; }

 private:
  SegmentTree tree_;
  ObjectModel object_;
  SearchScratch scratch_;
  NearPairs near_;
  Pose X_WS_;
};

/// A face of 40 mm at z = 0.
TriangleMesh face(int triangles) {
  return test::moved(make_box({0.04, 0.04, 0.01}, triangles), test::at(0.0, 0.0, -0.005));
}
/// A bar of 8 x 4 x 2 mm.
TriangleMesh bar() { return make_box({0.008, 0.004, 0.002}, 12); }

Pose turned(const Vec3& axis, double angle, double height) {
  return {Eigen::AngleAxisd(angle, axis).toRotationMatrix(), Vec3(0.0, 0.0, height)};
}

std::vector<Vec3> points(const Manifold& manifold) {
  std::vector<Vec3> out;
  for (int i = 0; i < manifold.count; ++i)
    out.push_back(manifold.place[static_cast<std::size_t>(i)].on_segment);
  std::sort(out.begin(), out.end(), [](const Vec3& a, const Vec3& b) {
    return std::abs(a.x() - b.x()) > 1e-9 ? a.x() < b.x() : a.y() < b.y();
  });
  return out;
}

TEST(Manifold, AFlatFaceIsHeldAtItsCornersHoweverTheObjectIsCut) {
  for (const int triangles : {12, 5000}) {
    Placed placed(bar(), face(triangles));
    const Manifold manifold = placed.at(test::at(0.0003, -0.0002, 0.001 + kGap));
    ASSERT_EQ(manifold.count, 4) << triangles;
    const std::vector<Vec3> at = points(manifold);
    const std::array<Vec3, 4> corners = {Vec3(-0.0037, -0.0022, kGap), Vec3(-0.0037, 0.0018, kGap),
                                         Vec3(0.0043, -0.0022, kGap), Vec3(0.0043, 0.0018, kGap)};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((at[i] - corners[i]).norm(), 1e-9) << triangles << " " << i;
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(manifold.place[static_cast<std::size_t>(i)].gap, kGap, 1e-12);
      EXPECT_NEAR(manifold.place[static_cast<std::size_t>(i)].direction.z(), 1.0, 1e-9);
    }
  }
}

TEST(Manifold, AnEdgeIsHeldAtItsEndsAndACornerAtItself) {
  for (const int triangles : {12, 5000}) {
    Placed placed(bar(), face(triangles));
    // Turned by 45 degrees about x, the edge of 8 mm is lowest.
    const double below = (0.002 + 0.001) * std::sqrt(0.5);
    const Manifold edge = placed.at(turned(Vec3::UnitX(), kPi / 4.0, below + kGap));
    ASSERT_EQ(edge.count, 2) << triangles;
    EXPECT_NEAR((points(edge)[0] - points(edge)[1]).norm(), 0.008, 1e-9);
    // Then by 10 degrees about y, one of its ends.
    Pose X = turned(Vec3::UnitY(), kPi / 18.0, 0.0);
    X.R = X.R * turned(Vec3::UnitX(), kPi / 4.0, 0.0).R;
    double lowest = 0.0;
    for (const Vec3& v : bar().vertices) lowest = std::min(lowest, (X.R * v).z());
    X.p.z() = kGap - lowest;
    const Manifold corner = placed.at(X);
    ASSERT_EQ(corner.count, 1) << triangles;
    EXPECT_NEAR(corner.place[0].gap, kGap, 1e-12);
  }
}

TEST(Manifold, TheNearestIsKeptWhereFewArePermitted) {
  Placed placed(bar(), face(12));
  Pose X = turned(Vec3::UnitY(), 2e-3, 0.0);  // one end 16 um lower
  double lowest = 0.0;
  for (const Vec3& v : bar().vertices) lowest = std::min(lowest, (X.R * v).z());
  X.p.z() = kGap - lowest;
  for (int most = 1; most <= 4; ++most) {
    const Manifold manifold = placed.at(X, most);
    ASSERT_EQ(manifold.count, most);
    EXPECT_NEAR(manifold.place[0].gap, kGap, 1e-12);
  }
}

TEST(Manifold, ABallInAGrooveTouchesBothSides) {
  TriangleMesh groove;
  for (const double side : {-1.0, 1.0}) {
    const Mat3 R = Eigen::AngleAxisd(side * kPi / 4.0, Vec3::UnitY()).toRotationMatrix();
    append(groove, make_box({0.03, 0.03, 0.01}, 400), Pose{R, R * Vec3(0.0, 0.0, -0.005)});
  }
  const double radius = 0.004;
  Placed placed(make_sphere(2.0 * radius, 2000), std::move(groove));
  const Manifold manifold = placed.at(test::at(0.0, 0.0, (radius + 50e-6) * std::sqrt(2.0)));
  ASSERT_GE(manifold.count, 2);
  double left = -1.0;
  double right = -1.0;
  for (int i = 0; i < manifold.count; ++i) {
    const Vec3& n = manifold.place[static_cast<std::size_t>(i)].direction;
    left = std::max(left, n.dot(Vec3(std::sqrt(0.5), 0.0, std::sqrt(0.5))));
    right = std::max(right, n.dot(Vec3(-std::sqrt(0.5), 0.0, std::sqrt(0.5))));
  }
  EXPECT_GT(left, 0.99);
  EXPECT_GT(right, 0.99);
}

TEST(Manifold, AFinelyCutFaceHasNoPlaceAtItsInnerEdges) {
  Placed placed(bar(), face(20000));
  int places = 0;
  for (int tilt = 1; tilt <= 20; ++tilt) {
    for (int shift = 0; shift < 20; ++shift) {
      // The bar's lower long edge is parallel to edges of the face.
      Pose X = turned(Vec3::UnitX(), 4e-3 * tilt, 0.0);
      X.p.y() = 0.031e-3 * shift;
      double lowest = 0.0;
      for (const Vec3& corner : bar().vertices) lowest = std::min(lowest, (X.R * corner).z());
      X.p.z() = kGap - lowest;
      const Manifold manifold = placed.at(X);
      for (int i = 0; i < manifold.count; ++i, ++places)
        ASSERT_GT(manifold.place[static_cast<std::size_t>(i)].direction.z(), 1.0 - 1e-8)
            << tilt << " " << shift;
    }
  }
  EXPECT_GE(places, 800);
}

TEST(Manifold, TheNormalAtAPlaceIsInterpolatedOverASmoothSurface) {
  Placed placed(make_sphere(0.01, 500), make_sphere(0.06, 1000));
  double features = 0.0;
  for (int i = 0; i < 50; ++i) {
    const Vec3 radial = Vec3(std::cos(0.13 * i), std::sin(0.13 * i), 0.8 - 0.03 * i).normalized();
    Manifold manifold;
    for (double height = 0.0352; manifold.count == 0 && height > 0.034; height -= 5e-6)
      manifold = placed.at({Mat3::Identity(), height * radial});
    ASSERT_GT(manifold.count, 0) << i;
    const ContactPlace& place = manifold.place[0];
    const Vec3 normal = normal_at_place(placed.object(), placed.near(), place);
    EXPECT_NEAR(normal.norm(), 1.0, 1e-12);
    EXPECT_LT(test::angle_of(normal, place.on_object), 0.5 * kDeg) << i;
    features = std::max(features, test::angle_of(place.direction, place.on_object));
  }
  EXPECT_GT(features, 2.0 * kDeg) << "the directions themselves must fail";
}

TEST(Manifold, TheNormalAtACreaseIsTheDirectionBetweenItsFaces) {
  Placed placed(make_sphere(0.01, 2000), face(5000));
  for (const double degrees : {10.0, 30.0, 45.0, 70.0}) {
    const Vec3 out(std::sin(degrees * kDeg), 0.0, std::cos(degrees * kDeg));
    Manifold manifold;
    for (double away = 0.0052; manifold.count == 0 && away > 0.0048; away -= 5e-6)
      manifold = placed.at({Mat3::Identity(), Vec3(0.02, 0.0003, 0.0) + away * out});
    ASSERT_GT(manifold.count, 0) << degrees;
    const ContactPlace& place = manifold.place[0];
    EXPECT_GT(place.direction.x(), 0.1) << degrees;
    EXPECT_GT(place.direction.z(), 0.1) << degrees;
    EXPECT_LT((normal_at_place(placed.object(), placed.near(), place) - place.direction).norm(), 1e-9)
        << degrees;
  }
}

TEST(Manifold, NothingIsFoundBeyondTheReach) {
  Placed placed(bar(), face(12));
  EXPECT_EQ(placed.at(test::at(0.0, 0.0, 0.001 + kReach + 1e-6)).count, 0);
}

TEST(NearPairsCarried, AreListedForTheNewPoseAndSearchedAgainForTheirPoints) {
  Placed placed(bar(), face(200));
  (void)placed.at(test::at(0.0, 0.0, 0.001 + kGap));
  NearPairs& near = placed.near();
  const double least = near.bound(test::at(0.0, 0.0, 0.001 + kGap));
  EXPECT_NEAR(least, kGap, 1e-12);
  const Pose there = test::at(0.0, 0.0, 0.001 + kGap - 10e-6);
  near.carry(there, 10e-6);
  EXPECT_TRUE(near.holds(there, kReach - 10.1e-6));
  EXPECT_FALSE(near.holds(there, kReach - 9.9e-6)) << "what was farther away may be nearer now";
  EXPECT_NEAR(near.bound(there), kGap - 10e-6, 1e-12);
  const Manifold fresh = placed.at(there);
  ASSERT_GT(fresh.count, 0);
  EXPECT_NEAR(fresh.place[0].gap, kGap - 10e-6, 1e-12) << "closest points are those of the new pose";
}

}  // namespace
}  // namespace phalanx
