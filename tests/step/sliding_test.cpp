// SPDX-License-Identifier: Apache-2.0
// Sliding mode: forces and motion of a finger that slides with friction, against closed forms.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "phalanx/contact/gdp.h"
#include "phalanx/contact/proximity.h"
#include "phalanx/core/constants.h"
#include "phalanx/force/force_stage.h"
#include "phalanx/force/local_wall.h"
#include "phalanx/mesh/primitives.h"
#include "support/lone_finger.h"
#include "support/sanitized.h"
#include "support/sliding_finger.h"

namespace phalanx {
namespace {

using test::ball;
using test::block;
using test::LoneFinger;
using test::on_measured;
using test::Press;
using test::Pressed;
using test::raw_force;
using test::Runner;
using test::sliding_finger;

TEST(Sliding, APressWithoutFrictionGivesTheLawsForce) {
  LoneFinger finger = sliding_finger(block(0.2, 0.02), 0.0);
  const Pressed press(finger, 3e-3);
  ASSERT_TRUE(press.tip().contact);
  const double depth = (press.tip().point - on_measured(press.hand.now(), 2)).z();
  EXPECT_NEAR(depth, 3e-3, 0.1e-3);
  EXPECT_NEAR(press.tip().force, 500.0 * depth, 1e-3 * 500.0 * depth);
  EXPECT_NEAR(press.tip().normal.z(), 1.0, 1e-9);
}

TEST(Sliding, TorquesAreThoseOfEveryContact) {
  // The middle segment lies flat on a block, with several contact points, and is dragged sideways.
  test::Setup model(test::simple_hand(),
                    ObjectModel(test::moved(make_box({0.3, 0.02, 0.03}, 12), test::at(0.0, -0.031, -0.055))));
  test::turn_limits_off(model);
  HapticParameters& parameters = model.parameters;
  parameters.contact.mode = ContactMode::kSliding;
  parameters.rate_hz = 1000.0;
  const ContactModel contact{model.hand, model.trees(), model.object, parameters.contact,
                             parameters.period()};
  GdpState gdp(contact);
  ForceState force;
  HandPoses hcp;
  std::array<bool, kDigits> measured{};
  measured.fill(true);
  int most = 0;
  double largest_couple = 0.0;
  for (int i = 0; i <= 600; ++i) {
    const double close = std::min(1.0, i / 300.0);
    const double flexion = 0.45 * close;
    const JointArray q =
        test::index_angles(flexion, 0.04 * close - flexion, 0.0, 0.3e-3 * std::max(0, i - 300));
    model.hand.poses(q, hcp);
    (void)advance_gdp(contact, q, hcp, measured, gdp);
    (void)compute_command(parameters, gdp, hcp, false, force);
    const DigitPose& pose = gdp.poses.digit[test::kIndex];
    const DigitContacts& contacts = gdp.sliding[test::kIndex];
    DigitAngles torque{};
    std::array<int, kSegmentsPerDigit> pressing{};
    for (int c = 0; c < contacts.count; ++c) {
      const SlidingContact& at = contacts.contact[static_cast<std::size_t>(c)];
      const PointJacobian J =
          point_jacobian(pose, at.k, pose.segment[static_cast<std::size_t>(at.k)] * at.p_S);
      const Vec3 f = at.resultant();
      for (std::size_t j = 0; j < torque.size(); ++j) {
        torque[j] += parameters.force.stiffness *
                     (J.linear[j].dot(f) + J.angular[j].dot(at.force_normal) * at.spin_depth);
      }
      pressing[static_cast<std::size_t>(at.k)] += at.depth[0] > 0.0 ? 1 : 0;
    }
    most = std::max(most, *std::max_element(pressing.begin(), pressing.end()));
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      largest_couple = std::max(
          largest_couple, gdp.record[static_cast<std::size_t>(segment_index(test::kIndex, k))].couple.norm());
    for (int j = 0; j < kJointsPerDigit; ++j) {
      ASSERT_NEAR(force.torque[static_cast<std::size_t>(joint_index(test::kIndex, j))],
                  torque[static_cast<std::size_t>(j)], 1e-9)
          << "tick " << i << ", joint " << j;
    }
  }
  EXPECT_GE(most, 2) << "contact points of one segment";
  EXPECT_GT(largest_couple, 1e-4);
}

TEST(Sliding, AContactPointsForceTurnsWithItsNormal) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> n;
  for (int i = 0; i < 100; ++i) {
    SlidingContact contact;
    contact.normal = Vec3(n(random), n(random), n(random)).normalized();
    contact.tangent[0] = contact.normal.unitOrthogonal();
    contact.tangent[1] = contact.normal.cross(contact.tangent[0]);
    contact.force_normal = (contact.normal + 0.3 * Vec3(n(random), n(random), n(random))).normalized();
    contact.depth = {std::abs(n(random)), n(random), n(random)};
    const Vec3 friction = contact.friction_depth();
    EXPECT_LT((contact.with_force_normal(contact.normal) - contact.force_normal).norm(), 1e-12) << "seed 4";
    EXPECT_NEAR(friction.dot(contact.force_normal), 0.0, 1e-12);
    EXPECT_NEAR(friction.norm(), std::hypot(contact.depth[1], contact.depth[2]), 1e-12);
    // By the shortest way: what is across both normals stays.
    const Vec3 across = contact.normal.cross(contact.force_normal);
    EXPECT_LT((contact.with_force_normal(across) - across).norm(), 1e-12);
    EXPECT_NEAR(contact.resultant().dot(contact.force_normal), contact.depth[0], 1e-12);
  }
}

TEST(Sliding, JointsBeyondTheContactFollowAndCarryNoTorque) {
  // A straight finger lies with its middle segment on a block; the last joint bends freely.
  test::Setup model(test::simple_hand(), ObjectModel(test::moved(make_box({0.04, 0.02, 0.015}, 12),
                                                                 test::at(0.0, -0.03, -0.052))));
  test::turn_limits_off(model);
  model.parameters.rate_hz = 1000.0;
  model.parameters.contact.mode = ContactMode::kSliding;
  Runner hand(model);
  hand.move(test::index_angles(0.35), 300);
  ASSERT_TRUE(test::index_segment(hand.now(), 1).contact);
  ASSERT_FALSE(test::index_segment(hand.now(), 2).contact);
  for (int i = 1; i <= 200; ++i) {
    const Snapshot& s = hand.tick(test::index_angles(0.35, 0.0, 1e-3 * i));
    ASSERT_EQ(test::index_gdp(s, 3), 1e-3 * i);
    ASSERT_LE(std::abs(test::index_torque(s, 3)), 1e-12);
    ASSERT_GT(std::abs(test::index_torque(s, 0)), 1e-3);
  }
}

class SlidingMu : public testing::TestWithParam<double> {};

TEST_P(SlidingMu, ADraggedFingerSlipsAtMu) {
  const double mu = GetParam();
  LoneFinger finger = sliding_finger(block(0.2, 0.02), mu);
  Pressed press(finger, 3e-3);
  double largest = 0.0;
  const Vec3 start = press.tip().point;
  for (int i = 1; i <= 400; ++i) {
    const Vec3 before = press.tip().point;
    press.hand.tick(LoneFinger::pose(press.goal, 0.4e-3 * i));
    const Vec3 f = press.tip().force * press.tip().normal;
    const double ratio = std::hypot(f.x(), f.y()) / f.z();
    largest = std::max(largest, ratio);
    if (i > 300) {
      ASSERT_NEAR(ratio, mu, 1e-5) << i;
      const Vec3 moved = press.tip().point - before;
      ASSERT_LT(f.x() * moved.x() + f.y() * moved.y(), 0.0) << i << ": friction opposes the motion";
    }
  }
  EXPECT_NEAR(largest, mu, 1e-9);
  EXPECT_GT((press.tip().point - start).norm(), 5e-3) << "it slides";
}

INSTANTIATE_TEST_SUITE_P(Mu, SlidingMu, testing::Values(0.1, 0.3, 0.6, 1.0));

// Two blocks side by side, of 0.2 and 0.9; the coefficient of the parameters is that of neither. The finger is dragged
// from the first, which ends 4 mm beside it, to the second.
TEST(Sliding, EachObjectMayHaveItsFriction) {
  TriangleMesh mesh = test::moved(block(0.1, 0.02), test::at(-0.046, 0.0, 0.0));
  const int second = static_cast<int>(mesh.triangles.size());
  append(mesh, block(0.1, 0.02), test::at(0.054, 0.0, 0.0));
  LoneFinger finger(ObjectModel(mesh, ObjectModel::kDefaultCreaseAngle, {{0, 0.2}, {second, 0.9}}));
  finger.model().parameters.contact.mode = ContactMode::kSliding;
  finger.model().parameters.contact.friction = 0.5;
  finger.model().parameters.force.stiffness = 500.0;
  Pressed press(finger, 3e-3);
  const double way = press.tip().point.x();
  const auto tip = static_cast<std::size_t>(segment_index(test::kIndex, 2));
  const double before = press.hand.now().hcp_pose[tip].p.x();
  press.hand.tick(LoneFinger::pose(press.goal, 1e-3));
  const double sign = press.hand.now().hcp_pose[tip].p.x() > before ? 1.0 : -1.0;
  const auto ratio = [&] {
    const Vec3 f = press.tip().force * press.tip().normal;
    return std::hypot(f.x(), f.y()) / f.z();
  };
  int on_first = 0;
  for (int i = 1; i <= 900; ++i) {
    press.hand.tick(LoneFinger::pose(press.goal, sign * 0.4e-3 * i));
    const double x = press.tip().point.x() - way;
    if (i > 20 && press.tip().slips && x < 3.5e-3) {
      ASSERT_NEAR(ratio(), 0.2, 1e-5) << i << " " << x;
      ++on_first;
    }
  }
  EXPECT_GT(on_first, 20);
  EXPECT_GT(press.tip().point.x() - way, 5e-3);
  EXPECT_NEAR(ratio(), 0.9, 1e-5);
  ASSERT_GT(press.hand.now().contact_points.count, 0);
  EXPECT_EQ(press.hand.now().contact_points.point[0].coefficient, 0.9);
  EXPECT_THROW(ObjectModel(mesh, ObjectModel::kDefaultCreaseAngle, {{0, 2.5}}), std::invalid_argument);
  EXPECT_THROW(ObjectModel(mesh, ObjectModel::kDefaultCreaseAngle, {{0, -0.1}}), std::invalid_argument);
}

// A finger that begins inside a slab. Of all angles at which it is clear, tried one by one around, none is nearer to
// the measured ones by more than the grid tells. Friction would hold it where it first touched.
TEST(Sliding, ADigitThatStartsInsideIsShownByTheShortestWay) {
  test::Setup model(test::simple_hand(),
                    ObjectModel(test::moved(make_box({0.06, 0.02, 0.3}, 12), test::at(0.0, -0.030, 0.0))));
  model.parameters.contact.mode = ContactMode::kSliding;
  model.parameters.rate_hz = 1000.0;
  const JointArray measured = test::index_angles(0.5, 0.3, 0.2);
  Runner hand(model);
  for (int i = 0; i < 500; ++i) hand.tick(measured);
  ASSERT_EQ(hand.now().opening[test::kIndex].phase, OpeningPhase::kUnconfirmed);
  const DigitAngles from = digit_angles(measured, test::kIndex);
  const DigitAngles shown = digit_angles(hand.now().gdp_angle, test::kIndex);
  const auto way = [&](const DigitAngles& q) {
    double squared = 0.0;
    for (std::size_t i = 0; i < q.size(); ++i) squared += (q[i] - from[i]) * (q[i] - from[i]);
    return std::sqrt(squared);
  };
  SearchScratch scratch(model.trees());
  const auto is_clear = [&](const DigitAngles& q) {
    DigitPose pose;
    model.hand.digit_pose(test::kIndex, q, pose);
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const PlacedSegment placed{model.trees()[static_cast<std::size_t>(segment_index(test::kIndex, k))],
                                 pose.segment[static_cast<std::size_t>(k)], scratch};
      if (!(distance(placed, model.object.tree(), 1e-3) > model.parameters.contact.margin)) return false;
    }
    return true;
  };
  double nearest = way(shown);
  EXPECT_GT(nearest, 0.1);
  for (double mcp = -0.3; mcp <= 0.3; mcp += 0.03) {
    for (double pip = -0.3; pip <= 0.3; pip += 0.03) {
      for (double dip = -0.3; dip <= 0.3; dip += 0.06) {
        DigitAngles q = shown;
        q[0] += mcp;
        q[2] += pip;
        q[3] += dip;
        if (way(q) < nearest && is_clear(q)) nearest = way(q);
      }
    }
  }
  EXPECT_GT(nearest, 0.98 * way(shown)) << "a grid of 0.03 rad found a way of " << nearest << " rad";
}

