// SPDX-License-Identifier: Apache-2.0
#include "station/parameter_ramp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <type_traits>

#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene.h"

namespace phalanx {
namespace {

// Parameters are numbers alone: whatever becomes of them, no mesh is copied.
static_assert(std::is_trivially_copyable_v<HapticParameters>);
static_assert(!std::is_copy_constructible_v<HapticModel> && !std::is_copy_assignable_v<HapticModel>);

constexpr int kSteps = 41;  // of a ramp at 200 Hz, the last one's rounding included

HapticParameters with(Stabiliser method, double min_rate = -20.0, double max_rate = 20.0) {
  HapticParameters parameters;
  parameters.stabiliser = {.method = method, .min_rate = min_rate, .max_rate = max_rate};
  return parameters;
}

void expect_bounds(const HapticParameters& parameters, Stabiliser method, double min_rate, double max_rate) {
  EXPECT_EQ(parameters.stabiliser.method, method);
  EXPECT_NEAR(parameters.stabiliser.min_rate, min_rate, 1e-9 * std::abs(min_rate));
  EXPECT_NEAR(parameters.stabiliser.max_rate, max_rate, 1e-9 * std::abs(max_rate));
}

// Half way from 10,000 to 25 N/s in equal ratios is 500 N/s, and from 10,000 to 4 N/s it is 200 N/s.
TEST(ParameterRamp, AMethodThatBeginsHasUnboundedBoundsFirst) {
  for (const Stabiliser method : {Stabiliser::kSmoothing, Stabiliser::kRiseOnly}) {
    ParameterRamp ramp(with(Stabiliser::kNone, -1.0, 1.0));
    ramp.go_to(with(method, -4.0, 25.0));
    for (int i = 0; i < 20; ++i) ramp.advance();
    EXPECT_TRUE(ramp.moving());
    EXPECT_EQ(ramp.parameters().stabiliser.method, method);
    EXPECT_NEAR(ramp.parameters().stabiliser.max_rate, 500.0, 1e-6);
    if (method == Stabiliser::kSmoothing) {
      EXPECT_NEAR(ramp.parameters().stabiliser.min_rate, -200.0, 1e-6);
    }
    for (int i = 20; i < kSteps; ++i) ramp.advance();
    EXPECT_FALSE(ramp.moving());
    expect_bounds(ramp.parameters(), method, -4.0, 25.0);
  }
}

TEST(ParameterRamp, AMethodThatEndsHasUnboundedBoundsLastAndThenTheTargetsOwn) {
  for (const Stabiliser method : {Stabiliser::kSmoothing, Stabiliser::kRiseOnly}) {
    ParameterRamp ramp(with(method, -4.0, 25.0));
    ramp.go_to(with(Stabiliser::kNone, -1.0, 1.0));
    for (int i = 0; i < 39; ++i) ramp.advance();
    EXPECT_EQ(ramp.parameters().stabiliser.method, method) << "on the way";
    EXPECT_GT(ramp.parameters().stabiliser.max_rate, 0.8 * ParameterRamp::kUnbounded);
    for (int i = 39; i < kSteps; ++i) ramp.advance();
    expect_bounds(ramp.parameters(), Stabiliser::kNone, -1.0, 1.0);
  }
}

// The rise goes from 25 to 100 N/s and the fall between unbounded and 4 N/s; half way they are 50 and 200
// N/s.
TEST(ParameterRamp, BetweenRiseOnlyAndSmoothingTheFallBeginsOrEndsUnbounded) {
  for (const bool begins : {true, false}) {
    const HapticParameters from = with(begins ? Stabiliser::kRiseOnly : Stabiliser::kSmoothing, -4.0, 25.0);
    const HapticParameters to = with(begins ? Stabiliser::kSmoothing : Stabiliser::kRiseOnly, -4.0, 100.0);
    ParameterRamp ramp(from);
    ramp.go_to(to);
    for (int i = 0; i < 20; ++i) ramp.advance();
    expect_bounds(ramp.parameters(), Stabiliser::kSmoothing, -200.0, 50.0);
    for (int i = 20; i < kSteps; ++i) ramp.advance();
    expect_bounds(ramp.parameters(), to.stabiliser.method, -4.0, 100.0);
  }
}

TEST(ParameterRamp, AMethodOnItsWayIsOvertakenFromWhereItHasComeTo) {
  ParameterRamp ramp(with(Stabiliser::kSmoothing, -4.0, 25.0));
  ramp.go_to(with(Stabiliser::kNone));
  for (int i = 0; i < 20; ++i) ramp.advance();
  expect_bounds(ramp.parameters(), Stabiliser::kSmoothing, -200.0, 500.0);
  ramp.go_to(with(Stabiliser::kSmoothing, -4.0, 25.0));
  ramp.advance();
  EXPECT_LT(ramp.parameters().stabiliser.max_rate, 500.0);
  EXPECT_GT(ramp.parameters().stabiliser.max_rate, 400.0);
  for (int i = 1; i < kSteps; ++i) ramp.advance();
  expect_bounds(ramp.parameters(), Stabiliser::kSmoothing, -4.0, 25.0);
}

// Whatever the target has besides: law, limits, margin and rate stay, and a method that needs zero torque.
TEST(ParameterRamp, TakesOnlyWhatMayChangeInContact) {
  const HapticParameters before = with(Stabiliser::kRiseOnly);
  HapticParameters target = with(Stabiliser::kLowPass, -5.0, 30.0);
  target.force = {.law = ForceLaw::kDuffing, .stiffness = 700.0, .damping = 3.0, .cubic = 1e6};
  target.limits.fingertip_force_enabled = false;
  target.contact.margin = 80e-6;
  target.oscillation.swing = 2.0;
  target.rate_hz = 1000.0;
  ParameterRamp ramp(before);
  ramp.go_to(target);
  for (int i = 0; i < kSteps; ++i) ramp.advance();
  const HapticParameters& now = ramp.parameters();
  EXPECT_FALSE(ramp.moving());
  EXPECT_EQ(now.force.stiffness, 700.0);
  EXPECT_EQ(now.force.damping, 3.0);
  expect_bounds(now, Stabiliser::kRiseOnly, -5.0, 30.0);
  EXPECT_EQ(now.force.law, before.force.law);
  EXPECT_EQ(now.force.cubic, before.force.cubic);
  EXPECT_TRUE(now.limits.fingertip_force_enabled);
  EXPECT_EQ(now.contact.margin, before.contact.margin);
  EXPECT_EQ(now.oscillation.swing, before.oscillation.swing);
  EXPECT_EQ(now.rate_hz, before.rate_hz);
}

TEST(ParameterRamp, StaysFiniteFromTheSmallestBound) {
  ParameterRamp ramp(with(Stabiliser::kSmoothing, -1e-307, 1e-307));
  ramp.go_to(with(Stabiliser::kNone));
  for (int i = 0; i < kSteps; ++i) {
    ramp.advance();
    EXPECT_LE(ramp.parameters().stabiliser.max_rate, ParameterRamp::kUnbounded);
    EXPECT_GE(ramp.parameters().stabiliser.min_rate, -ParameterRamp::kUnbounded);
  }
}

TEST(ParameterRamp, OnlyMethodsThatBoundTheForcesChangeGoOverInContact) {
  using enum Stabiliser;
  for (const Stabiliser from : {kNone, kSmoothing, kRiseOnly}) {
    for (const Stabiliser to : {kNone, kSmoothing, kRiseOnly}) EXPECT_TRUE(goes_over_in_contact(from, to));
    for (const Stabiliser to :
         {kDirection, kLowPass, kKelvinVoigt, kVirtualCoupling, kPassivity, kEnergyBounding, kLocalWall}) {
      EXPECT_FALSE(goes_over_in_contact(from, to));
      EXPECT_FALSE(goes_over_in_contact(to, from));
      EXPECT_TRUE(goes_over_in_contact(to, to)) << "no change";
    }
  }
}

/// press_teapot's finger, held where it presses.
class Pressing : public testing::Test {
 protected:
  Pressing()
      : scene_(load_scene(PHALANX_SOURCE_DIR "/scenes/press_teapot.toml")),
        motion_(build_motion(scene_)),
        model_(build_model(scene_)),
        ramp_(scene_.parameters),
        state_(model_, scene_.parameters) {
    for (int i = 0; i < 300; ++i) step();
  }

