// SPDX-License-Identifier: Apache-2.0
// The oscillation observer and its reaction in the whole step, and the channels that change nothing.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "phalanx/core/constants.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"
#include "support/simple_hand.h"
#include "support/stabilised_hands.h"

namespace phalanx {
namespace {

using test::at;
using test::floor_model;
using test::index_angles;
using test::index_segment;
using test::kIndex;
using test::moved;
using test::Runner;

/// The index on the floor, shaking at 10 Hz about a depth, `n` ticks from the start.
JointArray shaking(double rest, int n) {
  return index_angles(rest + 0.02 * std::sin(2.0 * std::numbers::pi * 10.0 * 0.005 * n));
}

TEST(OscillationStep, IsReportedWithItsFrequencyAndSwing) {
  const test::Setup model = floor_model(Stabiliser::kNone);
  Runner hand(model);
  hand.move(index_angles(0.28), 60);
  hand.move(index_angles(0.28), 100);
  EXPECT_FALSE(has(hand.now().status, Status::kOscillating));
  double low = 1e9;
  double high = 0.0;
  for (int n = 1; n <= 200; ++n) {
    const double force = index_segment(hand.tick(shaking(0.28, n)), 2).force;
    low = std::min(low, force);
    high = std::max(high, force);
  }
  ASSERT_GT(high - low, 0.5);
  const SegmentSnapshot& tip = index_segment(hand.now(), 2);
  EXPECT_TRUE(has(hand.now().status, Status::kOscillating));
  EXPECT_TRUE(tip.oscillating);
  EXPECT_NEAR(tip.oscillation_frequency, 10.0, 0.5);
  EXPECT_NEAR(tip.oscillation_swing, high - low, 0.05 * (high - low));
  EXPECT_EQ(hand.now().stiffness_factor, 1.0) << "reported, no more";
  for (int n = 0; n < 120; ++n) hand.tick(index_angles(0.28));
  EXPECT_FALSE(has(hand.now().status, Status::kOscillating)) << "0.6 s after the last swing";
  EXPECT_FALSE(index_segment(hand.now(), 2).oscillating);
}

TEST(OscillationStep, HalvesTheLawsForceAndStaysThere) {
  test::Setup model = floor_model(Stabiliser::kNone);
  const test::Setup plain = floor_model(Stabiliser::kNone);
  model.parameters.oscillation.reaction = OscillationReaction::kHalve;
  Runner hand(model);
  Runner beside(plain);
  hand.move(index_angles(0.28), 60);
  beside.move(index_angles(0.28), 60);
  int n = 1;
  while (hand.now().stiffness_factor == 1.0 && n < 200) {
    hand.tick(shaking(0.28, n));
    beside.tick(shaking(0.28, n));
    ++n;
  }
  EXPECT_LT(n, 60) << "300 ms, three cycles";
  for (int still = 0; still < 100; ++still) {
    hand.tick(index_angles(0.28));
    beside.tick(index_angles(0.28));
  }
  EXPECT_EQ(hand.now().stiffness_factor, 0.5);
  const double full = index_segment(beside.now(), 2).force_raw;
  ASSERT_GT(full, 0.5);
  EXPECT_DOUBLE_EQ(index_segment(hand.now(), 2).force_raw, 0.5 * full);
  hand.move(index_angles(0.0), 60);
  hand.move(index_angles(0.28), 60);
  EXPECT_EQ(hand.now().stiffness_factor, 0.5);
}

TEST(Measured, ChannelsReachTheSnapshotAndChangeNoCommand) {
  const test::Setup model = floor_model(Stabiliser::kSmoothing);
  HapticState with(model, model.parameters);
  HapticState without(model, model.parameters);
  for (int n = 1; n <= 100; ++n) {
    Sample sample{.time_s = 0.005 * n, .angle = index_angles(0.005 * n)};
    step(model, model.parameters, sample, without);
    sample.measured_torque[3] = 0.25 * n;
    sample.measured_torque[4] = kInfinity;
    sample.measured_force[kIndex] = 1.5;
    sample.measured_force[0] = -kInfinity;
    step(model, model.parameters, sample, with);
    EXPECT_EQ(with.snapshot().torque, without.snapshot().torque);
    EXPECT_EQ(with.snapshot().status, without.snapshot().status);
  }
  EXPECT_EQ(with.snapshot().measured_torque[3], 25.0);
  EXPECT_TRUE(std::isnan(with.snapshot().measured_torque[4]));
  EXPECT_TRUE(std::isnan(with.snapshot().measured_torque[5]));
  EXPECT_EQ(with.snapshot().measured_force[kIndex], 1.5);
  EXPECT_TRUE(std::isnan(with.snapshot().measured_force[0]));
  for (const double torque : without.snapshot().measured_torque) EXPECT_TRUE(std::isnan(torque));
  Sample late{.time_s = 0.0};
  late.measured_force[kIndex] = 1.5;
  step(model, model.parameters, late, with);
  EXPECT_TRUE(std::isnan(with.snapshot().measured_force[kIndex])) << "its time was refused";
}

}  // namespace
}  // namespace phalanx