TEST(Sliding, AtRestNothingChanges) {
  LoneFinger finger = sliding_finger(block(0.2, 0.02), 0.6);
  Pressed press(finger, 3e-3);
  for (int i = 1; i <= 200; ++i) press.hand.tick(LoneFinger::pose(press.goal, 0.3e-3 * i));
  press.rest(1000);
  const Snapshot before = press.hand.now();
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kTicks = 2000;
  for (int i = 0; i < kTicks; ++i) {
    press.rest(1);
    const double change = press.tip().force - test::index_segment(before, 2).force;
    sum += change;
    squares += change * change;
  }
  EXPECT_LT(std::sqrt(std::max(0.0, squares / kTicks - sum / kTicks * (sum / kTicks))), 1e-9) << "[N]";
  const auto tip = static_cast<std::size_t>(segment_index(test::kIndex, 2));
  EXPECT_LT((press.hand.now().gdp_pose[tip].p - before.gdp_pose[tip].p).norm(), 1e-6 / 60.0 * kTicks * 1e-3)
      << "less than 1 um a minute";
}

// A spring that is stretched is forgotten when the finger lifts.
TEST(Sliding, AFingerThatLiftsForgetsItsFriction) {
  LoneFinger finger = sliding_finger(block(0.2, 0.02), 0.6);
  Pressed press(finger, 3e-3);
  const auto along = [&] { return std::abs(press.tip().force * press.tip().normal.x()); };
  EXPECT_LT(along(), 1e-3);
  for (int i = 1; i <= 100; ++i) press.hand.tick(LoneFinger::pose(press.goal, 0.4e-3 * i));
  EXPECT_GT(along(), 0.3);
  press.hand.move(LoneFinger::pose(press.touched - 0.3e-3 / LoneFinger::lever(), 0.04), 100);
  ASSERT_EQ(press.hand.now().contact_points.count, 0);
  press.hand.move(LoneFinger::pose(press.goal, 0.04), 200);
  EXPECT_GT(press.tip().force, 1.0);
  EXPECT_LT(along(), 0.02) << "it has come straight down";
}

