// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/live_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene.h"

namespace phalanx {
namespace {

/// press_teapot's finger, held where it presses.
class Pressing : public testing::Test {
 protected:
  Pressing()
      : scene_(load_scene(PHALANX_SOURCE_DIR "/scenes/press_teapot.toml")),
        motion_(build_motion(scene_)),
        live_(std::make_unique<HapticModel>(build_model(scene_))) {
    for (int i = 0; i < 300; ++i) step();
  }

  /// The motion's first second and a half, then it stays. @returns the largest change of a torque in this
  /// step
  double step() {
    const JointArray before = live_.snapshot().torque;
    time_ += 1.0 / scene_.rate_hz;
    static_cast<void>(live_.advance({.time_s = time_, .angle = motion_.at(std::min(time_, 1.5))}));
    double largest = 0.0;
    for (std::size_t j = 0; j < before.size(); ++j)
      largest = std::max(largest, std::abs(live_.snapshot().torque[j] - before[j]));
    return largest;
  }
  [[nodiscard]] double force() const {
    double sum = 0.0;
    for (const SegmentSnapshot& segment : live_.snapshot().segment) sum += segment.force;
    return sum;
  }

  SceneDescription scene_;
  Motion motion_;
  LiveModel live_;
  double time_ = 0.0;
};

TEST_F(Pressing, AStifferWallComesOverTwoHundredMillisecondsWithoutATorqueStepBeyondTheRateLimit) {
  const double before = force();
  ASSERT_GT(before, 0.3);
  BlendedParameters target = blended_of(live_.model());
  target.stiffness *= 2.0;
  live_.blend_to(target);
  const double allowed = live_.model().limits.torque_rate / scene_.rate_hz + 1e-12;
  const int steps = static_cast<int>(LiveModel::kBlend * scene_.rate_hz);
  double largest = 0.0;
  for (int i = 0; i < steps; ++i) {
    largest = std::max(largest, step());
    if (i == steps / 2) {
      EXPECT_TRUE(live_.blending());
    }
  }
  EXPECT_FALSE(live_.blending());
  EXPECT_EQ(live_.model().force.stiffness, target.stiffness);
  for (int i = 0; i < 200; ++i) largest = std::max(largest, step());
  EXPECT_LE(largest, allowed);
  EXPECT_GT(force(), 1.2 * before);
  std::printf("stiffness doubled in contact: largest torque step %.4f of %.4f Nm allowed\n", largest,
              allowed);
}

// 20 of 40 steps at 200 Hz: damping is half way in a straight line, 5 of 10 N s/m; bounds that grow fourfold
// have doubled.
TEST_F(Pressing, HalfWayDampingIsAtItsMiddleAndBoundsAreAtTheirGeometricMiddle) {
  const BlendedParameters before = blended_of(live_.model());
  ASSERT_EQ(scene_.rate_hz, 200.0);
  ASSERT_TRUE(before.smoothing);
  BlendedParameters target = before;
  target.damping += 10.0;
  target.min_rate *= 4.0;
  target.max_rate *= 4.0;
  live_.blend_to(target);
  for (int i = 0; i < 20; ++i) step();
  EXPECT_TRUE(live_.blending());
  EXPECT_NEAR(live_.model().force.damping, before.damping + 5.0, 1e-9);
  EXPECT_NEAR(live_.model().smoothing.min_rate, 2.0 * before.min_rate, 1e-9);
  EXPECT_NEAR(live_.model().smoothing.max_rate, 2.0 * before.max_rate, 1e-9);
}

TEST_F(Pressing, SmoothingIsTurnedOffAndOnWithoutATorqueStepBeyondTheRateLimit) {
  const double allowed = live_.model().limits.torque_rate / scene_.rate_hz + 1e-12;
  for (const bool on : {false, true}) {
    BlendedParameters target = blended_of(live_.model());
    target.smoothing = on;
    live_.blend_to(target);
    for (int i = 0; i < 100; ++i) EXPECT_LE(step(), allowed);
    EXPECT_EQ(live_.model().smoothing.enabled, on);
    EXPECT_EQ(live_.model().smoothing.max_rate, scene_.smoothing.max_rate);
  }
}

TEST_F(Pressing, RiseOnlyArrivesAsItWasAskedFor) {
  BlendedParameters target = blended_of(live_.model());
  target.min_rate = -std::numeric_limits<double>::infinity();
  live_.blend_to(target);
  for (int i = 0; i < 100; ++i) {
    step();
    ASSERT_TRUE(std::isfinite(force()));
  }
  EXPECT_EQ(live_.model().smoothing.min_rate, target.min_rate);
}

TEST_F(Pressing, AChangeOnItsWayIsOvertakenByTheNext) {
  BlendedParameters target = blended_of(live_.model());
  const double first = target.stiffness;
  target.stiffness = 4.0 * first;
  live_.blend_to(target);
  for (int i = 0; i < 20; ++i) step();
  const double half_way = live_.model().force.stiffness;
  EXPECT_GT(half_way, first);
  target.stiffness = first;
  live_.blend_to(target);
  step();
  EXPECT_LT(std::abs(live_.model().force.stiffness - half_way), 0.1 * half_way);
  for (int i = 0; i < 40; ++i) step();
  EXPECT_EQ(live_.model().force.stiffness, first);
}

TEST(LiveKeys, OnlyWhatScalesForcesChangesInContact) {
  EXPECT_TRUE(changes_in_contact("force.stiffness_n_per_mm"));
  EXPECT_TRUE(changes_in_contact("smoothing.enabled"));
  for (const char* key : {"objects.0.size_mm", "force.law", "limits.fingertip_force_n", "rate_hz", "force"})
    EXPECT_FALSE(changes_in_contact(key)) << key;
}

}  // namespace
}  // namespace phalanx
