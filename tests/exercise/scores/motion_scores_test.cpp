// SPDX-License-Identifier: Apache-2.0
// Scores of movement: the examples that docs/exercises.md calculates by hand, and where there is no score.
#include "phalanx/exercise/motion_scores.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

#include "exercise/scores/observed_steps.h"

namespace phalanx::test {
namespace {

using ::testing::HasSubstr;

constexpr int kIndexMcp = 4;

std::vector<Observation> with_angle(int joint, double interval, std::initializer_list<double> degrees) {
  return steps_with(interval, degrees,
                    [&](Observation& step, double angle) { step.angle[idx(joint)] = angle * kDeg; });
}

/// Two postures of the index finger's MCP, PIP and DIP joint, each held for 1 s [deg].
std::vector<Observation> two_postures(const std::array<double, 3>& open, const std::array<double, 3>& fist) {
  std::vector<Observation> steps;
  for (int i = 0; i <= 16; ++i) {
    steps.push_back(running_step(0.125 * i));
    const std::array<double, 3>& posture = i < 8 ? open : fist;
    const std::array<int, 3> joints = {joint_index(1, 0), joint_index(1, 2), joint_index(1, 3)};
    for (std::size_t k = 0; k < 3; ++k) steps.back().angle[idx(joints[k])] = posture[k] * kDeg;
  }
  return steps;
}

/// The index flexes by 60 deg, the other fingers by these shares of it.
std::vector<Observation> flexed_together(const std::array<double, 3>& shares) {
  return steps_with(1.0, {0.0, 30.0, 60.0}, [&](Observation& step, double angle) {
    step.angle[idx(kIndexMcp)] = angle * kDeg;
    for (int finger = 2; finger < kDigits; ++finger)
      step.angle[idx(joint_index(finger, 2))] = shares[idx(finger - 2)] * angle * kDeg;
  });
}

TEST(MotionScores, RangeOfMotionIsAsByHand) {
  const auto steps = with_angle(kIndexMcp, 0.125, {0, 0, 60, 60, 90, 60, 60});
  const RangeOfMotion task{.joints = {kIndexMcp}, .hold_time = 0.125, .calibration_independent = true};
  const auto scores = range_of_motion_scores(steps, task);
  EXPECT_NEAR(value_of(scores, "rom_index_mcp_flexion_deg"), 60.0, 1e-12);
  EXPECT_NEAR(value_of(scores, "max_index_mcp_flexion_deg"), 60.0, 1e-12);
  EXPECT_DOUBLE_EQ(value_of(scores, "min_index_mcp_flexion_deg"), 0.0);
  RangeOfMotion each_step = task;
  each_step.hold_time = 0.0;
  EXPECT_NEAR(value_of(range_of_motion_scores(steps, each_step), "rom_index_mcp_flexion_deg"), 90.0, 1e-12);
  EXPECT_THAT(
      reason_of(range_of_motion_scores(
                    steps, {.joints = {kIndexMcp}, .hold_time = 2.0, .calibration_independent = true}),
                "rom_index_mcp_flexion_deg"),
      HasSubstr("shorter than the hold of 2.00 s"));
}

TEST(MotionScores, WithoutJointsAllAreScored) {
  const auto scores = range_of_motion_scores(with_angle(kIndexMcp, 0.1, {0, 10, 20, 20, 20}),
                                             {.calibration_independent = true});
  EXPECT_EQ(scores.size(), 3U * kJoints);
  for (const Score& score : scores) EXPECT_TRUE(score.valid()) << score.name << ": " << score.invalid;
}

TEST(MotionScores, TotalActiveMotionIsAsByHand) {
  const TotalActiveMotion task{.digits = kIndexOnly, .calibration_independent = true};
  const auto scores = total_active_motion_scores(two_postures({0, 10, 10}, {45, 60, 40}), task);
  EXPECT_NEAR(value_of(scores, "flexion_index_deg"), 145.0, 1e-12);
  EXPECT_NEAR(value_of(scores, "deficit_index_deg"), 20.0, 1e-12);
  EXPECT_NEAR(value_of(scores, "tam_index_deg"), 125.0, 1e-12);
  const auto normal = total_active_motion_scores(two_postures({0, 0, 0}, {85, 110, 65}), task);
  EXPECT_NEAR(value_of(normal, "tam_index_deg"), 260.0, 1e-12) << "the normal value of the ASSH";
}

TEST(MotionScores, HyperextensionIsNoDeficit) {
  const TotalActiveMotion task{.digits = kIndexOnly, .calibration_independent = true};
  const auto scores = total_active_motion_scores(two_postures({-20, 5, 0}, {80, 90, 50}), task);
  EXPECT_NEAR(value_of(scores, "deficit_index_deg"), 5.0, 1e-12);
  EXPECT_NEAR(value_of(scores, "tam_index_deg"), 215.0, 1e-12);
}

TEST(MotionScores, TheThumbsTotalActiveMotionIsOfItsTwoHinges) {
  auto steps = with_angle(joint_index(0, 2), 0.125, {0, 0, 0, 50, 50, 50});
  for (Observation& step : steps) {
    step.angle[idx(joint_index(0, 0))] = 1.0;
    step.angle[idx(joint_index(0, 3))] = step.angle[idx(joint_index(0, 2))];
  }
  const auto scores = total_active_motion_scores(
      steps, {.digits = {true, false, false, false, false}, .calibration_independent = true});
  EXPECT_NEAR(value_of(scores, "tam_thumb_deg"), 100.0, 1e-12);
}

TEST(MotionScores, OppositionIsAsByHand) {
  auto steps = with_angle(kIndexMcp, 1.0, {0, 0, 0});
  steps[0].pad[1] = {0.03, 0.04, 0.0};
  steps[1].pad[1] = {0.0, 0.02, 0.0};
  steps[2].pad[1] = {0.03, 0.04, 0.0};
  for (Observation& step : steps) step.pad[2] = {0.0, 0.0, 0.05};
  const auto scores = opposition_scores(steps, {.calibration_independent = true});
  EXPECT_NEAR(value_of(scores, "opposition_index_mm"), 20.0, 1e-12);
  EXPECT_NEAR(value_of(scores, "opposition_middle_mm"), 50.0, 1e-12);
  EXPECT_NEAR(value_of(scores, "opposition_held_index_mm"), 50.0, 1e-12);
  EXPECT_NEAR(value_of(opposition_scores(steps, {.hold_time = 0.0, .calibration_independent = true}),
                       "opposition_held_index_mm"),
              20.0, 1e-12);
  EXPECT_THAT(reason_of(opposition_scores(steps, {.hold_time = 3.0, .calibration_independent = true}),
                        "opposition_held_index_mm"),
              HasSubstr("3"));
  steps[1].pad[1].x() = kNaN;
  EXPECT_THAT(reason_of(opposition_scores(steps, {.calibration_independent = true}), "opposition_index_mm"),
              HasSubstr("not finite at 1.000 s"));
}

TEST(MotionScores, IndependenceIsAsByHand) {
  const MotionIndependence task{.instructed = 1, .calibration_independent = true};
  const auto scores = motion_independence_scores(flexed_together({0.5, 0.0, 0.0}), task);
  EXPECT_NEAR(value_of(scores, "instructed_range_deg"), 60.0, 1e-12);
  EXPECT_NEAR(value_of(scores, "enslaving_middle"), 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(value_of(scores, "enslaving_ring"), 0.0);
  EXPECT_NEAR(value_of(scores, "individuation_index"), 1.0 - 0.5 / 3.0, 1e-12);
  const auto alone = motion_independence_scores(flexed_together({0.0, 0.0, 0.0}), task);
  EXPECT_NEAR(value_of(alone, "individuation_index"), 1.0, 1e-12) << "Schieber's ideal";
  const auto all = motion_independence_scores(flexed_together({1.0, 1.0, 1.0}), task);
  EXPECT_NEAR(value_of(all, "individuation_index"), 0.0, 1e-12);
  const auto against = motion_independence_scores(flexed_together({-0.5, 0.0, 0.0}), task);
  EXPECT_NEAR(value_of(against, "individuation_index"), 1.0 - 0.5 / 3.0, 1e-12)
      << "the direction does not count";
}

TEST(MotionScores, AnInstructedDigitThatHardlyMovesHasNoIndependence) {
  const auto scores = motion_independence_scores(with_angle(kIndexMcp, 1.0, {0, 5, 9}),
                                                 {.instructed = 1, .calibration_independent = true});
  EXPECT_NEAR(value_of(scores, "instructed_range_deg"), 9.0, 1e-12);
  EXPECT_THAT(reason_of(scores, "enslaving_middle"), HasSubstr("moved by 9.0 deg, less than 10.0 deg"));
  EXPECT_THAT(reason_of(scores, "individuation_index"), HasSubstr("moved by 9.0 deg"));
}

TEST(MotionScores, WithoutAnIndependentCalibrationNothingIsMeasured) {
  const auto steps = flexed_together({0.5, 0.0, 0.0});
  const std::string words = "not measured: the calibration depends on what the person can reach";
  expect_none(range_of_motion_scores(steps, {}), words);
  expect_none(total_active_motion_scores(steps, {}), words);
  expect_none(opposition_scores(steps, {}), words);
  expect_none(motion_independence_scores(steps, {}), words);
}

TEST(MotionScores, OnADeviceWhoseFingersCopyTheIndexTheirScoresAreNotMeasured) {
  auto steps = two_postures({0, 10, 10}, {45, 60, 40});
  for (Observation& step : steps)
    for (int finger = 2; finger < kDigits; ++finger)
      for (int i = 0; i < kJointsPerDigit; ++i) {
        step.angle[idx(joint_index(finger, i))] = step.angle[idx(joint_index(1, i))];
        step.angle_origin[idx(joint_index(finger, i))] = AngleOrigin::kCompleted;
      }
  const auto expect_of_followers_none = [](const std::vector<Score>& scores) {
    for (const Score& score : scores) {
      const bool follows = score.name.find("middle") != std::string::npos ||
                           score.name.find("ring") != std::string::npos ||
                           score.name.find("little") != std::string::npos;
      EXPECT_EQ(score.valid(), !follows) << score.name << ": " << score.invalid;
      if (follows) {
        EXPECT_THAT(score.invalid, HasSubstr("not measured: the angle of "));
      }
    }
  };
  expect_of_followers_none(range_of_motion_scores(steps, {.calibration_independent = true}));
  expect_of_followers_none(total_active_motion_scores(
      steps, {.digits = {true, true, true, true, true}, .calibration_independent = true}));
  expect_of_followers_none(opposition_scores(steps, {.calibration_independent = true}));
  const auto shares = motion_independence_scores(steps, {.instructed = 1, .calibration_independent = true});
  EXPECT_THAT(reason_of(shares, "enslaving_little"), HasSubstr("is completed"));
  EXPECT_THAT(reason_of(shares, "individuation_index"), HasSubstr("is completed"));
  expect_none(motion_independence_scores(steps, {.instructed = 2, .calibration_independent = true}),
              "not measured: the angle of middle_mcp_flexion is completed");
}

TEST(MotionScores, EachOriginButASensorIsNotMeasured) {
  for (const AngleOrigin origin :
       {AngleOrigin::kUnknown, AngleOrigin::kCompleted, AngleOrigin::kFixed, AngleOrigin::kScripted}) {
    auto steps = with_angle(kIndexMcp, 0.1, {0, 10, 20, 30});
    steps[2].angle_origin[idx(kIndexMcp)] = origin;  // in a single step
    expect_none(range_of_motion_scores(steps, {.joints = {kIndexMcp}, .calibration_independent = true}),
                "not measured: the angle of index_mcp_flexion is " + std::string(angle_origin_name(origin)));
  }
}

TEST(MotionScores, ATaskOutsideItsBoundsIsRefused) {
  const auto steps = with_angle(kIndexMcp, 0.1, {0, 10, 20});
  for (const int joint : {-1, kJoints})
    EXPECT_THROW(static_cast<void>(range_of_motion_scores(steps, {.joints = {joint}})),
                 std::invalid_argument);
  for (const double hold : {-1.0, kNaN, 1e9}) {
    EXPECT_THROW(static_cast<void>(range_of_motion_scores(steps, {.hold_time = hold})),
                 std::invalid_argument);
    EXPECT_THROW(static_cast<void>(total_active_motion_scores(steps, {.hold_time = hold})),
                 std::invalid_argument);
  }
  EXPECT_THROW(static_cast<void>(total_active_motion_scores(steps, {.digits = {}})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(opposition_scores(steps, {.fingers = {true, false, false, false, false}})),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(motion_independence_scores(steps, {.instructed = 0})),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(motion_independence_scores(steps, {.instructed = 1, .digits = kIndexOnly})),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(motion_independence_scores(steps, {.least_range = kNaN})),
               std::invalid_argument);
}

}  // namespace
}  // namespace phalanx::test
