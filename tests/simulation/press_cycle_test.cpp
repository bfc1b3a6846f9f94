// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/press_cycle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/pressing_finger.h"

namespace phalanx::test {
namespace {

constexpr double kCycleWall = 1000.0;
constexpr double kPress = 3.0;
constexpr std::uint64_t kCycleSeed = 5;
constexpr double kCyclePeriod = 1e-3;

/// Patient, plan and cycle together: the cycle refers to the others.
struct Squeezing {
  explicit Squeezing(double tremor, const TrialSchedule& with = {})
      : patient(trembling(tremor)),
        schedule(with),
        cycle(plan, patient, hand, kCycleWall, kPress, kCycleSeed, schedule),
        intent(plan, patient, hand, kCycleWall, kPress, kCycleSeed, schedule) {}

  static PatientParameters trembling(double tremor) {
    PatientParameters patient = steady_patient();
    patient.tremor = tremor;
    return patient;
  }
  /// Largest change of the MCP between two ticks that begin in from .. to [rad].
  [[nodiscard]] double largest_step(double from, double to) const {
    double largest = 0.0;
    for (double t = from; t < to; t += kCyclePeriod)
      largest =
          std::max(largest, std::abs(cycle.angle(t + kCyclePeriod)[idx(kMcp)] - cycle.angle(t)[idx(kMcp)]));
    return largest;
  }

  PressPlan plan = plan_on_paper();
  HandParameters hand = simple_parameters();
  PatientParameters patient;
  TrialSchedule schedule;
  PressCycle cycle;
  PressIntent intent;
};

TEST(PressCycle, ASqueezeIsAPressIntentUntilTheSeam) {
  const Squeezing s(3e-4);
  for (double t = 0.0; t < s.schedule.end - 0.25; t += 0.01) {
    EXPECT_EQ(s.cycle.angle(t), s.intent.angle(t)) << t;
    EXPECT_EQ(s.cycle.push(t), s.intent.push(t)) << t;
  }
}

TEST(PressCycle, EverySqueezeIsLikeTheFirst) {
  const Squeezing s(3e-4);
  const JointArray now = s.cycle.angle(2.0);
  for (int n = 1; n < 1000; n *= 10) {
    const JointArray later = s.cycle.angle(2.0 + n * s.schedule.end);
    for (std::size_t j = 0; j < now.size(); ++j) EXPECT_NEAR(later[j], now[j], 1e-9) << n;
  }
  EXPECT_EQ(s.cycle.push(s.schedule.end + 1.5)[idx(kMcp)], 0.0);
  EXPECT_NE(s.cycle.push(s.schedule.end + 1.65)[idx(kMcp)], 0.0) << "the bump comes in each";
}

// The seam is no faster than the tremor elsewhere; without leading the tremor over it would jump.
TEST(PressCycle, NothingJumpsBetweenTwoSqueezes) {
  const Squeezing s(3e-4);
  const double end = s.schedule.end;
  const double gap = std::abs(s.intent.angle(end)[idx(kMcp)] - s.intent.angle(0.0)[idx(kMcp)]);
  const double pressing = s.largest_step(0.3, s.schedule.release + 0.3);
  const double seam = s.largest_step(end - 0.3, end + 0.15);
  const double holding = s.largest_step(s.schedule.window_begin, s.schedule.window_end);
  EXPECT_GT(gap, 3.0 * holding) << "this seed would have shown a jump";
  EXPECT_LT(seam, 2.0 * holding);
  EXPECT_LT(seam, pressing);
}

// The share x^2 (3 - 2 x) of the way over, by hand: 5/32 at a quarter of the seam, a half in its middle,
// 27/32 at three quarters.
TEST(PressCycle, TheSeamIsCrossedSmoothly) {
  const Squeezing s(3e-4);
  const JointArray begin = s.intent.angle(0.0);
  const JointArray end = s.intent.angle(s.schedule.end);
  for (const auto& [before_the_end, share] :
       {std::pair{0.1875, 5.0 / 32.0}, {0.125, 0.5}, {0.0625, 27.0 / 32.0}}) {
    const double t = s.schedule.end - before_the_end;
    const JointArray intended = s.intent.angle(t);
    const JointArray shown = s.cycle.angle(t);
    for (std::size_t j = 0; j < shown.size(); ++j)
      EXPECT_NEAR(shown[j], intended[j] + share * (begin[j] - end[j]), 1e-12)
          << joint_name(static_cast<int>(j));
  }
}

TEST(PressCycle, ASqueezeThatDoesNotEndIsRefused) {
  TrialSchedule schedule;
  schedule.end = schedule.release + 0.1;
  try {
    const Squeezing s(0.0, schedule);
    FAIL() << "should have thrown";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("index_mcp_flexion"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace phalanx::test
