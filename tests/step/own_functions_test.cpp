// SPDX-License-Identifier: Apache-2.0
// A force law and a stabiliser of the caller, in the whole step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "phalanx/core/index.h"
#include "phalanx/force/force_law.h"
#include "phalanx/step/haptic_step.h"
#include "support/all_stabilisers.h"
#include "support/count_allocations.h"
#include "support/simple_hand.h"
#include "support/stabilised_hands.h"

namespace phalanx {
namespace {

using test::ball_model;
using test::grasp;
using test::Runner;

constexpr int kOwnTicks = 300;

double own_linear(void* user, double depth, double /*speed*/) noexcept {
  return *static_cast<const double*>(user) * depth;
}
double own_damped(void* user, double depth, double speed) noexcept {
  return std::max(0.0, *static_cast<const double*>(user) * depth + 2.0 * speed);
}
double own_constant(void* user, double /*depth*/, double /*speed*/) noexcept {
  return *static_cast<const double*>(user);
}
double own_unchanged(void* /*user*/, const StabiliserInput& input, StabiliserMemory& /*memory*/) noexcept {
  return input.force;
}
double sent_always(void* user, const StabiliserInput& /*input*/, StabiliserMemory& /*memory*/) noexcept {
  return *static_cast<const double*>(user);
}
/// S2 eq. (4) with the rise of 0.1 N a step, from a last force that it keeps itself.
double rise_by_memory(void* /*user*/, const StabiliserInput& input, StabiliserMemory& memory) noexcept {
  return memory.own[0] = std::min(input.force, memory.own[0] + 0.1);
}

void expect_same_grasp(const test::Setup& a, const test::Setup& b) {
  Runner one(a);
  Runner other(b);
  double largest = 0.0;
  for (int n = 0; n <= kOwnTicks; ++n) {
    const Snapshot& expected = one.tick(grasp(n));
    const Snapshot& is = other.tick(grasp(n));
    ASSERT_EQ(is.status, expected.status) << n;
    ASSERT_EQ(is.torque, expected.torque) << n;
    for (std::size_t s = 0; s < expected.segment.size(); ++s) {
      ASSERT_EQ(is.segment[s].force_raw, expected.segment[s].force_raw) << n;
      ASSERT_EQ(is.segment[s].force, expected.segment[s].force) << n;
      largest = std::max(largest, expected.segment[s].force);
    }
  }
  EXPECT_GT(largest, 0.5) << "the hand must grasp";
}

double largest_sent(const Snapshot& snapshot) {
  double largest = 0.0;
  for (const SegmentSnapshot& segment : snapshot.segment) largest = std::max(largest, segment.force);
  return largest;
}

void expect_no_force_and_the_status(const test::Setup& own) {
  Runner hand(own);
  bool stated = false;
  for (int n = 0; n <= kOwnTicks; ++n) {
    const Snapshot& now = hand.tick(grasp(n));
    stated = stated || has(now.status, Status::kCommandNotFinite);
    ASSERT_EQ(largest_sent(now), 0.0) << n;
    for (const double torque : now.torque) ASSERT_EQ(torque, 0.0) << n;
  }
  EXPECT_TRUE(stated);
}

TEST(OwnForceLaw, ThatComputesHookesLawGivesItsBitsWithEveryStabiliser) {
  for (const Stabiliser method : test::kAllStabilisers) {
    if (method == Stabiliser::kLocalWall) continue;  // the slope is measured there, see below
    const test::Setup hooke = ball_model(method);
    test::Setup own = ball_model(method);
    double stiffness = own.parameters.force.stiffness;
    own.parameters.force.law = ForceLaw::kOwn;
    own.parameters.force.own = {.function = own_linear, .user = &stiffness};
    SCOPED_TRACE(static_cast<int>(method));
    expect_same_grasp(hooke, own);
  }
}

TEST(OwnForceLaw, GetsTheLowPassedClosingSpeed) {
  test::Setup voigt = ball_model(Stabiliser::kNone);
  test::Setup own = ball_model(Stabiliser::kNone);
  voigt.parameters.force.law = ForceLaw::kKelvinVoigt;
  double stiffness = own.parameters.force.stiffness;
  own.parameters.force.law = ForceLaw::kOwn;
  own.parameters.force.own = {.function = own_damped, .user = &stiffness};
  ASSERT_EQ(voigt.parameters.force.damping, 2.0);
  expect_same_grasp(voigt, own);
}

TEST(OwnForceLaw, HasItsSlopeMeasuredForLocalWalls) {
  double stiffness = 700.0;
  const ForceLawParameters law{.law = ForceLaw::kOwn, .own = {.function = own_linear, .user = &stiffness}};
  EXPECT_NEAR(law_slope(law, 2e-3), 700.0, 1e-6);
  EXPECT_NEAR(law_slope(law, -1e-3), 700.0, 1e-6) << "below the surface its slope there";
  stiffness = -700.0;
  EXPECT_EQ(law_slope(law, 2e-3), 0.0);
  EXPECT_EQ(law_force(law, 2e-3, 0.0), 0.0) << "no law pulls";
  stiffness = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(law_slope(law, 2e-3), 0.0);
  EXPECT_EQ(law_force(law, 0.0, 0.0), 0.0) << "not called without depth";
}

TEST(OwnForceLaw, IsCappedAsEveryOther) {
  test::Setup own = ball_model(Stabiliser::kNone);
  double newtons = 1e6;
  own.parameters.force.law = ForceLaw::kOwn;
  own.parameters.force.own = {.function = own_constant, .user = &newtons};
  Runner hand(own);
  bool limited = false;
  for (int n = 0; n <= kOwnTicks; ++n) {
    const Snapshot& now = hand.tick(grasp(n));
    limited = limited || has(now.status, Status::kForceLimited);
    ASSERT_LE(largest_sent(now), own.parameters.limits.fingertip_force);
    for (const double torque : now.torque) ASSERT_LE(std::abs(torque), own.parameters.limits.joint_torque);
  }
  EXPECT_TRUE(limited);
}

TEST(OwnForceLaw, ThatIsNotFiniteGivesNoForceAndStatesIt) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    test::Setup own = ball_model(Stabiliser::kNone);
    double newtons = bad;
    own.parameters.force.law = ForceLaw::kOwn;
    own.parameters.force.own = {.function = own_constant, .user = &newtons};
    SCOPED_TRACE(bad);
    expect_no_force_and_the_status(own);
  }
}

