// SPDX-License-Identifier: Apache-2.0
// The guard by itself: how far an angle may go after a gap, whose clock is believed, which digits are
// measured.
#include "step/sample_guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "phalanx/core/constants.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

constexpr double kGuardPeriod = 0.005;
constexpr std::size_t kGuardJoint = 6;  // index_pip_flexion, -0.5 .. 2 rad

/// A guard whose joints follow at 10 rad/s: 0.05 rad a period, 0.5 rad in 50 ms.
class Guarded {
 public:
  Guarded() { limits_.joint_speed = 10.0; }

  /// One sample with this angle on every joint, cut to what each can do.
  Status at(double time_s, double angle) {
    Sample sample;
    sample.time_s = time_s;
    for (std::size_t j = 0; j < kJoints; ++j)
      sample.angle[j] =
          std::isfinite(angle) ? std::clamp(angle, hand_.min_angle[j], hand_.max_angle[j]) : angle;
    return take(sample);
  }
  Status take(const Sample& sample) { return guard.accept(sample, hand_, limits_, kGuardPeriod); }
  [[nodiscard]] double angle() const { return guard.angle()[kGuardJoint]; }

  SampleGuard guard{JointArray{}};

 private:
  HandParameters hand_ = test::simple_parameters();
  LimitParameters limits_;
};

// The clock may be set forward by an hour: the angle is slewed over 50 ms of it at most, 0.5 rad.
TEST(SampleGuard, SlewsOverAtMostFiftyMillisecondsHoweverLongTheGap) {
  for (const double gap : {0.0501, 0.2, 3600.0, 1e12}) {
    for (const double sign : {1.0, -1.0}) {
      Guarded hand;
      const double from = sign > 0.0 ? 0.0 : 1.5;
      hand.at(1.0, from);
      EXPECT_TRUE(has(hand.at(1.0 + gap, from + sign * 1.5), Status::kSampleJump)) << gap;
      EXPECT_NEAR(hand.angle(), from + sign * 0.5, 1e-12) << gap;
    }
  }
}

// Between one period and 50 ms it is the time itself: 20 ms are 0.2 rad.
TEST(SampleGuard, SlewsOverTheTimeSinceTheLastSample) {
  Guarded hand;
  hand.at(1.0, 0.0);
  EXPECT_TRUE(has(hand.at(1.02, 1.5), Status::kSampleJump));
  EXPECT_NEAR(hand.angle(), 0.2, 1e-9);
  EXPECT_TRUE(has(hand.at(1.04, -0.5), Status::kSampleJump));
  EXPECT_NEAR(hand.angle(), 0.0, 1e-9);
  EXPECT_FALSE(has(hand.at(1.06, 0.15), Status::kSampleJump));
  EXPECT_NEAR(hand.angle(), 0.15, 1e-15);
}

// Samples of a device that is faster than the loop have 1 ms between them, and the loop's period counts.
TEST(SampleGuard, SlewsOverAPeriodAtLeast) {
  Guarded hand;
  hand.at(1.0, 0.0);
  hand.at(1.001, 1.5);
  EXPECT_NEAR(hand.angle(), 0.05, 1e-12);
}

// At 8 Hz a period is longer than 50 ms and counts as a whole, also where the sample is 5 ms late: 1.25 rad.
TEST(SampleGuard, SlewsOverTheWholePeriodOfASlowLoop) {
  const HandParameters hand = test::simple_parameters();
  LimitParameters limits;
  limits.joint_speed = 10.0;
  SampleGuard guard{JointArray{}};
  Sample sample;
  sample.time_s = 1.0;
  guard.accept(sample, hand, limits, 0.125);
  sample.time_s = 1.13;
  sample.angle[kGuardJoint] = 1.5;
  EXPECT_TRUE(has(guard.accept(sample, hand, limits, 0.125), Status::kSampleJump));
  EXPECT_NEAR(guard.angle()[kGuardJoint], 1.25, 1e-12);
}