TEST(Sliding, SensorNoiseAtRestIsNotAmplified) {
  LoneFinger finger = sliding_finger(block(0.2, 0.02), 0.6);
  Pressed press(finger, 3e-3);
  const JointArray rest = press.hand.now().hcp_angle;
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 0.2e-3);
  Vec3 sum = Vec3::Zero();
  Vec3 squares = Vec3::Zero();
  constexpr int kTicks = 3000;
  for (int i = 0; i < kTicks; ++i) {
    JointArray q = rest;
    for (int j = 0; j < kJointsPerDigit; ++j)
      q[static_cast<std::size_t>(joint_index(test::kIndex, j))] += noise(random);
    press.hand.tick(q);
    const Vec3 f = press.tip().force * press.tip().normal;
    sum += f;
    squares += f.cwiseProduct(f);
  }
  const Vec3 mean = sum / kTicks;
  const Vec3 rms = (squares / kTicks - mean.cwiseProduct(mean)).cwiseSqrt();
  // 0.2 mrad move the fingertip by 17 um, and 0.5 N/mm make 9 mN of it. Along the face the spring gives way.
  EXPECT_LT(rms.z(), 0.01) << "[N], seed 3";
  EXPECT_LT(rms.x(), 0.003);
  EXPECT_LT(rms.y(), 0.003);
}

