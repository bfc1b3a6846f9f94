// SPDX-License-Identifier: Apache-2.0
#include "phalanx/step/haptic_step.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "phalanx/core/constants.h"
#include "phalanx/mesh/primitives.h"
#include "support/count_allocations.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

using test::at;
using test::index_angles;
using test::index_gdp;
using test::index_segment;
using test::index_torque;
using test::moved;
using test::Runner;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A slab 20 mm below the straight index finger.
test::Setup floor_model() {
  return test::Setup(test::simple_hand(),
                     ObjectModel(moved(make_box(Vec3(0.06, 0.02, 0.3), 12), at(0.0, -0.030, 0.0))));
}
/// A ball under the proximal phalanx, which the whole finger can close around.
test::Setup ball_before(HandModel hand) {
  return test::Setup(std::move(hand), ObjectModel(moved(make_sphere(0.03, 2000), at(0.0, -0.028, -0.028))));
}
test::Setup ball_model() { return ball_before(test::simple_hand()); }
test::Setup coupled_ball_model() {
  return ball_before(make_hand_model(test::coupled(test::simple_parameters()), Handedness::kRight, {}, 2250));
}

TEST(Step, FreeMotionGivesNoTorqueAnywhere) {
  const test::Setup model = ball_model();
  Runner hand(model);
  const Snapshot& s = hand.move(index_angles(-0.4, 0.3, 0.2), 20);
  for (const double torque : s.torque) EXPECT_EQ(torque, 0.0);
  EXPECT_EQ(s.status, Status::kOk);
}

TEST(Step, TorquesAreTheVirtualWorkOfTheForces) {
  test::Setup model = ball_model();
  test::turn_limits_off(model);
  Runner hand(model);
  const Snapshot& s = hand.move(index_angles(0.8, 1.3, 1.5, 0.05), 100);
  ASSERT_TRUE(index_segment(s, 0).contact && index_segment(s, 1).contact);
  DigitPose pose;
  model.hand.digit_pose(1, digit_angles(s.gdp_angle, 1), pose);
  for (std::size_t i = 0; i < kJointsPerDigit; ++i) {
    double work = 0.0;  // of all forces on the finger, for a virtual turn of joint i: sum J' f
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const SegmentSnapshot& contact = index_segment(s, k);
      work += point_jacobian(pose, k, contact.point).linear[i].dot(contact.force * contact.normal);
    }
    EXPECT_NEAR(index_torque(s, static_cast<int>(i)), work, 1e-15);
  }
  EXPECT_NE(index_torque(s, 1), 0.0) << "abduction carries torque too";
}

TEST(Step, ALeftHandFeelsTheMirrorImageOfARightHand) {
  test::Setup right = ball_model();
  TriangleMesh mirrored = right.object.mesh();
  for (Vec3& v : mirrored.vertices) v.x() = -v.x();
  for (Triangle& t : mirrored.triangles) std::swap(t[1], t[2]);
  test::Setup left(test::simple_hand(Handedness::kLeft), ObjectModel(mirrored));
  Runner r(right);
  Runner l(left);
  for (int n = 0; n <= 60; ++n) {
    const JointArray q = index_angles(0.012 * n, 0.02 * n, 0.01 * n, 0.002 * n);
    const Snapshot& a = r.tick(q);
    const Snapshot& b = l.tick(q);
    for (std::size_t j = 0; j < kJoints; ++j)
      ASSERT_NEAR(a.torque[j], b.torque[j], 1e-9) << joint_name(static_cast<int>(j));
  }
  EXPECT_GT(std::abs(index_torque(r.now(), 0)), 1e-3);
}

TEST(Step, LimitsAreOnByDefault) {
  test::Setup model = floor_model();
  model.parameters.force.stiffness = 5000.0;
  Runner hand(model);
  double last = 0.0;
  bool limited = false;
  for (int n = 0; n < 400; ++n) {
    const Snapshot& s = hand.tick(index_angles(std::min(1.5, 0.01 * n)));
    EXPECT_LE(index_segment(s, 2).force, 5.0);
    EXPECT_LE(std::abs(index_torque(s, 0)), 0.5);
    EXPECT_LE(std::abs(index_torque(s, 0) - last), 10.0 / 200.0 + 1e-15);
    last = index_torque(s, 0);
    limited = limited || has(s.status, Status::kForceLimited);
  }
  EXPECT_TRUE(limited);
  EXPECT_NEAR(index_segment(hand.now(), 2).force, 5.0, 1e-12);
  EXPECT_GT(index_segment(hand.now(), 2).force_raw, 100.0);
}

