// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/press_intent.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "simulation/pressing_finger.h"

namespace phalanx {
namespace {

using test::kIndex;
using test::kMcp;
using test::kPip;

constexpr double kWall = 1000.0;   // [N/m]
constexpr double kIntended = 3.0;  // [N]
const TrialSchedule kSchedule;

/// An intent with all that it refers to.
struct Case {
  explicit Case(std::uint64_t seed = 1, PatientParameters the_patient = test::steady_patient(),
                HandParameters the_hand = test::simple_parameters())
      : patient(std::move(the_patient)),
        hand(std::move(the_hand)),
        intent(plan, patient, hand, kWall, kIntended, seed, kSchedule) {}
  Case(const Case&) = delete;
  Case& operator=(const Case&) = delete;

  [[nodiscard]] const DigitPress& press() const { return *plan.digit[kIndex]; }
  /// The way x of the contact's point into the wall [m].
  [[nodiscard]] double way(double t) const {
    return (intent.angle(t)[idx(kMcp)] - press().contact[idx(kMcp)]) / press().into[idx(kMcp)];
  }

  PressPlan plan = test::plan_on_paper();
  PatientParameters patient;
  HandParameters hand;
  PressIntent intent;
};

// F (1/kh + 1/k) = 3 N x (3.5e-4 + 1e-3) m/N = 4.05 mm.
constexpr double kEnd = 4.05e-3;

TEST(PressIntent, WaitsTwoCentimetresBeforeTheContact) {
  const Case one;
  EXPECT_NEAR(one.way(0.0), -PressIntent::kApproach, 1e-12);
  EXPECT_NEAR(one.way(kSchedule.start), -PressIntent::kApproach, 1e-12);
  EXPECT_GT(one.way(kSchedule.start + 1e-3), -PressIntent::kApproach + 1e-6);
}

// 20 mm at 50 mm/s: it meets the wall 0.4 s after it starts.
TEST(PressIntent, ComesAtTheSpeedOfTheTip) {
  const Case one;
  for (const double since : {0.1, 0.2, 0.4, 0.45})
    EXPECT_NEAR(one.way(kSchedule.start + since), -0.02 + 0.05 * since, 1e-12);
}

TEST(PressIntent, StaysWhereTheWallHoldsThePressAtRest) {
  const Case one;
  for (const double t : {1.0, kSchedule.window_begin, kSchedule.window_end, kSchedule.release})
    EXPECT_NEAR(one.way(t), kEnd, 1e-12) << t;
  // There the springs' force along the press is F at the depth F / k: kh (x_end - F / k) = F.
  EXPECT_NEAR(one.press().stiffness * (one.way(2.0) - kIntended / kWall), kIntended, 1e-9);
}

TEST(PressIntent, LetsGoAtTheSpeedOfTheRelease) {
  const Case one;
  EXPECT_NEAR(one.way(kSchedule.release + 0.1), kEnd - 0.1 * kSchedule.release_speed, 1e-12);
  EXPECT_NEAR(one.way(kSchedule.end), -PressIntent::kApproach, 1e-12);
}

TEST(PressIntent, MovesEveryJointOfThePressInItsProportionAndNoOther) {
  const Case one;
  for (const double t : {0.0, 0.5, 1.0, 3.0, 4.5, 5.3}) {
    const JointArray angle = one.intent.angle(t);
    const double x = one.way(t);
    EXPECT_NEAR(angle[idx(kPip)], 0.4 + one.press().into[idx(kPip)] * x, 1e-12);
    for (int j = 0; j < kJoints; ++j)
      if (digit_of_joint(j) != kIndex) {
        EXPECT_EQ(angle[idx(j)], one.plan.open[idx(j)]) << joint_name(j);
      }
  }
}

TEST(PressIntent, BumpsIntoTheWallWhileTheBumpLasts) {
  const Case one;
  const double begin = one.patient.bump_start;
  const double end = begin + one.patient.bump_duration;
  for (const double t : {0.0, begin - 1e-6, end + 1e-6, 4.0})
    for (const double torque : one.intent.push(t)) EXPECT_EQ(torque, 0.0) << t;
  for (const double t : {begin, 0.5 * (begin + end), end - 1e-6}) {
    const JointArray push = one.intent.push(t);
    EXPECT_NEAR(push[idx(kMcp)], 0.05 * 2.0, 1e-15);  // -g F, g = -50 mm
    EXPECT_NEAR(push[idx(kPip)], 0.02 * 2.0, 1e-15);
    for (int j = 0; j < kJoints; ++j)
      if (j != kMcp && j != kPip) {
        EXPECT_EQ(push[idx(j)], 0.0) << joint_name(j);
      }
  }
}

TEST(PressIntent, TremblesByNoMoreThanTheAmplitude) {
  PatientParameters trembling = test::steady_patient();
  trembling.tremor = 30e-6;
  const Case still;
  double largest = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Case one(seed, trembling);
    for (int i = 0; i < 5300; ++i) {
      const double tremor = std::abs(one.way(1e-3 * i) - still.way(1e-3 * i));
      ASSERT_LE(tremor, 30e-6 + 1e-12) << "seed " << seed << ", t = " << 1e-3 * i;
      largest = std::max(largest, tremor);
    }
  }
  EXPECT_GT(largest, 0.8 * 30e-6);
}

// Between the first and the last zero crossing, `n` half-waves: no faster than the fastest of the three.
TEST(PressIntent, TremblesWithinItsBandOfFrequencies) {
  PatientParameters trembling = test::steady_patient();
  trembling.tremor = 30e-6;
  trembling.tremor_min_hz = trembling.tremor_max_hz = 8.0;
  const Case still;
  const Case one(3, trembling);
  int crossings = 0;
  double before = 0.0;
  for (int i = 0; i <= 4000; ++i) {  // 4 s at 8 Hz: 64 half-waves
    const double now = one.way(1e-3 * i) - still.way(1e-3 * i);
    if (now * before < 0.0) ++crossings;
    before = now;
  }
  EXPECT_NEAR(crossings, 64, 1);
}

TEST(PressIntent, DrawsPressAndSpeedFromTheSeedWithinTheirSpreads) {
  PatientParameters varied = test::steady_patient();
  varied.press_spread = 0.3;
  varied.approach_min = 0.03;
  varied.approach_max = 0.09;
  std::set<double> ends;
  double least = 1.0, most = 0.0, slowest = 1.0, fastest = 0.0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Case one(seed, varied);
    const double end = one.way(2.0) / kEnd;
    const double speed = (one.way(0.3) - one.way(0.2)) / 0.1;
    least = std::min(least, end);
    most = std::max(most, end);
    slowest = std::min(slowest, speed);
    fastest = std::max(fastest, speed);
    ends.insert(end);
  }
  EXPECT_GE(least, 0.7 - 1e-12);
  EXPECT_LT(least, 0.72);
  EXPECT_LE(most, 1.3 + 1e-12);
  EXPECT_GT(most, 1.28);
  EXPECT_GE(slowest, 0.03 - 1e-9);
  EXPECT_LT(slowest, 0.033);
  EXPECT_LE(fastest, 0.09 + 1e-9);
  EXPECT_GT(fastest, 0.087);
  EXPECT_EQ(ends.size(), 200U);
}