TEST(Sliding, AFinerMeshOfTheSameFaceGivesTheSameForce) {
  for (const double mu : {0.0, 0.6, 2.0}) {
    LoneFinger coarse = sliding_finger(block(0.2, 0.02), mu);
    LoneFinger fine = sliding_finger(block(0.2, 0.02, 20000), mu);
    Pressed on_coarse(coarse, 3e-3);
    Pressed on_fine(fine, 3e-3);
    const auto force = [](const Pressed& p) { return Vec3(p.tip().force * p.tip().normal); };
    Vec3 before = force(on_coarse);
    for (int i = 1; i <= 200; ++i) {
      for (Pressed* press : {&on_coarse, &on_fine})
        press->hand.tick(LoneFinger::pose(press->goal, 0.4e-3 * i));
      ASSERT_LT((force(on_coarse) - force(on_fine)).norm(), 1e-3) << mu << ", tick " << i;
      // A tick moves the fingertip by 30 um: 7.5 mN of friction, and 15 where it rolls onto another facet.
      ASSERT_LT((force(on_coarse) - before).norm(), 0.02)
          << mu << ", tick " << i << ": a contact point has handed its load over";
      before = force(on_coarse);
    }
  }
}

// Dragged by less than it takes to slip: friction grows by the spring's stiffness times the motion of the shown finger.
TEST(Sliding, FrictionThatHoldsIsASpringOfTheStatedStiffness) {
  for (const double ratio : {0.1, 0.5, 1.0}) {
    LoneFinger finger = sliding_finger(block(0.2, 0.02), 2.0);
    finger.model().parameters.contact.tangential_stiffness_ratio = ratio;
    Pressed press(finger, 3e-3);
    const auto tip = static_cast<std::size_t>(segment_index(test::kIndex, 2));
    const Vec3 start = press.tip().point;
    const Vec3 on_tip = press.hand.now().gdp_pose[tip].inverse() * start;
    const Vec3 before = press.tip().force * press.tip().normal;
    for (int i = 1; i <= 50; ++i) press.hand.tick(LoneFinger::pose(press.goal, 0.4e-3 * i));
    ASSERT_FALSE(press.tip().slips) << ratio;
    const Vec3 moved = press.hand.now().gdp_pose[tip] * on_tip - start;
    const Vec3 grown = press.tip().force * press.tip().normal - before;
    ASSERT_GT(std::abs(moved.x()), 0.3e-3) << ratio;
    EXPECT_NEAR(grown.x(), -500.0 * ratio * moved.x(), 0.02 * std::abs(grown.x())) << ratio;
  }
}