TEST(Step, TheCapHoldsForTheVectorSumOfADigit) {
  test::Setup model = ball_model();
  model.parameters.force.stiffness = 3000.0;
  Runner hand(model);
  double largest = 0.0;
  int contacts = 0;
  for (int n = 0; n <= 300; ++n) {
    const double close = n <= 150 ? n / 150.0 : (300 - n) / 150.0;
    const Snapshot& s = hand.tick(index_angles(1.0 * close, 1.6 * close, 1.6 * close));
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      sum += index_segment(s, k).force * index_segment(s, k).normal;
      contacts += index_segment(s, k).contact ? 1 : 0;
    }
    largest = std::max(largest, sum.norm());
  }
  EXPECT_GT(contacts, 100);
  EXPECT_LE(largest, 5.0 + 1e-12);
  EXPECT_GT(largest, 4.9);
}

TEST(Step, TheTorqueLimitAndItsRateActAlone) {
  test::Setup model = floor_model();
  model.parameters.force.stiffness = 5000.0;
  model.parameters.stabiliser.method = Stabiliser::kNone;
  model.parameters.limits.fingertip_force_enabled = false;
  model.parameters.limits.joint_torque = 0.3;
  Runner hand(model);
  double last = 0.0;
  int rate_limited = 0;
  for (int n = 0; n < 100; ++n) {
    const Snapshot& s = hand.tick(index_angles(std::min(1.0, 0.02 * n)));
    EXPECT_LE(std::abs(index_torque(s, 0)), 0.3);
    EXPECT_LE(std::abs(index_torque(s, 0) - last), 0.05 + 1e-15);
    rate_limited += has(s.status, Status::kTorqueRateLimited) ? 1 : 0;
    last = index_torque(s, 0);
  }
  EXPECT_NEAR(last, -0.3, 1e-15) << "the floor opens the finger: against flexion";
  EXPECT_GE(rate_limited, 5);
  EXPECT_TRUE(has(hand.now().status, Status::kTorqueLimited));
}

TEST(Step, SmoothingSurvivesAContactThatHops) {
  // Press with the fingertip, then curl so that another point of the same segment touches: the force sent
  // never jumps.
  test::Setup model = floor_model();
  model.parameters.stabiliser.method = Stabiliser::kSmoothing;
  model.parameters.limits.joint_speed = kInfinity;
  Runner hand(model);
  hand.move(index_angles(0.5), 60);
  hand.move(index_angles(0.5), 60);
  double last = index_segment(hand.now(), 2).force;
  ASSERT_GT(last, 1.0);
  Vec3 first_point = index_segment(hand.now(), 2).point;
  double moved_by = 0.0;
  for (int n = 0; n < 120; ++n) {
    const double lift = n < 40 ? 0.5 - 0.5 * n / 40.0 : 0.5 * (n - 40) / 80.0;
    const SegmentSnapshot& tip = index_segment(hand.tick(index_angles(lift, 0.0, n < 40 ? 0.0 : 0.6)), 2);
    EXPECT_LE(std::abs(tip.force - last), 0.1 + 1e-12) << "tick " << n;
    last = tip.force;
    if (tip.contact) moved_by = std::max(moved_by, (tip.point - first_point).norm());
  }
  EXPECT_GT(moved_by, 1e-3) << "the contact did hop";
}