// After a device's restart its clock begins at 0: since the last sample that was used time has run backwards,
// which counts as one period.
TEST(SampleGuard, SlewsOverAPeriodWhereTheClockHasBegunAgain) {
  Guarded hand;
  hand.at(1000.0, 0.0);
  for (int n = 1; n <= 4; ++n) EXPECT_TRUE(has(hand.at(0.005 * n, 1.5), Status::kTimeNotIncreasing));
  EXPECT_EQ(hand.angle(), 0.0);
  EXPECT_FALSE(has(hand.at(0.025, 1.5), Status::kTimeNotIncreasing));
  EXPECT_NEAR(hand.angle(), 0.05, 1e-12);
}

// Five in a row: a time that does not increase among the refused ones begins a new row.
TEST(SampleGuard, FollowsAClockThatRestartedOnlyWhereItsTimesIncreaseAmongThemselves) {
  Guarded hand;
  hand.at(1000.0, 0.0);
  for (int n = 0; n < 50; ++n) EXPECT_TRUE(has(hand.at(1.0, 1.5), Status::kTimeNotIncreasing)) << "it stands";
  for (int n = 0; n < 50; ++n)
    EXPECT_TRUE(has(hand.at(900.0 - n, 1.5), Status::kTimeNotIncreasing)) << "it runs backwards";
  for (const double time : {1.0, 2.0, 3.0, 4.0, 4.0, 5.0, 6.0})
    EXPECT_TRUE(has(hand.at(time, 1.5), Status::kTimeNotIncreasing)) << time;
  // The second 4 began a new row, of which 5 is the first to be later: 7 is the third, 9 the fifth.
  EXPECT_TRUE(has(hand.at(7.0, 1.5), Status::kTimeNotIncreasing));
  EXPECT_TRUE(has(hand.at(8.0, 1.5), Status::kTimeNotIncreasing));
  EXPECT_FALSE(has(hand.at(9.0, 1.5), Status::kTimeNotIncreasing));
}

// Five in a row: a sample of the old clock between them ends the row, and the next row begins with any time.
TEST(SampleGuard, FollowsNoClockWhoseSamplesAreMixedWithThoseOfTheOldOne) {
  Guarded hand;
  hand.at(1000.0, 0.0);
  for (const double time : {1.0, 2.0, 3.0})
    EXPECT_TRUE(has(hand.at(time, 1.5), Status::kTimeNotIncreasing)) << time;
  EXPECT_FALSE(has(hand.at(1000.005, 0.0), Status::kTimeNotIncreasing));
  for (const double time : {4.0, 5.0, 6.0, 7.0})
    EXPECT_TRUE(has(hand.at(time, 1.5), Status::kTimeNotIncreasing)) << time;
  EXPECT_EQ(hand.angle(), 0.0);
  EXPECT_FALSE(has(hand.at(8.0, 1.5), Status::kTimeNotIncreasing)) << "the fifth in a row";
  for (const double time : {6.0, 7.0})
    EXPECT_TRUE(has(hand.at(time, 1.5), Status::kTimeNotIncreasing)) << time;
  EXPECT_FALSE(has(hand.at(9.0, 1.5), Status::kTimeNotIncreasing));
  for (const double time : {1.0, 2.0, 3.0, 4.0})
    EXPECT_TRUE(has(hand.at(time, 1.5), Status::kTimeNotIncreasing)) << time;
  EXPECT_FALSE(has(hand.at(5.0, 1.5), Status::kTimeNotIncreasing)) << "the first of a row may be any time";
}

TEST(SampleGuard, BelievesNoClockThatIsNotANumber) {
  Guarded hand;
  for (const double time : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity})
    for (int n = 0; n < 10; ++n) EXPECT_TRUE(has(hand.at(time, 1.5), Status::kTimeNotIncreasing));
  EXPECT_EQ(hand.angle(), 0.0);
  EXPECT_EQ(hand.guard.time_s(), 0.0) << "no sample has been used yet";
  EXPECT_FALSE(has(hand.at(-5.0, 1.5), Status::kTimeNotIncreasing)) << "the first of all may be any number";
  EXPECT_EQ(hand.angle(), 1.5) << "and is not slewed";
  EXPECT_EQ(hand.guard.time_s(), -5.0);
}