TEST(PressIntent, IsTheSameForTheSameSeed) {
  PatientParameters varied = test::steady_patient();
  varied.press_spread = 0.3;
  varied.tremor = 30e-6;
  const Case one(7, varied);
  const Case same(7, varied);
  const Case other(8, varied);
  for (const double t : {0.0, 0.5, 2.0, 5.0}) {
    EXPECT_EQ(one.intent.angle(t), same.intent.angle(t));
    EXPECT_NE(one.intent.angle(t), other.intent.angle(t));
  }
}

// With the PIP at most 0.1 rad below the contact, at 0.02 / 4 / 3.5e-4 rad/m, there is room for 7 mm.
TEST(PressIntent, ComesFromAsFarAsTheJointsReach) {
  HandParameters hand = test::simple_parameters();
  hand.min_angle[idx(kPip)] = 0.3;
  const Case one(1, test::steady_patient(), hand);
  EXPECT_NEAR(one.way(0.0), -7e-3, 1e-12);
  EXPECT_NEAR(one.way(kSchedule.end), -7e-3, 1e-12);
  for (int i = 0; i < 5300; ++i)
    ASSERT_GE(one.intent.angle(1e-3 * i)[idx(kPip)], 0.3 - 1e-12) << "t = " << 1e-3 * i;
}

// A joint that opens while it presses comes from the other end of its range.
TEST(PressIntent, ComesFromAsFarAsAJointThatOpensReaches) {
  Case one;
  one.plan.digit[kIndex]->into[idx(kPip)] *= -1.0;
  HandParameters hand = test::simple_parameters();
  hand.max_angle[idx(kPip)] = 0.5;
  const PressIntent intent(one.plan, one.patient, hand, kWall, kIntended, 1, kSchedule);
  EXPECT_NEAR(intent.angle(0.0)[idx(kPip)], 0.5, 1e-12);
}

TEST(PressIntent, StreamsOfASeedDoNotRepeatEachOther) {
  std::set<std::uint64_t> drawn;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    drawn.insert(seed);
    drawn.insert(sensor_seed(seed));
    EXPECT_GE(clock_phase(seed), 0.0);
    EXPECT_LT(clock_phase(seed), 1.0);
  }
  EXPECT_EQ(drawn.size(), 200U);
}

}  // namespace
}  // namespace phalanx