class SlidingGroove : public testing::TestWithParam<double> {};

TEST_P(SlidingGroove, AFingerComesOutWithoutAPull) {
  for (const double mu : {0.1, 0.6, 1.0, 2.0}) {
    LoneFinger finger = sliding_finger(test::groove(GetParam() * kDeg), mu);
    Pressed press(finger, 2e-3);
    ASSERT_GT(raw_force(press.hand.now()), 0.1) << mu;
    ASSERT_EQ(press.hand.now().contact_points.count, 2) << mu << ": it is between both faces";
    const double out = press.touched - 0.3e-3 / LoneFinger::lever();
    for (int i = 1; i <= 100; ++i) {
      press.hand.tick(LoneFinger::pose(press.goal + (out - press.goal) * i / 100.0));
      ASSERT_GE(press.tip().force * press.tip().normal.z(), -1e-3) << mu << ", tick " << i << ": it pulls";
    }
    EXPECT_LE(raw_force(press.hand.now()), 1e-3) << mu;
    EXPECT_EQ(digit_angles(press.hand.now().gdp_angle, test::kIndex),
              digit_angles(press.hand.now().hcp_angle, test::kIndex))
        << mu;
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, SlidingGroove, testing::Values(90.0, 20.0));

/// Work that the finger puts into the object on a closed path over a ball, 2 mm deep [J].
double work_of_a_loop(double mu, ForceNormal normal = ForceNormal::kInterpolated) {
  LoneFinger finger = sliding_finger(ball(), mu);
  finger.model().parameters.contact.normal = normal;
  Pressed press(finger, 2e-3);
  constexpr int kTicks = 4000;
  double work = 0.0;
  for (int round = 0; round < 2; ++round) {
    Snapshot before = press.hand.now();
    work = 0.0;
    for (int i = 1; i <= kTicks; ++i) {
      const double t = 2.0 * kPi * i / kTicks;
      const JointArray q =
          test::index_angles(press.goal + 0.02 * (std::cos(t) - 1.0), 0.01 * std::sin(2.0 * t),
                             LoneFinger::kBend, 0.06 * std::sin(t));
      const Snapshot& s = press.hand.tick(q);
      for (std::size_t j = 0; j < kJoints; ++j)
        work -= 0.5 * (s.torque[j] + before.torque[j]) * (s.hcp_angle[j] - before.hcp_angle[j]);
      before = s;
    }
  }
  return work;
}

TEST(Sliding, AClosedPathGivesBackWhatItTookAndFrictionTakesMore) {
  if (test::kSlowBuild)
    GTEST_SKIP() << "no other way through the code than the drags, but 30,000 ticks of it";
  for (const ForceNormal normal : {ForceNormal::kInterpolated, ForceNormal::kContact}) {
    const double without = work_of_a_loop(0.0, normal);
    const double with = work_of_a_loop(0.6, normal);
    std::printf("%s normals: %.2e J without friction, %.2e J with\n",
                normal == ForceNormal::kContact ? "the features'" : "interpolated", without, with);
    EXPECT_GT(without, -1e-6);
    EXPECT_LT(without, 1e-4);
    EXPECT_GT(with, 1e-3);
  }
}

/// How far a force turns at most.
struct TurningOverABall {
  double over_a_millimetre =
      0.0;  ///< per length of the contact's way, over at least a millimetre of it, times the radius
  double in_a_tick = 0.0;  ///< [rad]
};

/// Drags the finger without friction over a ball, 2 mm deep.
TurningOverABall turning_over_a_ball(ForceNormal normal, int triangles) {
  constexpr double kRadius = 0.03;
  Pose X = test::at(0.0, 0.0, -kRadius);
  X.R = Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()).toRotationMatrix();  // the pole's slivers are elsewhere
  LoneFinger finger(ObjectModel(test::moved(make_sphere(2.0 * kRadius, triangles), X)), 20000);
  finger.model().parameters.contact.mode = ContactMode::kSliding;
  finger.model().parameters.contact.friction = 0.0;
  finger.model().parameters.contact.normal = normal;
  finger.model().parameters.force.stiffness = 500.0;
  Pressed press(finger, 2e-3);
  std::vector<Press> path;
  for (int i = 1; i <= 400; ++i) {
    press.hand.tick(LoneFinger::pose(press.goal, 0.2e-3 * i));
    path.push_back(LoneFinger::felt(press.hand.now(), 0.0));
  }
  TurningOverABall turning;
  for (std::size_t i = 0; i < path.size(); ++i) {
    double way = 0.0;
    for (std::size_t j = i + 1; j < path.size() && way < 1e-3; ++j) {
      way += (path[j].point - path[j - 1].point).norm();
      if (way < 1e-3) continue;
      const double angle = test::angle_of(path[i].force, path[j].force);
      turning.over_a_millimetre = std::max(turning.over_a_millimetre, kRadius * angle / way);
    }
    if (i > 0)
      turning.in_a_tick = std::max(turning.in_a_tick, test::angle_of(path[i].force, path[i - 1].force));
  }
  return turning;
}

