// SPDX-License-Identifier: Apache-2.0
// Scores of forces: the examples that docs/exercises.md calculates by hand, and where there is no score.
#include "phalanx/exercise/force_scores.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "exercise/scores/observed_steps.h"

namespace phalanx::test {
namespace {

using ::testing::HasSubstr;

std::vector<double> targets(const std::vector<Observation>& steps, double (*at)(double)) {
  std::vector<double> target;
  for (const Observation& step : steps) target.push_back(at(step.time));
  return target;
}

double two_sines(double t) { return 3.0 + std::sin(1.3 * t) + 0.7 * std::sin(2.9 * t); }

/// 10 s at 100 Hz, with the force two_sines(t - delay).
std::vector<Observation> delayed(double delay) {
  std::vector<Observation> steps;
  for (int i = 0; i <= 1000; ++i) {
    steps.push_back(running_step(0.01 * i));
    steps.back().force[1] = two_sines(steps.back().time - delay);
  }
  return steps;
}

/// Both digits touch with these forces of thumb and index, a pair for each second.
std::vector<Observation> pinched(std::initializer_list<std::pair<double, double>> forces) {
  std::vector<Observation> steps;
  for (const auto& [thumb, index] : forces) {
    steps.push_back(running_step(static_cast<double>(steps.size())));
    steps.back().force[0] = thumb;
    steps.back().force[1] = index;
    steps.back().touching[0] = steps.back().touching[1] = true;
  }
  return steps;
}

TEST(ForceScores, PressAndHoldIsAsByHand) {
  const auto steps = steps_with_force(1.0, {0.0, 1.0, 2.0, 3.0, 3.0});
  const auto scores =
      press_and_hold_scores(steps, {.digits = kIndexOnly, .target = 2.0, .settle_time = 0.0}, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(scores, "mean_force_n"), 1.5);
  EXPECT_DOUBLE_EQ(value_of(scores, "sd_force_n"), std::sqrt(1.25));
  EXPECT_DOUBLE_EQ(value_of(scores, "cv"), std::sqrt(1.25) / 1.5);
  EXPECT_DOUBLE_EQ(value_of(scores, "time_in_target_s"), 1.0);
  EXPECT_DOUBLE_EQ(value_of(scores, "time_in_target_share"), 0.25);
  EXPECT_DOUBLE_EQ(value_of(scores, "rise_time_s"), 1.0);
  EXPECT_EQ(score_of(scores, "mean_force_n").origin, ScoreOrigin::kRendered);
}

TEST(ForceScores, TimeToSettleDoesNotCount) {
  const auto steps = steps_with_force(1.0, {0.0, 1.0, 2.0, 4.0, 9.0});
  const auto scores =
      press_and_hold_scores(steps, {.digits = kIndexOnly, .target = 2.0, .settle_time = 2.0}, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(scores, "mean_force_n"), 3.0);
  EXPECT_DOUBLE_EQ(value_of(scores, "time_in_target_share"), 0.5);
  EXPECT_DOUBLE_EQ(value_of(scores, "rise_time_s"), 1.0) << "the rise is before";
  expect_none(
      press_and_hold_scores(steps, {.digits = kIndexOnly, .target = 2.0, .settle_time = 4.0}, kAllFelt),
      "not longer than the 4.00 s to settle");
}

TEST(ForceScores, AStepCountsForItsOwnDuration) {
  auto steps = steps_with_force(1.0, {1.0, 5.0, 5.0});
  steps[1].time = 9.0;  // 1 N for 9 s, 5 N for 1 s
  steps[2].time = 10.0;
  const auto scores =
      press_and_hold_scores(steps, {.digits = kIndexOnly, .target = 1.0, .settle_time = 0.0}, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(scores, "mean_force_n"), 1.4);
  EXPECT_DOUBLE_EQ(value_of(scores, "time_in_target_share"), 0.9);
}

TEST(ForceScores, ARiseThatCannotBeSeenHasNoTime) {
  const PressAndHold task{.digits = kIndexOnly, .target = 2.0, .settle_time = 0.0};
  const auto early = press_and_hold_scores(steps_with_force(1.0, {2.0, 2.0, 2.0}), task, kAllFelt);
  EXPECT_THAT(reason_of(early, "rise_time_s"), HasSubstr("when the trial began"));
  EXPECT_DOUBLE_EQ(value_of(early, "mean_force_n"), 2.0);
  const auto weak = press_and_hold_scores(steps_with_force(1.0, {0.0, 1.0, 1.0}), task, kAllFelt);
  EXPECT_THAT(reason_of(weak, "rise_time_s"), HasSubstr("never reached 90 %"));
  const auto idle = press_and_hold_scores(steps_with_force(1.0, {0.0, 0.0, 0.0}), task, kAllFelt);
  EXPECT_THAT(reason_of(idle, "cv"), HasSubstr("not above 0"));
  EXPECT_DOUBLE_EQ(value_of(idle, "sd_force_n"), 0.0);
}

TEST(ForceScores, ForcesOfDigitsAreAdded) {
  auto steps = steps_with_force(1.0, {0.0, 1.0, 1.0});
  for (Observation& step : steps) step.force[3] = 2.0 * step.force[1];
  const auto scores = press_and_hold_scores(
      steps, {.digits = {false, true, false, true, false}, .target = 3.0, .settle_time = 1.0}, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(scores, "mean_force_n"), 3.0);
}

TEST(ForceScores, TrackingErrorIsAsByHand) {
  const auto steps = steps_with_force(1.0, {1.0, 1.0, 5.0});
  const std::vector<double> target = {1.0, 2.0, 3.0};
  const auto scores = force_tracking_scores(steps, target, {.digits = kIndexOnly}, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(scores, "rmse_n"), std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(value_of(scores, "rrmse"), std::sqrt(0.5) / 3.0);
  EXPECT_DOUBLE_EQ(value_of(scores, "time_in_target_s"), 1.0);
  EXPECT_DOUBLE_EQ(value_of(scores, "time_in_target_share"), 0.5);
}

TEST(ForceScores, ACopyThatComesLaterHasItsDelayAsLag) {
  for (const double delay : {0.2, 0.0, -0.1}) {
    const auto steps = delayed(delay);
    const auto scores =
        force_tracking_scores(steps, targets(steps, two_sines), {.digits = kIndexOnly}, kAllFelt);
    EXPECT_NEAR(value_of(scores, "lag_s"), delay, 1e-3);
    EXPECT_NEAR(value_of(scores, "correlation"), 1.0, 1e-9);
  }
}

TEST(ForceScores, ALagIsFoundBetweenTheSignalsPoints) {
  const auto steps = delayed(0.1237);
  const auto scores =
      force_tracking_scores(steps, targets(steps, two_sines), {.digits = kIndexOnly}, kAllFelt);
  EXPECT_NEAR(value_of(scores, "lag_s"), 0.1237, 1e-3);
}

TEST(ForceScores, WithoutMotionOfTargetOrForceThereIsNoLag) {
  auto steps = delayed(0.2);
  const std::vector<double> still(steps.size(), 2.0);
  EXPECT_THAT(reason_of(force_tracking_scores(steps, still, {.digits = kIndexOnly}, kAllFelt), "lag_s"),
              HasSubstr("the target does not move"));
  const auto target = targets(steps, two_sines);
  for (Observation& step : steps) step.force[1] = 1.0;
  EXPECT_THAT(
      reason_of(force_tracking_scores(steps, target, {.digits = kIndexOnly}, kAllFelt), "correlation"),
      HasSubstr("the force does not change"));
  EXPECT_THAT(
      reason_of(force_tracking_scores(steps, target, {.digits = kIndexOnly, .longest_lag = 6.0}, kAllFelt),
                "lag_s"),
      HasSubstr("shorter than twice the longest lag"));
}

TEST(ForceScores, SqueezeAndReleaseIsAsByHand) {
  const auto steps = steps_with_force(0.1, {0.0, 5.0, 10.0, 9.0, 4.0, 0.5});
  const auto scores =
      squeeze_and_release_scores(steps, {.digits = kIndexOnly, .release_cue = 0.25}, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(scores, "peak_force_n"), 10.0);
  EXPECT_NEAR(value_of(scores, "rise_time_s"), 0.1, 1e-12);
  EXPECT_NEAR(value_of(scores, "release_time_s"), 0.1, 1e-12);
  EXPECT_NEAR(value_of(scores, "release_delay_s"), 0.25, 1e-12);
}

TEST(ForceScores, TheLevelsThemselvesCountAsReached) {
  // Of a peak of 10 N the levels are 1 N and 9 N.
  const auto steps = steps_with_force(1.0, {0.0, 0.99, 1.0, 5.0, 8.99, 9.0, 10.0, 9.0, 8.99, 1.0, 0.99, 0.0});
  const auto scores = squeeze_and_release_scores(steps, {.digits = kIndexOnly}, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(scores, "rise_time_s"), 3.0) << "from 2 s to 5 s";
  EXPECT_DOUBLE_EQ(value_of(scores, "release_time_s"), 2.0) << "from 8 s to 10 s";
}

TEST(ForceScores, TheBandsEndsBelongToIt) {
  const auto steps = steps_with_force(1.0, {0.0, 1.0, 3.0, 3.5, 0.0});  // 2 N +- 1 N
  const auto scores = press_and_hold_scores(
      steps, {.digits = kIndexOnly, .target = 2.0, .tolerance = 0.5, .settle_time = 1.0}, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(scores, "time_in_target_s"), 2.0);
  EXPECT_DOUBLE_EQ(value_of(scores, "time_in_target_share"), 2.0 / 3.0);
}

TEST(ForceScores, AHandThatDoesNotLetGoHasNoReleaseTime) {
  const auto held = squeeze_and_release_scores(steps_with_force(0.1, {0.0, 5.0, 10.0, 10.0, 4.0}),
                                               {.digits = kIndexOnly, .release_cue = 0.2}, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(held, "peak_force_n"), 10.0);
  EXPECT_THAT(reason_of(held, "release_time_s"), HasSubstr("did not fall below 10 %"));
  EXPECT_THAT(reason_of(held, "release_delay_s"), HasSubstr("did not fall below 10 %"));
  const auto early = squeeze_and_release_scores(steps_with_force(0.1, {0.0, 10.0, 0.0, 0.0, 0.0}),
                                                {.digits = kIndexOnly, .release_cue = 0.35}, kAllFelt);
  EXPECT_THAT(reason_of(early, "release_delay_s"), HasSubstr("before the cue"));
  const auto weak =
      squeeze_and_release_scores(steps_with_force(0.1, {0.0, 0.3, 0.0}), {.digits = kIndexOnly}, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(weak, "peak_force_n"), 0.3);
  EXPECT_THAT(reason_of(weak, "rise_time_s"), HasSubstr("is below 0.50 N"));
}

TEST(ForceScores, PinchIsAsByHand) {
  const auto scores =
      pinch_scores(pinched({{0, 0}, {1, 2}, {2, 2}, {2, 3}, {0, 0}}), {.finger = 1}, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(scores, "hold_time_s"), 3.0);
  EXPECT_DOUBLE_EQ(value_of(scores, "grip_force_n"), 5.0 / 3.0);
  EXPECT_DOUBLE_EQ(value_of(scores, "force_ratio"), 1.4);
  EXPECT_DOUBLE_EQ(value_of(scores, "slips"), 0.0);
}

TEST(ForceScores, TheLongestHoldCounts) {
  const auto steps = pinched({{1, 1}, {0, 0}, {4, 2}, {4, 2}, {0, 9}, {1, 1}});
  const auto scores = pinch_scores(steps, {.finger = 1}, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(scores, "hold_time_s"), 2.0);
  EXPECT_DOUBLE_EQ(value_of(scores, "force_ratio"), 0.5);
  const auto equal = pinch_scores(pinched({{2, 1}, {0, 0}, {1, 1}, {0, 0}}), {.finger = 1}, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(equal, "force_ratio"), 0.5) << "of equal holds the first";
  const auto least = pinch_scores(pinched({{0.2, 0.2}, {0.19, 1}, {1, 0.19}}), {.finger = 1}, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(least, "hold_time_s"), 1.0) << "each digit must press with 0.2 N";
  auto apart = steps;
  for (Observation& step : apart) step.touching[0] = false;
  const auto none = pinch_scores(apart, {.finger = 1}, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(none, "hold_time_s"), 0.0);
  EXPECT_THAT(reason_of(none, "force_ratio"), HasSubstr("never held"));
}

TEST(ForceScores, APinchInWhichTheObjectSlipsIsInvalid) {
  auto steps = pinched({{1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}});
  steps[1].slips[2] = true;  // another finger
  EXPECT_DOUBLE_EQ(value_of(pinch_scores(steps, {.finger = 1}, kAllFelt), "hold_time_s"), 4.0);
  steps[2].slips[1] = true;
  expect_none(pinch_scores(steps, {.finger = 1}, kAllFelt), "the object slipped once, first at 2.000 s");
  steps[1].slips[1] = steps[4].slips[0] = true;
  expect_none(pinch_scores(steps, {.finger = 1}, kAllFelt), "the object slipped 2 times, first at 1.000 s");
}

TEST(ForceScores, ADigitThatSlidesWithoutHoldingDoesNotSlip) {
  auto steps = pinched({{0.1, 1}, {0.19, 1}, {1, 1}, {1, 1}});
  steps[0].slips[0] = steps[1].slips[0] = true;
  EXPECT_DOUBLE_EQ(value_of(pinch_scores(steps, {.finger = 1}, kAllFelt), "hold_time_s"), 1.0);
  steps[2].slips[0] = true;
  expect_none(pinch_scores(steps, {.finger = 1}, kAllFelt), "the object slipped once, first at 2.000 s");
}

TEST(ForceScores, ADigitThatCopiesAnotherIsNotMeasured) {
  const DigitFlags felt = {true, true, false, false, false};
  const auto steps = steps_with_force(1.0, {0.0, 2.0, 2.0});
  for (int digit = 2; digit < kDigits; ++digit) {
    DigitFlags digits = kIndexOnly;
    digits[idx(digit)] = true;
    const std::string words = "not measured: the device has no sensor and motor of the digit ";
    expect_none(press_and_hold_scores(steps, {.digits = digits, .target = 2.0}, felt), words);
    expect_none(force_tracking_scores(steps, std::vector<double>(3, 1.0), {.digits = digits}, felt), words);
    expect_none(squeeze_and_release_scores(steps, {.digits = digits}, felt), words);
    expect_none(pinch_scores(steps, {.finger = digit}, felt), words);
  }
}

TEST(ForceScores, TheOriginIsMeasuredOnlyWithSensorsOfAllDigits) {
  auto steps = steps_with_force(1.0, {0.0, 2.0, 2.0});
  for (Observation& step : steps) step.measured_force[1] = 3.0 * step.force[1];
  const PressAndHold one{.digits = kIndexOnly, .target = 6.0, .settle_time = 0.0};
  const auto sensed = press_and_hold_scores(steps, one, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(sensed, "mean_force_n"), 3.0);
  for (const Score& score : sensed) EXPECT_EQ(score.origin, ScoreOrigin::kMeasured) << score.name;
  PressAndHold two = one;
  two.digits[2] = true;
  const auto mixed = press_and_hold_scores(steps, two, kAllFelt);
  EXPECT_DOUBLE_EQ(value_of(mixed, "mean_force_n"), 1.0) << "as sent";
  for (const Score& score : mixed) EXPECT_EQ(score.origin, ScoreOrigin::kRendered) << score.name;
  steps[1].measured_force[1] = kNaN;
  expect_none(press_and_hold_scores(steps, one, kAllFelt), "has no value in 1 of 3 steps");
}

TEST(ForceScores, TorquesMustBeOnAndNotRamped) {
  auto steps = steps_with_force(1.0, {0.0, 2.0, 2.0});
  const PressAndHold task{.digits = kIndexOnly, .target = 2.0, .settle_time = 0.0};
  steps[2].factor = 0.5;
  expect_none(press_and_hold_scores(steps, task, kAllFelt),
              "the torques were ramped at 2.000 s (factor 0.50)");
  steps[1].torque_on = false;
  expect_none(press_and_hold_scores(steps, task, kAllFelt), "the torques were off at 1.000 s");
}

TEST(ForceScores, ATaskOutsideItsBoundsIsRefused) {
  const auto steps = steps_with_force(1.0, {0.0, 2.0, 2.0});
  const std::vector<double> target(3, 1.0);
  for (const double bad : {-1.0, 0.0, kNaN, kInfinity}) {
    EXPECT_THROW(
        static_cast<void>(press_and_hold_scores(steps, {.digits = kIndexOnly, .target = bad}, kAllFelt)),
        std::invalid_argument);
    EXPECT_THROW(static_cast<void>(force_tracking_scores(
                     steps, target, {.digits = kIndexOnly, .longest_lag = bad}, kAllFelt)),
                 std::invalid_argument);
    EXPECT_THROW(static_cast<void>(
                     squeeze_and_release_scores(steps, {.digits = kIndexOnly, .least_peak = bad}, kAllFelt)),
                 std::invalid_argument);
    EXPECT_THROW(static_cast<void>(pinch_scores(steps, {.least_force = bad}, kAllFelt)),
                 std::invalid_argument);
  }
  EXPECT_THROW(static_cast<void>(press_and_hold_scores(steps, {.digits = {}, .target = 1.0}, kAllFelt)),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(press_and_hold_scores(
                   steps, {.digits = kIndexOnly, .target = 1.0, .tolerance = kNaN}, kAllFelt)),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(force_tracking_scores(steps, std::vector<double>(2, 1.0),
                                                       {.digits = kIndexOnly}, kAllFelt)),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(force_tracking_scores(steps, std::vector<double>(3, kNaN),
                                                       {.digits = kIndexOnly}, kAllFelt)),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(
                   squeeze_and_release_scores(steps, {.digits = kIndexOnly, .release_cue = kNaN}, kAllFelt)),
               std::invalid_argument);
  for (const int finger : {-1, 0, 5})
    EXPECT_THROW(static_cast<void>(pinch_scores(steps, {.finger = finger}, kAllFelt)), std::invalid_argument);
}

}  // namespace
}  // namespace phalanx::test
