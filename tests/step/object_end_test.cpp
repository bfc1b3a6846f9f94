// SPDX-License-Identifier: Apache-2.0
// Sliding mode where an object ends: the force of a finger that has left it, and the way of the one that is shown.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "phalanx/contact/proximity.h"
#include "support/sliding_finger.h"

namespace phalanx {
namespace {

using test::ball;
using test::block;
using test::LoneFinger;
using test::Pressed;
using test::raw_force;
using test::sliding_finger;

/// Watches for how long the law still gives a force after the measured finger has left the object: each of its
/// segments is clear of the surface.
class Leaving {
 public:
  explicit Leaving(const test::Setup& model) : model_(model), scratch_(model.trees()) {}

  void see(const Snapshot& s) {
    if (!outside(s)) {
      since_ = 0;
      return;
    }
    ever_ = true;
    ++since_;
    if (raw_force(s) > 0.0) latest_ = std::max(latest_, since_);
  }
  [[nodiscard]] bool ever() const { return ever_; }
  [[nodiscard]] double latest() const { return latest_ * model_.parameters.period(); }

 private:
  bool outside(const Snapshot& s) {
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const auto segment = static_cast<std::size_t>(segment_index(test::kIndex, k));
      const PlacedSegment placed{model_.trees()[segment], s.hcp_pose[segment], scratch_};
      if (!(distance(placed, model_.object.tree(), 1e-3) > model_.parameters.contact.margin)) return false;
    }
    return true;
  }