TEST(Sliding, TheForceTurnsWithTheSurfaceAndNotWithItsTriangles) {
  for (const int triangles : {1000, 20000}) {
    if (test::kSlowBuild && triangles > 1000) continue;
    const TurningOverABall turning = turning_over_a_ball(ForceNormal::kInterpolated, triangles);
    const TurningOverABall features = turning_over_a_ball(ForceNormal::kContact, triangles);
    std::printf("%d triangles: %.3f / r, %.2f mrad in a tick; of the features %.2f / r, %.2f mrad\n",
                triangles, turning.over_a_millimetre, 1e3 * turning.in_a_tick, features.over_a_millimetre,
                1e3 * features.in_a_tick);
    EXPECT_LE(turning.over_a_millimetre, 1.15);
    EXPECT_LE(turning.in_a_tick, 0.01);
    EXPECT_GE(features.in_a_tick, 0.03) << "the features' own normals must fail by far";
  }
}

TEST(Sliding, CapsAndSmoothingKeepTheForceInItsCone) {
  for (const Stabiliser method : {Stabiliser::kSmoothing, Stabiliser::kRiseOnly, Stabiliser::kLowPass}) {
    LoneFinger finger = sliding_finger(block(0.2, 0.02), 0.6);
    finger.model().parameters.stabiliser.method = method;
    finger.model().parameters.limits.fingertip_force_enabled = true;
    finger.model().parameters.limits.fingertip_force = 1.2;
    Pressed press(finger, 4e-3);
    double most = 0.0;
    for (int i = 1; i <= 300; ++i) {
      press.hand.tick(LoneFinger::pose(press.goal, 0.08 * std::sin(0.05 * i)));
      const Vec3 f = press.tip().force * press.tip().normal;
      ASSERT_LE(std::hypot(f.x(), f.y()), 0.6 * f.z() * (1.0 + 1e-9)) << i;
      ASSERT_LE(f.norm(), 1.2 + 1e-9) << i;
      most = std::max(most, f.norm());
    }
    EXPECT_GT(most, 1.0) << static_cast<int>(method);
  }
}

/// Checks the contact points of the index finger's tip: their shares add up to the force sent, and each is in its
/// cone. @returns their number
int check_points(const Snapshot& s, const ContactParameters& parameters) {
  const SegmentSnapshot& tip = test::index_segment(s, 2);
  Vec3 sum = Vec3::Zero();
  Vec3 friction = Vec3::Zero();
  int count = 0;
  for (const ContactPoint& at : s.contact_points) {
    EXPECT_EQ(at.segment, segment_index(test::kIndex, 2));
    EXPECT_NEAR(at.normal.norm(), 1.0, 1e-12);
    EXPECT_NEAR(at.friction.dot(at.normal), 0.0, 1e-12);
    EXPECT_GE(at.force, 0.0);
    EXPECT_EQ(at.coefficient, parameters.friction);
    EXPECT_LE(at.friction.norm(), at.coefficient * at.force * (1.0 + 1e-9));
    EXPECT_LE(std::abs(at.spin), at.coefficient * parameters.spin_radius * at.force * (1.0 + 1e-9));
    sum += at.force * at.normal + at.friction;
    friction += at.friction;
    ++count;
  }
  EXPECT_LT((sum - tip.force * tip.normal).norm(), 1e-12);
  EXPECT_LT((friction - tip.friction).norm(), 1e-12);
  return count;
}

TEST(Sliding, ContactPointsShareTheForceSent) {
  for (const bool in_groove : {false, true}) {
    LoneFinger finger =
        in_groove ? sliding_finger(test::groove(90.0 * kDeg), 0.1) : sliding_finger(block(0.2, 0.02), 0.6);
    finger.model().parameters.limits.fingertip_force_enabled = true;
    finger.model().parameters.limits.fingertip_force = 1.2;
    Pressed press(finger, 3e-3);
    const ContactParameters& parameters = finger.model().parameters.contact;
    const int at_rest = check_points(press.hand.now(), parameters);
    EXPECT_GE(at_rest, in_groove ? 2 : 1);
    double spin = 0.0;
    for (int i = 1; i <= 300; ++i) {
      press.hand.tick(LoneFinger::pose(press.goal, 0.4e-3 * i));
      check_points(press.hand.now(), parameters);
      spin = std::max(spin, std::abs(press.tip().spin));
    }
    EXPECT_GT(spin, 1e-5) << "a finger that turns as it is dragged [Nm]";
  }
}