  /// The motion's first second and a half, then it stays, but for a sway of the knuckle by so much [rad].
  /// @returns the largest change of a torque in this step
  double step(double sway = 0.0) {
    const JointArray before = state_.snapshot().torque;
    time_ += scene_.parameters.period();
    JointArray angle = motion_.at(std::min(time_, 1.5));
    angle[static_cast<std::size_t>(joint_index(1, 0))] +=
        sway * std::sin(2.0 * std::numbers::pi * 5.0 * time_);
    ramp_.advance();
    static_cast<void>(phalanx::step(model_, now(), {.time_s = time_, .angle = angle}, state_));
    double largest = 0.0;
    for (std::size_t j = 0; j < before.size(); ++j)
      largest = std::max(largest, std::abs(state_.snapshot().torque[j] - before[j]));
    return largest;
  }
  [[nodiscard]] double force() const {
    double sum = 0.0;
    for (const SegmentSnapshot& segment : state_.snapshot().segment) sum += segment.force;
    return sum;
  }
  [[nodiscard]] const HapticParameters& now() const { return ramp_.parameters(); }
  [[nodiscard]] double allowed() const {
    return scene_.parameters.limits.torque_rate / scene_.parameters.rate_hz + 1e-12;
  }

  SceneDescription scene_;
  Motion motion_;
  HapticModel model_;
  ParameterRamp ramp_;
  HapticState state_;
  double time_ = 0.0;
};

TEST_F(Pressing, AStifferWallComesOverTwoHundredMillisecondsWithoutATorqueStepBeyondTheRateLimit) {
  const double before = force();
  ASSERT_GT(before, 0.3);
  HapticParameters target = now();
  target.force.stiffness *= 2.0;
  ramp_.go_to(target);
  const int steps = static_cast<int>(ParameterRamp::kSeconds * scene_.parameters.rate_hz);
  double largest = 0.0;
  for (int i = 0; i < steps; ++i) {
    largest = std::max(largest, step());
    if (i == steps / 2) {
      EXPECT_TRUE(ramp_.moving());
    }
  }
  EXPECT_FALSE(ramp_.moving());
  EXPECT_EQ(now().force.stiffness, target.force.stiffness);
  for (int i = 0; i < 200; ++i) largest = std::max(largest, step());
  EXPECT_LE(largest, allowed());
  EXPECT_GT(force(), 1.2 * before);
  std::printf("stiffness doubled in contact: largest torque step %.4f of %.4f Nm allowed\n", largest,
              allowed());
}

// 20 of 40 steps at 200 Hz: damping is half way in a straight line, 5 of 10 N s/m; bounds that grow fourfold
// have doubled.
TEST_F(Pressing, HalfWayDampingIsAtItsMiddleAndBoundsAreAtTheirGeometricMiddle) {
  const HapticParameters before = now();
  ASSERT_EQ(before.rate_hz, 200.0);
  ASSERT_NE(before.stabiliser.method, Stabiliser::kNone);
  HapticParameters target = before;
  target.force.damping += 10.0;
  target.stabiliser.min_rate *= 4.0;
  target.stabiliser.max_rate *= 4.0;
  ramp_.go_to(target);
  for (int i = 0; i < 20; ++i) step();
  EXPECT_TRUE(ramp_.moving());
  EXPECT_NEAR(now().force.damping, before.force.damping + 5.0, 1e-9);
  EXPECT_NEAR(now().stabiliser.min_rate, 2.0 * before.stabiliser.min_rate, 1e-9);
  EXPECT_NEAR(now().stabiliser.max_rate, 2.0 * before.stabiliser.max_rate, 1e-9);
}

TEST_F(Pressing, TheStabiliserIsTurnedOffAndOnWithoutATorqueStepBeyondTheRateLimit) {
  const Stabiliser method = now().stabiliser.method;
  for (const Stabiliser next : {Stabiliser::kNone, method}) {
    HapticParameters target = now();
    target.stabiliser.method = next;
    ramp_.go_to(target);
    for (int i = 0; i < 100; ++i) EXPECT_LE(step(), allowed());
    EXPECT_EQ(now().stabiliser.method, next);
    EXPECT_EQ(now().stabiliser.max_rate, scene_.parameters.stabiliser.max_rate);
  }
}

// The knuckle sways by 30 mrad at 5 Hz: some 2 mm of 300 N/m, so that the law asks for more than the scene's
// 10 N/s. No step changes a force by more than the bound that is in force; where there is none, by no more
// than the law's force has changed.
TEST_F(Pressing, NoForceJumpsWhileTheMethodGoesOverInContact) {
  using enum Stabiliser;
  constexpr double kSway = 0.03;
  const double period = scene_.parameters.period();
  HapticParameters soft = now();
  soft.force.stiffness = 300.0;
  ramp_.go_to(soft);
  for (int i = 0; i < 100; ++i) step(kSway);
  int bounded = 0;
  for (const Stabiliser next :
       {kNone, kSmoothing, kRiseOnly, kSmoothing, kNone, kRiseOnly, kNone, kSmoothing, kRiseOnly}) {
    HapticParameters target = now();
    target.stabiliser.method = next;
    ramp_.go_to(target);
    for (int i = 0; i < 80; ++i) {
      const Snapshot before = state_.snapshot();
      step(kSway);
      const StabiliserParameters& in_force = now().stabiliser;
      for (std::size_t s = 0; s < kSegments; ++s) {
        const SegmentSnapshot& a = before.segment[s];
        const SegmentSnapshot& b = state_.snapshot().segment[s];
        ASSERT_LT(b.force_raw, scene_.parameters.limits.fingertip_force) << "no cap acts";
        const double by_law = std::abs(b.force_raw - a.force_raw);
        const double rise = in_force.method == kNone ? by_law : in_force.max_rate * period;
        const double fall = in_force.method == kSmoothing ? -in_force.min_rate * period : by_law;
        EXPECT_LE(b.force - a.force, rise + 1e-9) << "to " << static_cast<int>(next) << ", step " << i;
        EXPECT_LE(a.force - b.force, fall + 1e-9) << "to " << static_cast<int>(next) << ", step " << i;
        bounded += in_force.method != kNone && b.force < b.force_raw - 1e-3 ? 1 : 0;
      }
    }
    EXPECT_FALSE(ramp_.moving());
    EXPECT_EQ(now().stabiliser.method, next);
  }
  EXPECT_GT(bounded, 20) << "the bound acts";
}

TEST_F(Pressing, RiseOnlyArrivesAsItWasAskedFor) {
  HapticParameters target = now();
  target.stabiliser.min_rate = -std::numeric_limits<double>::infinity();
  ramp_.go_to(target);
  for (int i = 0; i < 100; ++i) {
    step();
    ASSERT_TRUE(std::isfinite(force()));
  }
  EXPECT_EQ(now().stabiliser.min_rate, target.stabiliser.min_rate);
}

TEST_F(Pressing, AChangeOnItsWayIsOvertakenByTheNext) {
  HapticParameters target = now();
  const double first = target.force.stiffness;
  target.force.stiffness = 4.0 * first;
  ramp_.go_to(target);
  for (int i = 0; i < 20; ++i) step();
  const double half_way = now().force.stiffness;
  EXPECT_GT(half_way, first);
  target.force.stiffness = first;
  ramp_.go_to(target);
  step();
  EXPECT_LT(std::abs(now().force.stiffness - half_way), 0.1 * half_way);
  for (int i = 0; i < 40; ++i) step();
  EXPECT_EQ(now().force.stiffness, first);
}

}  // namespace
}  // namespace phalanx
