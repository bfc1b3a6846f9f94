// SPDX-License-Identifier: Apache-2.0
// Every stabiliser in the whole step.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "phalanx/contact/gdp.h"
#include "phalanx/core/constants.h"
#include "phalanx/force/force_stage.h"
#include "phalanx/force/local_wall.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"
#include "support/all_stabilisers.h"
#include "support/count_allocations.h"
#include "support/simple_hand.h"
#include "support/stabilised_hands.h"

namespace phalanx {
namespace {

using test::at;
using test::ball_model;
using test::floor_model;
using test::grasp;
using test::index_angles;
using test::kIndex;
using test::moved;
using test::Runner;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

TEST(StabiliserStep, EveryMethodSendsNothingBeforeAndAfterAGrasp) {
  for (const Stabiliser method : test::kAllStabilisers) {
    const test::Setup model = ball_model(method);
    Runner hand(model);
    double largest = 0.0;
    for (int n = 0; n <= 300; ++n) {
      for (const SegmentSnapshot& s : hand.tick(grasp(n)).segment) largest = std::max(largest, s.force);
    }
    EXPECT_GT(largest, 0.5) << static_cast<int>(method);
    for (int n = 0; n < 400; ++n) hand.tick(grasp(300));
    for (const double torque : hand.now().torque) EXPECT_EQ(torque, 0.0) << static_cast<int>(method);
    for (const SegmentSnapshot& s : hand.now().segment) EXPECT_EQ(s.force, 0.0) << static_cast<int>(method);
  }
}

// At 10 kN/s, 50 N a step, no force is bounded: the commands are those of "none", up to rounding.
TEST(StabiliserStep, ABoundThatIsNeverReachedSendsWhatNoneSends) {
  const test::Setup none = ball_model(Stabiliser::kNone);
  for (const Stabiliser method : {Stabiliser::kSmoothing, Stabiliser::kRiseOnly}) {
    test::Setup wide = ball_model(method);
    wide.parameters.stabiliser.min_rate = -1e4;
    wide.parameters.stabiliser.max_rate = 1e4;
    Runner a(none);
    Runner b(wide);
    for (int n = 0; n <= 300; ++n) {
      const JointArray expected = a.tick(grasp(n)).torque;
      const JointArray& torque = b.tick(grasp(n)).torque;
      for (std::size_t j = 0; j < torque.size(); ++j) ASSERT_NEAR(torque[j], expected[j], 1e-12) << n;
    }
  }
}

// Whatever is measured, every method stays within the caps, and the walls do whatever the controller asks of
// them.
TEST(StabiliserStep, WhateverArrivesEveryMethodStaysWithinItsLimits) {
  const std::array<double, 6> wild = {kNotANumber, kInfinity, -kInfinity, 1e300, -1e300, 1e-310};
  for (const Stabiliser method : test::kAllStabilisers) {
    for (const ForceLaw law : {ForceLaw::kHooke, ForceLaw::kHuntCrossley}) {
      std::mt19937_64 random(13);
      std::uniform_real_distribution<double> u(-2.0, 3.0);
      test::Setup model = ball_model(method);
      model.parameters.force.law = law;
      model.parameters.force.stiffness = 1e4;
      model.parameters.stabiliser.turn_rate = 20.0;
      model.parameters.oscillation.reaction = OscillationReaction::kHalve;
      HapticState state(model, model.parameters);
      JointArray last{};
      int pushed = 0;
      int walls = 0;
      for (int n = 1; n <= 150; ++n) {
        Sample sample{.time_s = 0.005 * n};
        for (double& angle : sample.angle)
          angle = random() % 64 == 0 ? wild[random() % wild.size()] : u(random);
        if (random() % 10 == 0) sample.time_s = wild[random() % wild.size()];
        for (double& torque : sample.measured_torque) torque = wild[random() % wild.size()];
        step(model, model.parameters, sample, state);
        const Snapshot& now = state.snapshot();
        for (int d = 0; d < kDigits; ++d) {
          Vec3 sum = Vec3::Zero();
          Vec3 wall_sum = Vec3::Zero();
          const DigitAngles q_ref = digit_angles(now.hcp_angle, d);
          DigitAngles q{};
          for (double& angle : q) angle = random() % 8 == 0 ? wild[random() % wild.size()] : u(random);
          for (int k = 0; k < kSegmentsPerDigit; ++k) {
            const std::size_t s = static_cast<std::size_t>(segment_index(d, k));
            const SegmentSnapshot& segment = now.segment[s];
            ASSERT_TRUE(std::isfinite(segment.force)) << "method " << static_cast<int>(method) << " seed 13";
            ASSERT_GE(segment.force, 0.0);
            ASSERT_LE(segment.force, model.parameters.limits.fingertip_force);
            ASSERT_TRUE(segment.normal.allFinite());
            sum += segment.force * segment.normal;
            pushed += segment.force > 0.0 ? 1 : 0;
            const double force = local_wall_force(now.wall[s], q, q_ref);
            ASSERT_TRUE(std::isfinite(force) && force >= 0.0 && force <= now.wall[s].force_max);
            wall_sum += force * segment.normal;
            walls += now.wall[s].active ? 1 : 0;
          }
          ASSERT_LE(sum.norm(), model.parameters.limits.fingertip_force + 1e-12);
          ASSERT_LE(wall_sum.norm(), model.parameters.limits.fingertip_force + 1e-9) << "seed 13 tick " << n;
        }
        for (std::size_t j = 0; j < kJoints; ++j) {
          ASSERT_TRUE(std::isfinite(now.torque[j]));
          ASSERT_LE(std::abs(now.torque[j]), model.parameters.limits.joint_torque);
          ASSERT_LE(std::abs(now.torque[j] - last[j]),
                    model.parameters.limits.torque_rate / model.parameters.rate_hz + 1e-15);
          ASSERT_FALSE(std::isinf(now.measured_torque[j]));
        }
        ASSERT_GE(now.stiffness_factor, 1.0 / 1024.0);
        ASSERT_LE(now.stiffness_factor, 1.0);
        last = now.torque;
      }
      EXPECT_GT(pushed, 0) << static_cast<int>(method);
      EXPECT_EQ(walls > 0, method == Stabiliser::kLocalWall);
    }
  }
}

TEST(StabiliserStep, AllocatesNothing) {
  for (const Stabiliser method : test::kAllStabilisers) {
    test::Setup model = ball_model(method);
    model.parameters.oscillation.reaction = OscillationReaction::kHalve;
    HapticState state(model, model.parameters);
    const std::size_t before = test::allocations();
    for (int n = 0; n <= 300; ++n)
      step(model, model.parameters, Sample{.time_s = 0.005 * (n + 1), .angle = grasp(n)}, state);
    EXPECT_EQ(test::allocations() - before, 0U) << static_cast<int>(method);
  }
}

/// A step of the force stage alone, for one contact of the index fingertip at 2 mm whose normal is `normal`.
class LoneContact {
 public:
  explicit LoneContact(const test::Setup& model)
      : model_(model), contacts_({model.hand, model.trees(), model.object, model.parameters.contact}) {
    model.hand.poses(JointArray{}, hcp_);
    contacts_.poses = hcp_;
  }
  const SegmentForce& press(const Vec3& normal) {
    const std::size_t tip = static_cast<std::size_t>(segment_index(kIndex, 2));
    ContactRecord& record = contacts_.record[tip];
    record.active = true;
    record.depth = 2e-3;
    record.n_c = normal;
    record.force_normal = normal;
    record.p_S = Vec3::Zero();
    record.p_hcp = hcp_.digit[kIndex].segment[2].p;
    compute_command(model_.parameters, contacts_, hcp_, false, state_);
    return state_.segment[tip];
  }