TEST(Sliding, ASegmentSlipsAtTheSpeedAtWhichItIsDragged) {
  LoneFinger finger = sliding_finger(block(0.2, 0.02), 0.6);
  Pressed press(finger, 3e-3);
  EXPECT_FALSE(press.tip().slips);
  EXPECT_LT(press.tip().slip_speed, 1e-9) << "at rest [m/s]";
  for (int i = 1; i <= 400; ++i) {
    const double before = test::index_gdp(press.hand.now(), 1);
    press.hand.tick(LoneFinger::pose(press.goal, 0.4e-3 * i));
    if (i <= 300) continue;
    ASSERT_TRUE(press.tip().slips) << i;
    // The shown finger turns about its first joint, which is above the block, and bends a little as it slides.
    const auto first = static_cast<std::size_t>(segment_index(test::kIndex, 0));
    const Vec3 arm = press.tip().point - press.hand.now().gdp_pose[first].p;
    const double rate = (test::index_gdp(press.hand.now(), 1) - before) / 1e-3;
    const double speed = rate * std::hypot(arm.x(), arm.y());
    ASSERT_GT(rate, 0.3) << i << " [rad/s]";
    ASSERT_NEAR(press.tip().slip_speed, speed, 0.1 * speed) << i;
  }
}

TEST(Sliding, StaticModeAndForcesWithoutContactHaveNoContactPoints) {
  LoneFinger finger = sliding_finger(block(0.2, 0.02), 0.6);
  finger.model().parameters.stabiliser.method = Stabiliser::kSmoothing;
  finger.model().parameters.stabiliser.min_rate = -10.0;
  Pressed press(finger, 3e-3);
  press.hand.move(LoneFinger::pose(press.goal, 0.1), 50);
  ASSERT_GT(press.hand.now().contact_points.count, 0);
  ASSERT_GT(press.tip().friction.norm(), 0.1);
  press.hand.move(LoneFinger::pose(press.touched - 2e-2, 0.1), 5);
  ASSERT_FALSE(press.tip().contact);
  ASSERT_GT(press.tip().force, 0.1) << "it decays";
  EXPECT_EQ(press.hand.now().contact_points.count, 0);
  EXPECT_EQ(press.tip().friction, Vec3::Zero());
  EXPECT_EQ(press.tip().slip_speed, 0.0);
  EXPECT_FALSE(press.tip().slips);
  finger.model().parameters.contact.mode = ContactMode::kStatic;
  press.hand.move(LoneFinger::pose(press.goal, 0.1), 100);
  ASSERT_TRUE(press.tip().contact);
  EXPECT_EQ(press.hand.now().contact_points.count, 0);
  EXPECT_EQ(press.tip().friction, Vec3::Zero());
}

TEST(Sliding, TheLocalWallReplacesTheTorqueOfItsContact) {
  LoneFinger finger = sliding_finger(block(0.2, 0.02), 0.6);
  finger.model().parameters.stabiliser.method = Stabiliser::kLocalWall;
  Pressed press(finger, 3e-3);
  for (int i = 1; i <= 200; ++i) {
    const Snapshot& s = press.hand.tick(LoneFinger::pose(press.goal, 0.3e-3 * i));
    const LocalWall& wall = s.wall[static_cast<std::size_t>(segment_index(test::kIndex, 2))];
    ASSERT_TRUE(wall.active) << i;
    for (int j = 0; j < kJointsPerDigit; ++j) {
      ASSERT_NEAR(wall.g[static_cast<std::size_t>(j)] * wall.host_force, test::index_torque(s, j), 1e-12)
          << i << ", joint " << j;
    }
  }
  press.hand.move(LoneFinger::pose(press.touched - 1e-2), 5);
  const Snapshot& off = press.hand.now();
  EXPECT_FALSE(off.wall[static_cast<std::size_t>(segment_index(test::kIndex, 2))].active)
      << "the wall ends with its contact";
}