TEST(Step, WithoutContactTheForceDecaysByTheLowerBoundAtItsLastPoint) {
  test::Setup model = floor_model();
  // 0.05 N down, 0.2 N up a step
  model.parameters.stabiliser = {.method = Stabiliser::kSmoothing, .min_rate = -10.0, .max_rate = 40.0};
  model.parameters.limits.joint_speed = kInfinity;
  Runner hand(model);
  hand.move(index_angles(0.6), 60);
  const double force = index_segment(hand.move(index_angles(0.6), 60), 2).force;
  const Vec3 normal = index_segment(hand.now(), 2).normal;
  ASSERT_GT(force, 2.0);
  double expected = force;
  int steps = 0;
  while (expected > 0.0) {
    const Snapshot& s = hand.tick(index_angles(0.0));
    expected = std::max(0.0, expected - 0.05);
    EXPECT_FALSE(index_segment(s, 2).contact);
    EXPECT_NEAR(index_segment(s, 2).force, expected, 1e-12);
    if (expected > 0.0) {
      EXPECT_EQ(index_segment(s, 2).normal, normal);
      EXPECT_NE(index_torque(s, 0), 0.0);
    }
    ASSERT_LT(++steps, 200);
  }
  hand.tick(index_angles(0.0));
  EXPECT_EQ(index_segment(hand.now(), 2).force, 0.0);
  EXPECT_EQ(index_torque(hand.now(), 0), 0.0) << "zero torque in free motion, after the decay";
}

TEST(Step, ANanOrInfiniteAngleHoldsItsLastGoodValue) {
  const test::Setup model = floor_model();
  Runner hand(model);
  hand.move(index_angles(0.2), 20);
  JointArray bad = index_angles(0.2);
  bad[joint_index(1, 0)] = kNan;
  bad[joint_index(2, 2)] = kInfinity;
  const Snapshot& s = hand.tick(bad);
  EXPECT_TRUE(has(s.status, Status::kSampleNotFinite));
  EXPECT_EQ(s.hcp_angle, index_angles(0.2));
}

TEST(Step, AJumpIsSlewedAtTheFastestThatAJointMoves) {
  const test::Setup model = floor_model();  // 40 rad/s at 200 Hz: 0.2 rad a tick
  Runner hand(model);
  hand.tick(index_angles(0.0, 0.1));
  const Snapshot& s = hand.tick(index_angles(0.0, 1.4));
  EXPECT_TRUE(has(s.status, Status::kSampleJump));
  EXPECT_NEAR(s.hcp_angle[joint_index(1, 2)], 0.3, 1e-15);
}

// 10 rad/s: 0.05 rad in a period of 5 ms, 0.2 in 20 ms, and 0.5 after any gap, for the slew counts 50 ms at
// most.
TEST(Step, AJumpAfterAGapIsSlewedByTheGapsLengthUpToFiftyMilliseconds) {
  test::Setup model = floor_model();
  model.parameters.limits.joint_speed = 10.0;
  const std::pair<double, double> cases[] = {
      {0.001, 0.05}, {0.005, 0.05}, {0.02, 0.2}, {0.05, 0.5}, {3.0, 0.5}};
  for (const auto& [gap, allowed] : cases) {
    HapticState state(model, model.parameters);
    step(model, model.parameters, Sample{1.0, index_angles(0.0)}, state);
    const Status status = step(model, model.parameters, Sample{1.0 + gap, index_angles(0.0, 1.4)}, state);
    EXPECT_TRUE(has(status, Status::kSampleJump)) << gap;
    EXPECT_NEAR(state.snapshot().hcp_angle[joint_index(1, 2)], allowed, 1e-12) << gap;
  }
}

TEST(Step, AnAngleOutsideTheAnatomyIsClamped) {
  const test::Setup model = floor_model();
  Runner hand(model);
  const Snapshot& s = hand.move(index_angles(-3.0), 50);
  EXPECT_TRUE(has(s.status, Status::kSampleOutOfRange));
  EXPECT_EQ(s.hcp_angle[joint_index(1, 0)], -0.5);
}

TEST(Step, TimeThatDoesNotIncreaseIsReportedAndTheSampleNotUsed) {
  const test::Setup model = floor_model();
  HapticState state(model, model.parameters);
  step(model, model.parameters, Sample{1.0, index_angles(0.1)}, state);
  for (const double time : {1.0, 0.5, kNan, -kInfinity}) {
    const Status status = step(model, model.parameters, Sample{time, index_angles(0.15)}, state);
    EXPECT_TRUE(has(status, Status::kTimeNotIncreasing));
    EXPECT_EQ(state.snapshot().hcp_angle, index_angles(0.1));
    EXPECT_EQ(state.snapshot().time_s, 1.0) << "of the last sample that was used";
  }
}