 private:
  const test::Setup& model_;
  GdpState contacts_;
  HandPoses hcp_;
  ForceState state_;
};

// A normal that hops from +y to +x: 90 deg/s are 0.45 degrees a step, so that it is there after 200 steps; 2
// mm into 500 N/m is 1 N all the while. The first normal is taken at once, and without the method every one.
TEST(StabiliserStep, TheDirectionOfAForceTurnsNoFasterThanItsBound) {
  const test::Setup model = floor_model(Stabiliser::kDirection);
  LoneContact contact(model);
  EXPECT_EQ(contact.press(Vec3::UnitY()).normal, Vec3::UnitY());
  for (int n = 1; n <= 199; ++n) {
    const SegmentForce& force = contact.press(Vec3::UnitX());
    ASSERT_NEAR(force.normal.x(), std::sin(n * std::numbers::pi / 400.0), 1e-12) << n;
    ASSERT_DOUBLE_EQ(force.sent, 1.0);
  }
  EXPECT_NEAR((contact.press(Vec3::UnitX()).normal - Vec3::UnitX()).norm(), 0.0, 1e-9);
  const test::Setup plain = floor_model(Stabiliser::kNone);
  LoneContact free(plain);
  free.press(Vec3::UnitY());
  EXPECT_EQ(free.press(Vec3::UnitX()).normal, Vec3::UnitX());
}

// A scene may turn it off.
TEST(HapticState, TakesAnInfiniteJointSpeed) {
  test::Setup model = floor_model(Stabiliser::kSmoothing);
  model.parameters.limits.joint_speed = kInfinity;
  Runner hand(model);
  hand.tick(index_angles(-0.4));
  EXPECT_EQ(hand.tick(index_angles(0.1)).hcp_angle, index_angles(0.1));
  EXPECT_FALSE(has(hand.now().status, Status::kSampleJump));
}

}  // namespace
}  // namespace phalanx
