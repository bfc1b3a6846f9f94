// SPDX-License-Identifier: Apache-2.0
// The largest ball in the hull of wrenches against values calculated by hand and against sampled directions.
#include "grasp/wrench_ball.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "phalanx/core/random.h"

namespace phalanx {
namespace {

std::vector<Wrench> cross_polytope(double size) {
  std::vector<Wrench> wrenches;
  for (int i = 0; i < 6; ++i)
    for (const double sign : {1.0, -1.0}) wrenches.push_back(sign * size * Wrench::Unit(i));
  return wrenches;
}

double support(const std::vector<Wrench>& wrenches, const Wrench& u) {
  double most = -1e300;
  for (const Wrench& w : wrenches) most = std::max(most, w.dot(u));
  return most;
}

/// Least support in directions that are drawn: an upper bound on the ball's radius.
double sampled_ball(const std::vector<Wrench>& wrenches, std::uint64_t seed, int count) {
  Random random(seed);
  double least = 1e300;
  for (int i = 0; i < count; ++i) {
    Wrench u;
    for (double& x : u) x = random.normal();
    least = std::min(least, support(wrenches, u.normalized()));
  }
  return least;
}

/// Contacts all around a ball, each pressed towards its centre.
std::vector<WrenchContact> around_ball(double radius, int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<WrenchContact> contacts;
  for (int i = 0; i < count; ++i) {
    const Vec3 out = Vec3(random.normal(), random.normal(), random.normal()).normalized();
    contacts.push_back({radius * out, -out});
  }
  return contacts;
}

// The facets of |x_1| + .. + |x_6| <= a have the distance a / sqrt(6) from zero.
TEST(WrenchBall, OfACrossPolytopeIsItsInscribedBall) {
  EXPECT_NEAR(wrench_ball(cross_polytope(1.0)), 1.0 / std::sqrt(6.0), 1e-12);
  EXPECT_NEAR(wrench_ball(cross_polytope(0.25)), 0.25 / std::sqrt(6.0), 1e-12);
}

TEST(WrenchBall, IsZeroUnlessZeroIsInside) {
  std::vector<Wrench> on_one_side = cross_polytope(1.0);
  for (Wrench& w : on_one_side) w(2) += 1.5;
  EXPECT_EQ(wrench_ball(on_one_side), 0.0);
  std::vector<Wrench> flat = cross_polytope(1.0);
  for (Wrench& w : flat) w(5) = 0.0;
  EXPECT_EQ(wrench_ball(flat), 0.0);
  EXPECT_EQ(wrench_ball({}), 0.0);
  EXPECT_EQ(wrench_ball({Wrench::Unit(0)}), 0.0);
}

TEST(WrenchBall, IsBelowTheSupportInEveryDirectionAndAlmostReachesIt) {
  int closed = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const auto wrenches = contact_wrenches(around_ball(0.03, 5, seed), 0.6, 4e-3, Vec3::Zero(), 0.03);
    const double ball = wrench_ball(wrenches);
    const double sampled = sampled_ball(wrenches, seed, 20'000);
    if (ball > 0.0) {
      ++closed;
      EXPECT_LE(ball, sampled + 1e-12);
      // The descent's least support is a touching one, or nearly.
      EXPECT_GE(ball, 0.8 * wrench_ball_bound(wrenches));
      EXPECT_GE(wrench_ball_bound(wrenches), ball - 1e-12);
      EXPECT_LE(wrench_ball_bound(wrenches), sampled + 1e-12) << "the descent finds what drawing finds";
    }
  }
  EXPECT_GT(closed, 4);
}

TEST(WrenchBall, BoundShowsThatZeroIsOutside) {
  std::vector<Wrench> on_one_side = cross_polytope(1.0);
  for (Wrench& w : on_one_side) w(2) += 1.5;
  EXPECT_LT(wrench_ball_bound(on_one_side), 0.0);
}

TEST(ContactWrenches, AreOnTheFrictionCone) {
  constexpr double kFriction = 0.5;
  constexpr double kSpin = 4e-3;
  const WrenchContact contact{Vec3(0.01, 0.02, 0.05), Vec3(1.0, 2.0, -2.0) / 3.0};
  const Vec3 centre(0.0, 0.01, 0.0);
  const auto wrenches = contact_wrenches({contact}, kFriction, kSpin, centre, 0.1);
  ASSERT_EQ(wrenches.size(), static_cast<std::size_t>(kSlideDirections + 2));
  for (std::size_t i = 0; i < wrenches.size(); ++i) {
    const Vec3 force = wrenches[i].head<3>();
    const Vec3 torque = 0.1 * wrenches[i].tail<3>();
    EXPECT_NEAR(force.dot(contact.inward), 1.0, 1e-12);
    const double along = (force - contact.inward).norm();
    const Vec3 own = torque - (contact.point - centre).cross(force);
    if (i < kSlideDirections) {
      EXPECT_NEAR(along, kFriction, 1e-12);
      EXPECT_LT(own.norm(), 1e-15);
    } else {
      EXPECT_LT(along, 1e-15);
      EXPECT_NEAR(std::abs(own.dot(contact.inward)), kFriction * kSpin, 1e-15);
    }
  }
}

// Two opposed contacts resist all but a rotation about the line between them; friction against spin resists that.
TEST(ContactWrenches, OfTwoOpposedContactsNeedSpinForForceClosure) {
  const std::vector<WrenchContact> pinch = {{Vec3(-0.02, 0, 0), Vec3::UnitX()},
                                            {Vec3(0.02, 0, 0), -Vec3::UnitX()}};
  EXPECT_LT(wrench_ball(contact_wrenches(pinch, 0.6, 0.0, Vec3::Zero(), 0.02)), 1e-9);
  EXPECT_GT(wrench_ball(contact_wrenches(pinch, 0.6, 4e-3, Vec3::Zero(), 0.02)), 0.05);
  EXPECT_LT(wrench_ball(contact_wrenches(pinch, 0.0, 4e-3, Vec3::Zero(), 0.02)), 1e-9) << "no friction";
}

}  // namespace
}  // namespace phalanx