TEST(Step, AClockThatRestartsIsFollowedAgainAfterFiveSamples) {
  const test::Setup model = floor_model();
  HapticState state(model, model.parameters);
  step(model, model.parameters, Sample{1e9, index_angles(0.0)}, state);  // one stamp far in the future
  for (int n = 1; n <= 4; ++n)
    EXPECT_TRUE(has(step(model, model.parameters, Sample{0.005 * n, index_angles(0.1)}, state),
                    Status::kTimeNotIncreasing));
  for (int n = 5; n <= 10; ++n)
    EXPECT_FALSE(has(step(model, model.parameters, Sample{0.005 * n, index_angles(0.1)}, state),
                     Status::kTimeNotIncreasing));
  EXPECT_EQ(state.snapshot().hcp_angle, index_angles(0.1));
}

TEST(Step, WithoutAGoodSampleForFiftyMillisecondsForcesDecayToZero) {
  const test::Setup model = floor_model();
  for (const bool bad_clock : {true, false}) {
    HapticState state(model, model.parameters);
    double time = 0.0;
    for (int n = 0; n <= 120; ++n)
      step(model, model.parameters, Sample{time += 0.005, index_angles(std::min(0.5, 0.01 * n))}, state);
    ASSERT_GT(index_segment(state.snapshot(), 2).force, 2.0);
    const double before = index_segment(state.snapshot(), 2).force;
    for (int n = 1; n <= 200; ++n) {
      JointArray angle = index_angles(0.5);
      if (!bad_clock) angle[joint_index(1, 3)] = kNan;
      const Status status =
          step(model, model.parameters, Sample{bad_clock ? 0.0 : time += 0.005, angle}, state);
      EXPECT_EQ(has(status, Status::kSampleStale), n > 10) << "tick " << n;
      if (n > 10) continue;
      EXPECT_EQ(index_segment(state.snapshot(), 2).force, before);
    }
    EXPECT_EQ(index_segment(state.snapshot(), 2).force, 0.0);
    for (const double torque : state.snapshot().torque) EXPECT_EQ(torque, 0.0);
  }
}

TEST(Step, ABadFirstSampleDoesNotHideThatADigitStartsInside) {
  const test::Setup model = floor_model();
  JointArray one_nan = index_angles(0.5);
  one_nan[joint_index(1, 3)] = kNan;
  JointArray all_nan;
  all_nan.fill(kNan);
  for (const Sample& first :
       {Sample{0.005, all_nan}, Sample{kNan, index_angles(0.5)}, Sample{0.005, one_nan}}) {
    HapticState state(model, model.parameters);
    step(model, model.parameters, first, state);
    for (int n = 2; n < 50; ++n) {
      const Status status = step(model, model.parameters, Sample{0.005 * n, index_angles(0.5)}, state);
      EXPECT_TRUE(has(status, Status::kStartInside)) << n;
      EXPECT_EQ(index_segment(state.snapshot(), 2).force, 0.0) << n;
    }
  }
}