// A digit is measured once each of its four joints has had a good sample, also not all in the same one.
TEST(SampleGuard, SaysThatADigitIsMeasuredOnceAllItsFourJointsAre) {
  for (std::size_t missing = 0; missing < kJoints; ++missing) {
    Guarded hand;
    Sample sample;
    sample.time_s = 1.0;
    sample.angle[missing] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(has(hand.take(sample), Status::kSampleNotFinite));
    for (std::size_t d = 0; d < kDigits; ++d)
      EXPECT_EQ(hand.guard.measured()[d], d != missing / kJointsPerDigit) << missing << " " << d;
    sample.angle.fill(std::numeric_limits<double>::quiet_NaN());
    sample.angle[missing] = 0.1;
    sample.time_s = 2.0;
    hand.take(sample);
    for (const bool measured : hand.guard.measured()) EXPECT_TRUE(measured);
    EXPECT_EQ(hand.guard.angle()[missing], 0.1) << "its first good sample is not slewed";
  }
}

// 50 ms are 10 periods: the eleventh without a whole sample is stale, and a whole one ends it at once.
TEST(SampleGuard, IsStaleOverFiftyMillisecondsAfterTheLastWholeSample) {
  for (const bool bad_clock : {true, false}) {
    Guarded hand;
    hand.at(1.0, 0.3);
    EXPECT_FALSE(hand.guard.stale());
    Sample sample;
    sample.angle[0] = std::numeric_limits<double>::quiet_NaN();
    for (int n = 1; n <= 15; ++n) {
      sample.time_s = bad_clock ? 0.0 : 1.0 + 0.005 * n;
      const Status status = hand.take(sample);
      EXPECT_EQ(hand.guard.stale(), n > 10) << n;
      EXPECT_EQ(has(status, Status::kSampleStale), n > 10) << n;
    }
    EXPECT_FALSE(has(hand.at(2.0, 0.3), Status::kSampleStale));
    EXPECT_FALSE(hand.guard.stale());
  }
}

// Two periods of 25 ms are 50 ms, which is not over them; they begin with the guard.
TEST(SampleGuard, IsNotStaleAtFiftyMillisecondsThemselvesAlsoBeforeTheFirstWholeSample) {
  const HandParameters hand = test::simple_parameters();
  const LimitParameters limits;
  SampleGuard guard{JointArray{}};
  EXPECT_FALSE(guard.stale());
  Sample sample;
  sample.angle[0] = std::numeric_limits<double>::quiet_NaN();
  for (int n = 1; n <= 3; ++n) {
    sample.time_s = 0.025 * n;
    const Status status = guard.accept(sample, hand, limits, 0.025);
    EXPECT_EQ(guard.stale(), n > 2) << n;
    EXPECT_EQ(has(status, Status::kSampleStale), n > 2) << n;
  }
}

TEST(SampleGuard, PassesMeasuredChannelsOnlyOfASampleThatIsUsed) {
  Sample sample;
  for (std::size_t j = 0; j < kJoints; ++j) sample.measured_torque[j] = 0.25 * static_cast<double>(j);
  for (std::size_t d = 0; d < kDigits; ++d) sample.measured_force[d] = 2.0 + static_cast<double>(d);
  sample.measured_torque[4] = -kInfinity;
  Snapshot snapshot;
  pass_measured(sample, Status::kSampleOutOfRange, snapshot);
  for (std::size_t j = 0; j < kJoints; ++j) {
    if (j != 4) {
      EXPECT_EQ(snapshot.measured_torque[j], 0.25 * static_cast<double>(j)) << j;
    }
  }
  EXPECT_TRUE(std::isnan(snapshot.measured_torque[4]));
  EXPECT_EQ(snapshot.measured_force, sample.measured_force);
  pass_measured(sample, Status::kTimeNotIncreasing | Status::kSampleStale, snapshot);
  EXPECT_EQ(snapshot.stiffness_factor, 1.0) << "what comes after them in the snapshot is left alone";
  for (const double torque : snapshot.measured_torque) EXPECT_TRUE(std::isnan(torque));
  for (const double force : snapshot.measured_force) EXPECT_TRUE(std::isnan(force));
}

}  // namespace
}  // namespace phalanx