TEST(OwnStabiliser, ThatChangesNothingGivesTheBitsOfNone) {
  const test::Setup none = ball_model(Stabiliser::kNone);
  test::Setup own = ball_model(Stabiliser::kOwn);
  own.parameters.stabiliser.own = {.function = own_unchanged, .user = nullptr};
  expect_same_grasp(none, own);
}

// 20 N/s at 200 Hz are 0.1 N a step. While a contact lasts, the force that the function keeps is the one sent.
TEST(OwnStabiliser, KeepsItsStateInTheContactsMemory) {
  StabiliserParameters own{.method = Stabiliser::kOwn, .own = {.function = rise_by_memory, .user = nullptr}};
  StabiliserMemory memory;
  StabiliserInput input{.force = 1.0, .depth = 2e-3, .pressing = true};
  for (int n = 1; n <= 12; ++n)
    EXPECT_NEAR(stabilised_force(own, input, memory), std::min(1.0, 0.1 * n), 1e-15) << n;
  input.pressing = false;
  EXPECT_EQ(stabilised_force(own, input, memory), 0.0) << "without contact at once";
  input.pressing = true;
  EXPECT_NEAR(stabilised_force(own, input, memory), 0.1, 1e-15) << "a new contact begins without memory";
}

TEST(OwnStabiliser, IsCappedAndNeverPulls) {
  for (double newtons : {1e6, -3.0}) {
    test::Setup own = ball_model(Stabiliser::kOwn);
    own.parameters.stabiliser.own = {.function = sent_always, .user = &newtons};
    Runner hand(own);
    double largest = 0.0;
    for (int n = 0; n <= kOwnTicks; ++n) largest = std::max(largest, largest_sent(hand.tick(grasp(n))));
    EXPECT_EQ(largest, newtons > 0.0 ? own.parameters.limits.fingertip_force : 0.0);
    for (int n = 0; n < 100; ++n) hand.tick(grasp(kOwnTicks));
    EXPECT_EQ(largest_sent(hand.now()), 0.0) << "the hand has left";
  }
}

TEST(OwnStabiliser, ThatIsNotFiniteGivesNoForceAndStatesIt) {
  test::Setup own = ball_model(Stabiliser::kOwn);
  double bad = std::numeric_limits<double>::quiet_NaN();
  own.parameters.stabiliser.own = {.function = sent_always, .user = &bad};
  expect_no_force_and_the_status(own);
}

TEST(OwnFunctions, AreRequiredWhereTheyAreChosen) {
  const test::Setup model = ball_model(Stabiliser::kNone);
  HapticParameters law = model.parameters;
  law.force.law = ForceLaw::kOwn;
  EXPECT_THROW(HapticState(model, law), std::invalid_argument);
  HapticParameters stabiliser = model.parameters;
  stabiliser.stabiliser.method = Stabiliser::kOwn;
  EXPECT_THROW(HapticState(model, stabiliser), std::invalid_argument);
}

TEST(OwnFunctions, LeaveTheStepWithoutAllocations) {
  test::Setup own = ball_model(Stabiliser::kOwn);
  double stiffness = 500.0;
  own.parameters.force.law = ForceLaw::kOwn;
  own.parameters.force.own = {.function = own_linear, .user = &stiffness};
  own.parameters.stabiliser.own = {.function = rise_by_memory, .user = nullptr};
  Runner hand(own);
  const std::size_t before = test::allocations_of_this_thread();
  double largest = 0.0;
  for (int n = 0; n <= kOwnTicks; ++n) largest = std::max(largest, largest_sent(hand.tick(grasp(n))));
  EXPECT_EQ(test::allocations_of_this_thread(), before);
  EXPECT_GT(largest, 0.5);
}

}  // namespace
}  // namespace phalanx
