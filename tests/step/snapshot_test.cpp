// SPDX-License-Identifier: Apache-2.0
// What a step writes down of a contact, worked out again from the poses that it writes down beside it.
#include <gtest/gtest.h>

#include <cmath>

#include "phalanx/core/constants.h"
#include "phalanx/step/haptic_step.h"
#include "support/simple_hand.h"
#include "support/stabilised_hands.h"

namespace phalanx {
namespace {

constexpr std::size_t kTip = 3 * test::kIndex + 2;  ///< the index finger's distal segment

/// Into the floor, along it, and out again: `n` from 0 to 240.
JointArray press_and_leave(int n) {
  const double down = n < 80 ? 0.4 * n / 80.0 : n < 160 ? 0.4 : 0.4 * (240 - n) / 80.0;
  const double along = n < 80 ? 0.0 : n < 160 ? 0.3 * (n - 80) / 80.0 : 0.3;
  return test::index_angles(down, 0.0, 0.0, along);
}

TEST(StepSnapshot, CountsItsTicksFromOne) {
  const test::Setup model = test::floor_model(Stabiliser::kNone);
  HapticState state(model, model.parameters);
  EXPECT_EQ(state.snapshot().tick, 0U);
  for (std::uint64_t n = 1; n <= 3; ++n) {
    step(model, model.parameters, Sample{0.005 * static_cast<double>(n), JointArray{}}, state);
    EXPECT_EQ(state.snapshot().tick, n);
    EXPECT_EQ(state.snapshot().time_s, 0.005 * static_cast<double>(n));
  }
}

// A completed angle moves the hand like a measured one: only the mark differs.
TEST(StepSnapshot, PassesTheOriginOfEachAngleAndNothingDependsOnIt) {
  const test::Setup model = test::floor_model(Stabiliser::kNone);
  HapticState plain(model, model.parameters);
  HapticState marked(model, model.parameters);
  for (int n = 1; n <= 160; ++n) {
    Sample sample{.time_s = 0.005 * n, .angle = press_and_leave(n)};
    step(model, model.parameters, sample, plain);
    sample.angle_origin[4] = AngleOrigin::kCompleted;
    sample.angle_origin[19] = AngleOrigin::kFixed;
    step(model, model.parameters, sample, marked);
    EXPECT_EQ(plain.snapshot().angle_origin, AngleOrigins{});
    EXPECT_EQ(marked.snapshot().angle_origin, sample.angle_origin);
    EXPECT_EQ(marked.snapshot().torque, plain.snapshot().torque) << n;
    EXPECT_EQ(marked.snapshot().gdp_angle, plain.snapshot().gdp_angle) << n;
  }
  EXPECT_GT(plain.snapshot().segment[kTip].force, 0.0);
}

// The hand stands 20 mm along +Z, its index finger open at -0.2 rad, which is towards +Y: the distal
// segment's joint is 40 + 25 mm from the knuckle.
TEST(StepSnapshot, IsTheOpenHandBeforeTheFirstStep) {
  HandParameters parameters = test::simple_parameters();
  parameters.open_angle = test::index_angles(-0.2);
  const Pose X_WH = test::at(0.0, 0.0, 0.020);
  const test::Setup model(
      make_hand_model(parameters, Handedness::kRight, X_WH, 2250),
      ObjectModel(test::moved(make_box(Vec3(0.06, 0.02, 0.3), 12), test::at(0.0, -0.030, 0.0))));
  const HapticState state(model, model.parameters);
  const Snapshot& now = state.snapshot();
  EXPECT_EQ(now.time_s, 0.0);
  EXPECT_EQ(now.status, Status::kOk);
  EXPECT_EQ(now.hcp_angle, parameters.open_angle);
  EXPECT_EQ(now.gdp_angle, parameters.open_angle);
  const Vec3 tip(0.0, 0.065 * std::sin(0.2), 0.020 - 0.065 * std::cos(0.2));
  for (const auto& pose : {now.hcp_pose, now.gdp_pose}) {
    EXPECT_LT((pose[kTip].p - tip).norm(), 1e-15);
    EXPECT_EQ(pose[kPalm].p, X_WH.p);
  }
  HandPoses open_hand;
  model.hand.poses(parameters.open_angle, open_hand);
  for (std::size_t s = 0; s < kPalm; ++s) {
    const Vec3& place = open_hand.digit[s / kSegmentsPerDigit].segment[s % kSegmentsPerDigit].p;
    EXPECT_EQ(now.hcp_pose[s].p, place) << s;
    EXPECT_EQ(now.gdp_pose[s].p, place) << s;
  }
}

TEST(StepSnapshot, ASegmentThatTouchesNothingHasNeitherPointNorNormal) {
  const test::Setup model = test::floor_model(Stabiliser::kNone);
  test::Runner hand(model);
  for (const SegmentSnapshot& segment : hand.tick(JointArray{}).segment) {
    EXPECT_EQ(segment.point, Vec3::Zero());
    EXPECT_EQ(segment.normal, Vec3::Zero());
  }
}

// Hooke's law and nothing behind it: the force is 500 N/m times the depth that is written down, which is
// never negative, also in the ticks in which a contact is there and not deep.
TEST(StepSnapshot, TheDepthIsTheForceOverTheStiffnessAndNeverNegative) {
  test::Setup model = test::floor_model(Stabiliser::kNone);
  test::turn_limits_off(model);
  model.parameters.force.stiffness = 500.0;
  test::Runner hand(model);
  int deep = 0;
  int not_deep = 0;
  for (int n = 0; n <= 240; ++n) {
    const SegmentSnapshot& tip = hand.tick(press_and_leave(n)).segment[kTip];
    EXPECT_GE(tip.depth, 0.0) << n;
    EXPECT_NEAR(tip.force_raw, 500.0 * tip.depth, 1e-12) << n;
    deep += tip.contact && tip.depth > 0.0 ? 1 : 0;
    not_deep += tip.contact && tip.force_raw == 0.0 ? 1 : 0;
  }
  EXPECT_GT(deep, 100);
  EXPECT_GT(not_deep, 0) << "or the test has not tested that";
}

// The floor's normal is +Y. The contact's point lies on the shown finger; the same material point of the
// measured one is elsewhere, and how far in the floor's plane is what has slid.
TEST(StepSnapshot, WhatHasSlidIsTheWayInThePlaneOfTheContact) {
  const test::Setup model = test::floor_model(Stabiliser::kNone);
  test::Runner hand(model);
  double largest = 0.0;
  int seen = 0;
  for (int n = 0; n <= 240; ++n) {
    const Snapshot& now = hand.tick(press_and_leave(n));
    const SegmentSnapshot& tip = now.segment[kTip];
    if (!tip.contact || tip.normal != Vec3::UnitY()) continue;
    const Vec3 apart = now.hcp_pose[kTip] * (now.gdp_pose[kTip].inverse() * tip.point) - tip.point;
    EXPECT_NEAR(tip.slid, std::hypot(apart.x(), apart.z()), 1e-9) << n;
    EXPECT_GT(std::abs(apart.y()) + 1e-9, tip.depth);
    largest = std::max(largest, tip.slid);
    ++seen;
  }
  EXPECT_GT(seen, 100);
  EXPECT_GT(largest, 1e-3);
}

// Under smoothing a force is still sent after the finger has left: at the same material point, which goes
// with the shown finger.
TEST(StepSnapshot, AForceThatDecaysActsAtItsMaterialPoint) {
  test::Setup model = test::floor_model(Stabiliser::kSmoothing);
  model.parameters.limits.joint_speed = kInfinity;
  test::Runner hand(model);
  for (int n = 0; n <= 150; ++n) hand.tick(press_and_leave(n));
  const SegmentSnapshot before = hand.now().segment[kTip];
  ASSERT_TRUE(before.contact);
  ASSERT_GT(before.force, 1.0);
  const Vec3 p_S = hand.now().gdp_pose[kTip].inverse() * before.point;
  int decaying = 0;
  for (int n = 1; n <= 40; ++n) {
    const Snapshot& now = hand.tick(test::index_angles(0.1 - 0.01 * n));
    const SegmentSnapshot& tip = now.segment[kTip];
    if (tip.contact || tip.force == 0.0) continue;
    EXPECT_LT((tip.point - now.gdp_pose[kTip] * p_S).norm(), 1e-12) << n;
    EXPECT_EQ(tip.normal, before.normal);
    EXPECT_EQ(tip.depth, 0.0);
    ++decaying;
  }
  EXPECT_GT(decaying, 5);
}

}  // namespace
}  // namespace phalanx
