// SPDX-License-Identifier: Apache-2.0
#include "contact/normal_fan.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "phalanx/contact/gdp.h"
#include "phalanx/contact/proximity.h"
#include "phalanx/mesh/primitives.h"
#include "support/corner_down.h"
#include "support/lone_finger.h"
#include "support/reference/surface_bound.h"

namespace phalanx {
namespace {

using test::angle_of;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kFanMargin = 50e-6;

/// A ball of 5 mm radius. Its facets fold by up to 3 degrees; where several of them tie within 5 um over an
/// edge, on it and beside it, n_c is their mean and n may still be the face's.
constexpr double kBallFold = 8.0 * kDegree;
class Ball {
 public:
  static constexpr double kRadius = 5e-3;
  ContactPatch at(const Vec3& centre, const ObjectModel& object) {
    return contact_patch({ball_, Pose{turned_, centre}, scratch_}, object, 1.0);
  }

 private:
  SegmentTree ball_{make_sphere(2.0 * kRadius, 14000)};
  SearchScratch scratch_{ball_};
  Mat3 turned_ =
      rotation_about(Vec3(0.3, -0.5, 0.8).normalized(), 0.7);  // no edge of it parallel to the object's
};

TriangleMesh square_sheet() {
  return {{{-0.03, -0.03, 0}, {0.03, -0.03, 0}, {0.03, 0.03, 0}, {-0.03, 0.03, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// Adds a pair at `x` on both bodies.
void add_place(MeanDirection& mean, double x, double squared, const Vec3& direction, double weight) {
  mean.add({squared, Vec3(x, 0, 0), Vec3(x, 0, 0)}, direction, weight);
}

// Two places that face each other cancel out where their sum is at most a tenth of their weights: (1.15 - 1)
// / 2.15 = 0.070, but (1.35 - 1) / 2.35 = 0.149. Then the nearer one says the direction.
TEST(MeanDirectionByHand, WhereOppositeDirectionsCancelTheNearestDecides) {
  for (const double weight : {1.0, 1.15, 1.35}) {
    MeanDirection mean(1e-6);
    add_place(mean, 0.0, 4.0, Vec3::UnitZ(), weight);
    add_place(mean, 1.0, 1.0, -Vec3::UnitZ(), 1.0);
    EXPECT_EQ(mean.unit().z(), weight > 1.2 ? 1.0 : -1.0) << weight;
  }
  MeanDirection tied(1e-6);
  add_place(tied, 0.0, 1.0, Vec3::UnitZ(), 1.0);
  add_place(tied, 1.0, 1.0, -Vec3::UnitZ(), 1.0);
  EXPECT_EQ(tied.unit(), Vec3(Vec3::UnitZ())) << "the first of two that are as near";
}

// Of more than 32 places all count. 32 x and, of weight 32, one y: halfway between. And 31 x, one y, which is
// the nearest of these 32, and, of weight 27, one -x, whose distance is not kept: (4, 1) of 59 is less than a
// tenth, so that y decides.
TEST(MeanDirectionByHand, PlacesThatRunOverCountToo) {
  MeanDirection halfway(1e-6);
  for (int i = 0; i < 32; ++i) add_place(halfway, 1e-3 * i, 1.0, Vec3::UnitX(), 1.0);
  add_place(halfway, 1.0, 1.0, Vec3::UnitY(), 32.0);
  EXPECT_LT((halfway.unit() - Vec3(1.0, 1.0, 0.0).normalized()).norm(), 1e-12);
  MeanDirection cancelled(1e-6);
  for (int i = 0; i < 31; ++i) add_place(cancelled, 1e-3 * i, 4.0, Vec3::UnitX(), 1.0);
  add_place(cancelled, 1.0, 1.0, Vec3::UnitY(), 1.0);
  add_place(cancelled, 2.0, 0.25, -Vec3::UnitX(), 27.0);
  EXPECT_EQ(cancelled.unit(), Vec3(Vec3::UnitY()));
}

// Five pairs; two places are one if they are less than 1 um apart on both bodies. The first three are one
// place of weight 3, which faces as the nearest of them, the second, does. The fourth is 2 um aside on b
// alone, the fifth on a alone.
TEST(MeanDirectionByHand, PairsOfOnePlaceFaceAsTheNearestOfThem) {
  const Vec3 here = Vec3::Zero();
  const Vec3 beside(0.5e-6, 0, 0);
  const Vec3 away(2e-6, 0, 0);
  MeanDirection mean(1e-6);
  mean.add({4.0, here, here}, Vec3::UnitZ(), 1.0);
  mean.add({1.0, beside, here}, Vec3::UnitX(), 1.0);
  mean.add({2.0, here, beside}, Vec3::UnitY(), 1.0);
  mean.add({4.0, here, away}, Vec3::UnitY(), 4.0);
  mean.add({4.0, away, here}, Vec3::UnitZ(), 12.0);
  EXPECT_LT((mean.unit() - Vec3(3.0, 4.0, 12.0) / 13.0).norm(), 1e-12);
}

// Twenty, the first ten of them three times, and ten more, of which four have room.
TEST(TiedTriangles, HoldTheFirst24EachOnceInTheirOrder) {
  TiedTriangles tied;
  EXPECT_EQ(tied.begin(), tied.end());
  std::vector<int> expected;
  for (int i = 0; i < 20; ++i) {
    tied.add(100 - 3 * i);
    tied.add(100 - 3 * (i / 2));
    expected.push_back(100 - 3 * i);
  }
  for (int i = 0; i < 10; ++i) {
    tied.add(200 + i);
    if (i < 4) expected.push_back(200 + i);
  }
  EXPECT_EQ(std::vector<int>(tied.begin(), tied.end()), expected);
}

// Up, the same again, ten between it and x, then x, the twelfth. There is no room for y.
TEST(NormalFan, HoldsTwelveDirectionsEachOnce) {
  NormalFan fan;
  fan.add(Vec3::UnitZ());
  fan.add(Vec3::UnitZ());
  for (int i = 1; i <= 10; ++i) fan.add(Vec3(std::sin(8.0 * i * kDegree), 0.0, std::cos(8.0 * i * kDegree)));
  fan.add(Vec3::UnitX());
  fan.add(Vec3::UnitY());
  EXPECT_LT((fan.nearest(Vec3::UnitX()) - Vec3::UnitX()).norm(), 1e-9);
  EXPECT_NEAR(fan.nearest(Vec3::UnitY()).y(), 0.0, 1e-9);
}

TEST(NormalFan, TakesTheNearestDirectionOfItsCone) {
  NormalFan fan;
  EXPECT_EQ(fan.nearest(Vec3::UnitX()), Vec3(Vec3::UnitX())) << "an empty fan has no say";
  fan.add(Vec3::UnitZ());
  EXPECT_EQ(fan.nearest(Vec3::UnitX()), Vec3(Vec3::UnitZ()));
  fan.add(Vec3::UnitX());
  // In the plane y = 0 between z and x: the projection, by hand.
  EXPECT_LT((fan.nearest(Vec3(0.6, 0.64, 0.48)) - Vec3(0.6, 0, 0.48).normalized()).norm(), 1e-12);
  EXPECT_LT((fan.nearest(Vec3(-0.6, 0.0, 0.8)) - Vec3::UnitZ()).norm(), 1e-12) << "beyond an end: the end";
  fan.add(Vec3::UnitY());
  const Vec3 inside = Vec3(0.2, 0.3, 0.9).normalized();
  EXPECT_EQ(fan.nearest(inside), inside);
}

// Three directions all around a plane, one of which leans out of it by what may be rounding: across the plane
// there is nothing.
TEST(NormalFan, ThreeDirectionsInAPlaneDoNotEncloseWhatIsAcrossIt) {
  NormalFan fan;
  fan.add(Vec3::UnitX());
  fan.add(Vec3::UnitY());
  fan.add(Vec3(-0.6, -0.8, 1e-12));
  EXPECT_NEAR(fan.nearest(Vec3::UnitZ()).z(), 0.0, 1e-9);
}

TEST(NormalFan, NearestIsWhatADenseSearchFinds) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const auto unit = [&] { return Vec3(normal(random), normal(random), normal(random)).normalized(); };
  for (int n = 0; n < 50; ++n) {
    const Vec3 axis = unit();
    std::array<Vec3, 4> v;
    NormalFan fan;
    for (Vec3& x : v) fan.add(x = (axis + 0.8 * unit()).normalized());
    const Vec3 target = unit();
    double best = -1.0;
    constexpr int kSteps = 24;
    for (int a = 0; a <= kSteps; ++a) {
      for (int b = 0; a + b <= kSteps; ++b) {
        for (int c = 0; a + b + c <= kSteps; ++c) {
          const Vec3 x = a * v[0] + b * v[1] + c * v[2] + (kSteps - a - b - c) * v[3];
          best = std::max(best, x.normalized().dot(target));
        }
      }
    }
    const double found = fan.nearest(target).dot(target);
    EXPECT_GE(found, best - 1e-12) << "seed 5 case " << n;
    EXPECT_LE(std::acos(found), std::acos(best) + 1e-12);
    EXPECT_GE(std::acos(found), std::acos(best) - 0.1)
        << "no farther than the search's own step: it stays in the cone";
  }
}

// Near an edge the far triangle's nearest point is the edge, and points back at the ball; it must not turn
// n_c.
TEST(ContactPatch, OnAFlatPlateDoesNotFeelWhereTheTrianglesMeet) {
  TriangleMesh plate;
  constexpr int kCells = 20;
  for (int i = 0; i <= kCells; ++i) {
    for (int j = 0; j <= kCells; ++j) plate.vertices.emplace_back(i * 1e-3, j * 1e-3, 0.0);
  }
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const int a = i * (kCells + 1) + j;
      plate.triangles.push_back({a, a + kCells + 1, a + kCells + 2});
      plate.triangles.push_back({a, a + kCells + 2, a + 1});
    }
  }
  const ObjectModel object(plate);
  Ball ball;
  // A cube on its corner has one nearest point; of the ball, facets that fold by 3 degrees may tie.
  const SegmentTree cube(make_box(Vec3::Constant(6e-3), 12));
  SearchScratch scratch(cube);
  const Mat3 on_corner = test::corner_down();
  const double height = 3e-3 * std::numbers::sqrt3;
  for (int n = 0; n < 400; ++n) {
    const Vec3 place(8.5e-3 + n * 5e-6, 9.3e-3 + n * 1e-6, kFanMargin);
    const ContactPatch corner =
        contact_patch({cube, Pose{on_corner, place + Vec3(0, 0, height)}, scratch}, object, 1.0);
    ASSERT_LT(angle_of(corner.direction, Vec3::UnitZ()), 1e-9) << n;
    ASSERT_LT(angle_of(corner.object_normal, Vec3::UnitZ()), 1e-9) << n;
    const ContactPatch patch = ball.at(place + Vec3(0, 0, Ball::kRadius), object);
    ASSERT_LT(angle_of(patch.direction, Vec3::UnitZ()), 0.5 * kDegree) << n;
    ASSERT_LT(angle_of(patch.object_normal, Vec3::UnitZ()), 1e-9) << n;
  }
}

/// A ball rolls round a straight edge at x = y = 0 (along y), from one face to the other, in steps of a tenth
/// of a degree: the normal of the force goes with n_c, up to the fold of the ball's own facets.
void expect_steady_round_edge(const ObjectModel& object, const Vec3& from, double turn) {
  Ball ball;
  Vec3 last_n = from;
  Vec3 last_n_c = from;
  const int steps = static_cast<int>(turn / (0.1 * kDegree));
  for (int n = 0; n <= steps; ++n) {
    const double angle = turn * n / steps;
    const Vec3 u = rotation_about(Vec3::UnitY(), angle) * from;
    const ContactPatch patch = ball.at((Ball::kRadius + kFanMargin) * u + Vec3(0, 1e-3, 0), object);
    ASSERT_LT(angle_of(patch.direction, u), kBallFold) << "at " << angle / kDegree << " degrees";
    ASSERT_LE(angle_of(patch.object_normal, last_n), angle_of(patch.direction, last_n_c) + kBallFold)
        << "at " << angle / kDegree << " degrees, n " << patch.object_normal.transpose() << " before "
        << last_n.transpose() << ", n_c " << patch.direction.transpose() << " before "
        << last_n_c.transpose();
    ASSERT_LT(angle_of(patch.object_normal, patch.direction), kBallFold);
    last_n = patch.object_normal;
    last_n_c = patch.direction;
  }
}

/// Two squares that meet at the y axis, the first towards -x in z = 0 and facing up, the second turned down
/// by `fold`.
TriangleMesh folded(double fold) {
  const double c = 0.03 * std::cos(fold);
  const double s = -0.03 * std::sin(fold);
  return {{{-0.03, -0.03, 0}, {0, -0.03, 0}, {0, 0.03, 0}, {-0.03, 0.03, 0}, {c, -0.03, s}, {c, 0.03, s}},
          {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}};
}

TEST(ContactPatch, RoundACreaseTurnsTheNormalWithTheFinger) {
  for (const double fold : {31.0, 60.0, 90.0, 120.0, 170.0}) {
    SCOPED_TRACE(fold);
    expect_steady_round_edge(ObjectModel(folded(fold * kDegree)), Vec3::UnitZ(), fold * kDegree);
  }
}

TEST(ContactPatch, RoundTheRimOfASheetTurnsTheNormalFromOneSideToTheOther) {
  TriangleMesh half = folded(0.5);
  half.triangles.resize(2);
  expect_steady_round_edge(ObjectModel(half), Vec3::UnitZ(), std::numbers::pi);
  for (Triangle& t : half.triangles) std::swap(t[1], t[2]);
  expect_steady_round_edge(ObjectModel(half), Vec3::UnitZ(), std::numbers::pi);
}

TEST(ContactPatch, AFoldOf29DegreesIsRoundedAndOneOf31IsNot) {
  Ball ball;
  // 1 mm before the edge on the first face: a crease leaves the face's own normal, a smooth fold has begun to
  // turn it.
  const Vec3 before(-1e-3, 1e-3, Ball::kRadius + kFanMargin);
  EXPECT_LT(angle_of(ball.at(before, ObjectModel(folded(31.0 * kDegree))).object_normal, Vec3::UnitZ()),
            1e-9);
  const ObjectModel smooth(folded(29.0 * kDegree));
  // By hand: the corner normals at the fold are tilted by half of it, over the face of 30 mm they fade to
  // none.
  const Vec3 middle(std::sin(14.5 * kDegree), 0.0, std::cos(14.5 * kDegree));
  const Vec3 expected = (Vec3::UnitZ() / 30.0 + middle * 29.0 / 30.0).normalized();
  EXPECT_LT(angle_of(ball.at(before, smooth).object_normal, expected), 0.1 * kDegree);
}

TEST(ContactPatch, MeetsASheetFromBothSidesAlike) {
  const ObjectModel object(square_sheet());
  Ball ball;
  for (const Vec3& place : {Vec3(0, 0, 0), Vec3(0.01, -0.02, 0), Vec3(0.0299, 0.0, 0), Vec3(0.03, 0.03, 0)}) {
    const ContactPatch above = ball.at(place + Vec3(0, 0, Ball::kRadius + kFanMargin), object);
    const ContactPatch below = ball.at(place - Vec3(0, 0, Ball::kRadius + kFanMargin), object);
    EXPECT_GT(above.object_normal.z(), 0.99);
    EXPECT_LT(below.object_normal.z(), -0.99);
  }
}

// Two sheets in one place with opposite windings, as exporters write what is to be seen from both sides.
TEST(ContactPatch, MeetsTwoCoincidentSheetsOfOppositeWindingAsOne) {
  TriangleMesh twice = square_sheet();
  for (std::size_t t = 0; t < 2; ++t) {
    Triangle back = twice.triangles[t];
    std::swap(back[1], back[2]);
    twice.triangles.push_back(back);
  }
  const ObjectModel one(square_sheet());
  const ObjectModel two(twice);
  Ball ball;
  for (const double side : {1.0, -1.0}) {
    for (const Vec3& place : {Vec3(0.001, 0.002, 0), Vec3(0.0299, 0.01, 0)}) {
      const Vec3 centre = place + side * Vec3(0, 0, Ball::kRadius + kFanMargin);
      const ContactPatch a = ball.at(centre, one);
      const ContactPatch b = ball.at(centre, two);
      EXPECT_LT((a.object_normal - b.object_normal).norm(), 1e-9);
      EXPECT_LT((a.direction - b.direction).norm(), 1e-9);
      EXPECT_LT((a.on_object - b.on_object).norm(), 1e-9);
    }
  }
}

// Triangles at random, through each other, slivers and repeated ones among them: the worst that a mesh can
// be.
TriangleMesh random_soup(std::mt19937_64& random, int triangles) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  TriangleMesh mesh;
  for (int t = 0; t < triangles; ++t) {
    const Vec3 centre(0.03 * u(random), 0.03 * u(random), -0.02 + 0.01 * u(random));
    const auto first = static_cast<std::int32_t>(mesh.vertices.size());
    const double thin = t % 5 == 0 ? 1e-6 : 1.0;
    for (int k = 0; k < 3; ++k) {
      mesh.vertices.push_back(centre + 0.02 * Vec3(u(random), thin * u(random), u(random)));
      if (mesh.vertices.back().z() > -1e-3) mesh.vertices.back().z() = -1e-3;
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    if (t % 7 == 0) mesh.triangles.push_back({first, first + 2, first + 1});
    if (t % 11 == 0 && first >= 3) mesh.triangles.push_back({first, first + 1, first - 2});
  }
  return mesh;
}

TEST(ForceNormal, IsWithin30DegreesOfTheSeparationDirectionOnAnySoupOfTriangles) {
  std::mt19937_64 random(31);
  int contacts = 0;
  for (int n = 0; n < 150; ++n) {
    test::LoneFinger finger(ObjectModel(random_soup(random, 40)));
    std::uniform_real_distribution<double> u(-0.02, 0.02);
    const double start = finger.aim({.from = Vec3(u(random), u(random), 0.03),
                                     .along = -Vec3::UnitZ(),
                                     .heading = Vec3::UnitY(),
                                     .reach = 0.03});
    const test::Setup& model = finger.model();
    const ContactModel contact{model.hand, model.trees(), model.object, model.parameters.contact};
    GdpState state(contact);
    for (int i = 0; i <= 60; ++i) {
      const JointArray angle = test::LoneFinger::pose(start + 0.01 * i);
      HandPoses hcp;
      model.hand.poses(angle, hcp);
      std::array<bool, kDigits> measured;
      measured.fill(true);
      (void)advance_gdp(contact, angle, hcp, measured, state);
      for (const ContactRecord& record : state.record) {
        if (!record.active) continue;
        ++contacts;
        ASSERT_NEAR(record.force_normal.norm(), 1.0, 1e-9) << "seed 31 case " << n;
        ASSERT_NEAR(record.n_c.norm(), 1.0, 1e-9) << "seed 31 case " << n;
        ASSERT_LE(angle_of(record.force_normal, record.n_c), 30.0 * kDegree + 1e-9) << "seed 31 case " << n;
      }
    }
  }
  EXPECT_GT(contacts, 2000);
}

}  // namespace
}  // namespace phalanx