TEST(Step, WhateverArrivesTheCommandIsFiniteAndWithinItsLimits) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> u(-2.0, 3.0);
  test::Setup model = ball_model();
  model.parameters.force.stiffness = 1e5;
  const std::array<double, 6> wild = {kNan, kInfinity, -kInfinity, 1e300, -1e300, 1e-310};
  const std::array<double, 5> wild_times = {kNan, kInfinity, -kInfinity, -1.0, 0.0};
  for (const ForceLaw law : {ForceLaw::kHooke, ForceLaw::kKelvinVoigt, ForceLaw::kHuntCrossley,
                             ForceLaw::kDuffing, ForceLaw::kLinearThenCubic}) {
    model.parameters.force.law = law;
    HapticState state(model, model.parameters);
    JointArray last{};
    int used = 0;
    int pushed = 0;
    for (int n = 1; n <= 400; ++n) {
      Sample sample{0.005 * n, {}};
      for (double& angle : sample.angle)
        angle = random() % 64 == 0 ? wild[random() % wild.size()] : u(random);
      if (random() % 10 == 0) sample.time_s = wild_times[random() % wild_times.size()];
      const Status status = step(model, model.parameters, sample, state);
      used += has(status, Status::kTimeNotIncreasing) ? 0 : 1;
      for (int d = 0; d < kDigits; ++d) {
        Vec3 sum = Vec3::Zero();
        for (int k = 0; k < kSegmentsPerDigit; ++k) {
          const SegmentSnapshot& segment =
              state.snapshot().segment[static_cast<std::size_t>(segment_index(d, k))];
          ASSERT_TRUE(std::isfinite(segment.force)) << "seed 13 tick " << n;
          ASSERT_GE(segment.force, 0.0);
          ASSERT_LE(segment.force, model.parameters.limits.fingertip_force);
          sum += segment.force * segment.normal;
          pushed += segment.force > 0.0 ? 1 : 0;
        }
        ASSERT_LE(sum.norm(), model.parameters.limits.fingertip_force + 1e-12) << "seed 13 tick " << n;
      }
      for (std::size_t j = 0; j < kJoints; ++j) {
        const double torque = state.snapshot().torque[j];
        ASSERT_TRUE(std::isfinite(torque)) << "seed 13 tick " << n;
        ASSERT_LE(std::abs(torque), model.parameters.limits.joint_torque);
        ASSERT_LE(std::abs(torque - last[j]),
                  model.parameters.limits.torque_rate / model.parameters.rate_hz + 1e-15);
        ASSERT_TRUE(std::isfinite(state.snapshot().gdp_angle[j]));
      }
      last = state.snapshot().torque;
    }
    EXPECT_GT(used, 300);
    EXPECT_GT(pushed, 0);
  }
}

TEST(Step, AllocatesNothing) {
  struct Case {
    GdpMethod method;
    ContactMode mode;
    bool with_coupling;
  };
  for (const auto& [method, mode, with_coupling] :
       {Case{GdpMethod::kContinuous, ContactMode::kStatic, false},
        Case{GdpMethod::kTrajectory, ContactMode::kStatic, false},
        Case{GdpMethod::kContinuous, ContactMode::kStatic, true},
        Case{GdpMethod::kContinuous, ContactMode::kSliding, false},
        Case{GdpMethod::kContinuous, ContactMode::kSliding, true}}) {
    test::Setup model = with_coupling ? coupled_ball_model() : ball_model();
    model.parameters.contact.method = method;
    model.parameters.contact.mode = mode;
    HapticState state(model, model.parameters);
    double time = 0.0;
    std::size_t contacts = 0;
    const std::size_t before = test::allocations();
    for (int n = 0; n <= 400; ++n) {
      const double close = n <= 200 ? n / 200.0 : (400 - n) / 200.0;
      step(model, model.parameters,
           Sample{time += 0.005, index_angles(1.0 * close, 1.6 * close, 1.6 * close, 0.1 * close)}, state);
      contacts += index_segment(state.snapshot(), 0).contact ? 1U : 0U;
    }
    EXPECT_EQ(test::allocations() - before, 0U);
    EXPECT_GT(contacts, 50U);
  }
  const std::size_t before = test::allocations();
  auto probe = std::make_unique<int>(1);
  EXPECT_GT(test::allocations(), before) << "the counter counts";
}

// Many trials share one model: a state has no copy of the object's triangles or of what is made from them.
TEST(HapticState, TakesNoMemoryForTheObjectsTriangles) {
  const auto bytes_with = [](int triangles) {
    const test::Setup model(test::simple_hand(),
                            ObjectModel(moved(make_sphere(0.03, triangles), at(0.0, -0.028, -0.028))));
    const std::size_t before = test::bytes_of_this_thread();
    const HapticState state(model, model.parameters);
    return test::bytes_of_this_thread() - before;
  };
  const std::size_t coarse = bytes_with(2000);
  EXPECT_EQ(bytes_with(50'000), coarse);
  EXPECT_LT(coarse, 4U << 20) << "lists of pairs";
}

TEST(Step, SameSamplesSameBits) {
  const test::Setup model = ball_model();
  Runner a(model);
  Runner b(model);
  for (int n = 0; n < 100; ++n) {
    const JointArray q = index_angles(0.012 * n, 0.016 * n, 0.016 * n, 0.001 * n);
    EXPECT_EQ(a.tick(q).torque, b.tick(q).torque);
    EXPECT_EQ(a.now().gdp_angle, b.now().gdp_angle);
  }
}

}  // namespace
}  // namespace phalanx