  const test::Setup& model_;
  SearchScratch scratch_;
  int since_ = 0;
  int latest_ = 0;
  bool ever_ = false;
};

constexpr double kEnds = 50e-3;  // [s]

class SlidingEnds : public testing::TestWithParam<double> {
 protected:
  /// Ticks of one millisecond's motion in this test's rate.
  void play(Pressed& press, Leaving& leaving, int milliseconds, const std::function<JointArray(double)>& at) {
    const int step = static_cast<int>(std::lround(1000.0 / GetParam()));
    for (int ms = step; ms <= milliseconds; ms += step) {
      leaving.see(press.hand.tick(at(ms)));
      most_ = std::max(most_, raw_force(press.hand.now()));
    }
  }
  double most_ = 0.0;  ///< greatest force of the law [N]
};

TEST_P(SlidingEnds, AFingerThatSlidesOffABarFeelsNothingBesideIt) {
  for (const double mu : {0.6, 0.0, 1.0}) {
    if (test::kSlowBuild && mu != 0.6) continue;
    LoneFinger finger = sliding_finger(block(0.016, 0.016), mu);
    finger.model().parameters.rate_hz = GetParam();
    Pressed press(finger, 3e-3);
    ASSERT_GT(press.tip().force, 1.0);
    Leaving leaving(finger.model());
    play(press, leaving, 400, [&](double ms) { return LoneFinger::pose(press.goal, 0.6e-3 * ms); });
    play(press, leaving, 200, [&](double ms) { return LoneFinger::pose(press.goal + 0.5e-3 * ms, 0.24); });
    EXPECT_TRUE(leaving.ever()) << mu;
    EXPECT_LE(leaving.latest(), kEnds) << mu;
    EXPECT_EQ(press.hand.now().gdp_angle, press.hand.now().hcp_angle) << mu;
  }
}

TEST_P(SlidingEnds, AFingerThatHasGoneThroughABarFeelsNothingBeyond) {
  LoneFinger finger = sliding_finger(block(0.016, 0.016), 0.6);
  finger.model().parameters.rate_hz = GetParam();
  Pressed press(finger, 3e-3);
  Leaving leaving(finger.model());
  play(press, leaving, 700, [&](double ms) { return LoneFinger::pose(press.goal + 1e-3 * ms); });
  play(press, leaving, 500, [&](double) { return LoneFinger::pose(press.goal + 0.7); });
  EXPECT_GT(most_, 5.0) << "inside, the force grows with the depth";
  EXPECT_TRUE(leaving.ever());
  EXPECT_LE(leaving.latest(), kEnds);
  EXPECT_EQ(press.hand.now().gdp_angle, press.hand.now().hcp_angle);
}

TEST_P(SlidingEnds, AFingerThatLeavesABallFeelsNothingAboveIt) {
  LoneFinger finger = sliding_finger(ball(), 0.6);
  finger.model().parameters.rate_hz = GetParam();
  Pressed press(finger, 3e-3);
  Leaving leaving(finger.model());
  play(press, leaving, 500, [&](double ms) { return LoneFinger::pose(press.goal, 0.8e-3 * ms); });
  EXPECT_TRUE(leaving.ever());
  EXPECT_LE(leaving.latest(), kEnds);
}

TEST_P(SlidingEnds, AFingerThatHasGoneThroughABarIsShownOnItsWayRoundIt) {
  LoneFinger finger = sliding_finger(block(0.016, 0.016), 0.6);
  finger.model().parameters.rate_hz = GetParam();
  const double period = finger.model().parameters.period();
  Pressed press(finger, 3e-3);
  const auto tip = static_cast<std::size_t>(segment_index(test::kIndex, 2));
  const Vec3 end(0.0, 0.0, -test::kLength3);
  double fastest = 0.0;
  double aside = 0.0;
  Pose before = press.hand.now().gdp_pose[tip];
  const auto watch = [&](double angle) {
    const Snapshot& s = press.hand.tick(LoneFinger::pose(angle));
    fastest = std::max(fastest, (s.gdp_pose[tip] * end - before * end).norm() / period);
    aside = std::max(aside, std::abs((s.gdp_pose[tip] * end).x()));
    before = s.gdp_pose[tip];
  };
  for (double t = 0.0; t < 0.7; t += period) watch(press.goal + t);
  for (double t = 0.0; t < 0.5; t += period) watch(press.goal + 0.7);
  EXPECT_EQ(press.hand.now().gdp_angle, press.hand.now().hcp_angle);
  EXPECT_LE(fastest, 1.01) << "[m/s]; at once it would be 30 and more";
  EXPECT_GT(aside, 0.008 + LoneFinger::kTipRadius) << "[m]: half of the bar, and the tip";
}

TEST_P(SlidingEnds, AFingerThatGoesBackIntoTheBarFeelsItsForceRiseSlowly) {
  for (const double back_after :
       {0.31, 0.33, 0.36, 0.40}) {  // while ways are looked for, on the way, and after it
    LoneFinger finger = sliding_finger(block(0.016, 0.016), 0.6);
    finger.model().parameters.rate_hz = GetParam();
    const double period = finger.model().parameters.period();
    Pressed press(finger, 3e-3);
    double before = 0.0;
    double steepest = 0.0;
    double end = 0.0;
    const auto watch = [&](double angle) {
      press.hand.tick(LoneFinger::pose(angle));
      end = raw_force(press.hand.now());
      steepest = std::max(steepest, (end - before) / period);
      before = end;
    };
    // Through the bar within 30 ms, clear of it until `back_after`, and back into its middle at once.
    before = raw_force(press.hand.now());
    for (double t = 0.0; t < back_after; t += period)
      press.hand.tick(LoneFinger::pose(press.goal + std::min(0.4, 4.0 * t)));
    before = raw_force(press.hand.now());
    for (double t = 0.0; t < 0.3; t += period) watch(press.goal + 0.05);
    EXPECT_GT(end, 1.0) << back_after << ": it is in the bar";
    EXPECT_LT(steepest, 1.1 * end / 0.03) << back_after << " [N/s]";
  }
}

INSTANTIATE_TEST_SUITE_P(Hertz, SlidingEnds, testing::Values(1000.0, 200.0));

}  // namespace
}  // namespace phalanx