// Between two of the host's steps a segment's contacts and their friction are one spring along their whole force:
// around any closed path of the joints the controller's walls take and give the same work. The middle segment lies
// flat on the block and is dragged, so that the force is aslant and has a couple.
TEST(Sliding, TheLocalWallsOfOneStepAreConservative) {
  test::Setup model(test::simple_hand(),
                    ObjectModel(test::moved(make_box({0.3, 0.02, 0.03}, 12), test::at(0.0, -0.031, -0.055))));
  test::turn_limits_off(model);
  model.parameters.contact.mode = ContactMode::kSliding;
  model.parameters.stabiliser.method = Stabiliser::kLocalWall;
  model.parameters.rate_hz = 1000.0;
  Runner hand(model);
  constexpr std::uint64_t kSeed = 5;
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> apart(-0.02, 0.02);  // [rad]: some walls are left on the way
  double turned_over = 0.0;
  for (int i = 0; i <= 600; ++i) {
    const double close = std::min(1.0, i / 300.0);
    const double flexion = 0.45 * close;
    hand.tick(test::index_angles(flexion, 0.04 * close - flexion, 0.0, 0.3e-3 * std::max(0, i - 300)));
    if (i % 50 != 0) continue;
    const DigitAngles reference = digit_angles(hand.now().hcp_angle, test::kIndex);
    const auto torque = [&](const DigitAngles& q) {
      DigitAngles sum{};
      for (int k = 0; k < kSegmentsPerDigit; ++k) {
        const LocalWall& wall = hand.now().wall[static_cast<std::size_t>(segment_index(test::kIndex, k))];
        const double force = local_wall_force(wall, q, reference);
        for (std::size_t j = 0; j < sum.size(); ++j) sum[j] += wall.g[j] * force;
      }
      return sum;
    };
    std::array<DigitAngles, 5> corner;
    for (DigitAngles& at : corner)
      for (std::size_t j = 0; j < at.size(); ++j) at[j] = reference[j] + apart(random);
    double work = 0.0;
    double passed = 0.0;
    constexpr int kPieces = 2000;
    for (std::size_t c = 0; c < corner.size(); ++c) {
      const DigitAngles& from = corner[c];
      const DigitAngles& to = corner[(c + 1) % corner.size()];
      for (int piece = 0; piece < kPieces; ++piece) {
        DigitAngles middle{};
        for (std::size_t j = 0; j < middle.size(); ++j)
          middle[j] = from[j] + (to[j] - from[j]) * (piece + 0.5) / kPieces;
        const DigitAngles t = torque(middle);
        double done = 0.0;
        for (std::size_t j = 0; j < t.size(); ++j) done += t[j] * (to[j] - from[j]) / kPieces;
        work += done;
        passed += std::abs(done);
      }
    }
    EXPECT_LE(std::abs(work), 1e-5 * passed + 1e-12) << "tick " << i << ", seed " << kSeed;
    turned_over += passed;
  }
  EXPECT_GT(turned_over, 1e-3) << "[J]";
}

TEST(Sliding, OneContactPointASegmentSufficesInAGroove) {
  LoneFinger finger = sliding_finger(test::groove(90.0 * kDeg), 0.6);
  finger.model().parameters.contact.max_contacts = 1;
  Pressed press(finger, 2e-3);
  EXPECT_GT(raw_force(press.hand.now()), 0.1);
  EXPECT_FALSE(has(press.hand.now().status, Status::kSearchExhausted));
}

TEST(Sliding, AChangeOfTheModeForgetsTheContacts) {
  LoneFinger finger = sliding_finger(block(0.2, 0.02), 0.6);
  Pressed press(finger, 3e-3);
  ASSERT_TRUE(press.tip().contact);
  finger.model().parameters.contact.mode = ContactMode::kStatic;
  press.rest(1);
  EXPECT_EQ(raw_force(press.hand.now()), 0.0) << "static: a new contact begins when the finger moves on";
  press.hand.move(LoneFinger::pose(press.touched - 1e-3), 20);
  press.hand.move(LoneFinger::pose(press.goal), 20);
  EXPECT_GT(raw_force(press.hand.now()), 1.0);
  finger.model().parameters.contact.mode = ContactMode::kSliding;
  press.rest(2);
  EXPECT_GT(raw_force(press.hand.now()), 1.0);
}

TEST(Sliding, AtTwoHundredHertzThePathIsTheSame) {
  std::array<Vec3, 2> force;
  for (const std::size_t n : {0U, 1U}) {
    LoneFinger finger = sliding_finger(block(0.2, 0.02), 0.6);
    finger.model().parameters.rate_hz = n == 0 ? 1000.0 : 200.0;
    Pressed press(finger, 3e-3);
    const int ticks = n == 0 ? 400 : 80;
    for (int i = 1; i <= ticks; ++i) press.hand.tick(LoneFinger::pose(press.goal, 0.16 * i / ticks));
    force[n] = press.tip().force * press.tip().normal;
  }
  EXPECT_LT((force[0] - force[1]).norm(), 0.01) << "[N]";
}

}  // namespace
}  // namespace phalanx
