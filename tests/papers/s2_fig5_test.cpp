// SPDX-License-Identifier: Apache-2.0
// S2 fig. 5 in closed loop: a power grasp of the teapot at 1.4 N/mm with +-0.1 N a step.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "papers/s2_experiments.h"
#include "papers/s2_loop_figures.h"
#include "phalanx/scene/scene_trial.h"
#include "phalanx/simulation/closed_loop/trial.h"
#include "phalanx/simulation/simulated_exoskeleton.h"

namespace phalanx {
namespace {

constexpr double kFig5AsItIs = std::numeric_limits<double>::quiet_NaN();

TEST(S2Fig5, GraspsWithFivePhalangesAndIsSteady) {
  const LoopRun run = run_s2_fig5(kLoopSeeds);
  EXPECT_DOUBLE_EQ(run.stiffness, 1400.0);
  EXPECT_GE(run.curves.touching.size(), 5U);
  std::set<int> digits;
  for (const int segment : run.curves.touching) digits.insert(digit_of_segment(segment));
  EXPECT_EQ(digits, (std::set<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(run.stable(), kLoopSeeds);
  for (const TrialResult& trial : run.trials) EXPECT_TRUE(trial.valid) << trial.why_invalid;
  EXPECT_LE(run.largest_force_swing(), 0.5);
  EXPECT_LE(run.largest_position_swing(), 0.5e-3);
  // The three digits that copy the index have no motor of their own: more than 0.01 Nm of what is asked of
  // them is not rendered, at one joint each at least.
  for (int digit = 2; digit < kDigits; ++digit) {
    const auto* const first = &run.unrendered[static_cast<std::size_t>(joint_index(digit, 0))];
    EXPECT_GT(*std::max_element(first, first + kJointsPerDigit), 0.01) << digit_name(digit);
  }
}

TEST(LoopRun, ATouchCountsHoweverLightItIs) {
  const LoopRun run = run_loop("soft", "stability_press", {{"force.stiffness_n_per_mm", "0.02"}}, 1);
  std::vector<int> pressed;
  double largest = 0.0;
  for (int s = 0; s < kSegments; ++s) {
    const std::vector<double>& force = run.curves.force[static_cast<std::size_t>(s)];
    const double peak = *std::max_element(force.begin(), force.end());
    if (peak > 0.0) pressed.push_back(s);
    largest = std::max(largest, peak);
  }
  EXPECT_EQ(run.curves.touching, pressed);
  EXPECT_FALSE(pressed.empty());
  EXPECT_LT(largest, 1.0) << "N";
}

// Middle, ring and little finger copy the index: what their contacts ask for is recorded and felt by nobody.
TEST(S2Fig5, RendersIndexAndThumbAndNeverTheDigitsThatCopy) {
  const auto setup = make_trial_setup(load_scene("stability_grasp"));
  std::array<double, kDigits> asked{};  // largest, of a digit's joints [Nm]
  double forgone = 0.0;                 // largest of what index and thumb do not get [Nm]
  bool saturated = false;
  (void)run_trial(*setup, kFig5AsItIs, kFig5AsItIs, 1,
                  [&](double, const Snapshot&, const SimulatedExoskeleton& device) {
                    const Rendered& rendered = device.rendered();
                    saturated = saturated || rendered.saturated;
                    for (std::size_t j = 0; j < kJoints; ++j) {
                      const auto digit = static_cast<std::size_t>(digit_of_joint(static_cast<int>(j)));
                      asked[digit] = std::max(asked[digit], std::abs(rendered.asked[j]));
                      if (digit < 2) {
                        forgone = std::max(forgone, std::abs(rendered.unrendered[j]));
                      } else {
                        ASSERT_EQ(rendered.torque[j], 0.0);
                        ASSERT_EQ(rendered.unrendered[j], rendered.asked[j]);
                      }
                    }
                  });
  for (std::size_t d = 0; d < kDigits; ++d)
    EXPECT_GT(asked[d], 0.01) << digit_name(static_cast<int>(d));  // each of them presses
  EXPECT_FALSE(saturated);
  EXPECT_LT(forgone, 1e-9);
  for (const ExoMotor& motor : setup->exoskeleton.motors)
    for (std::size_t j = 2 * kJointsPerDigit; j < kJoints; ++j) EXPECT_EQ(motor.arm[j], 0.0) << motor.name;
}

// What the copied fingers cannot show: with motors on all five digits each contact's force is fed back. The
// limits are 0.8 N/mm without smoothing and 1.7 N/mm with it (docs/stability.md).
TEST(S2Fig5, IsSteadyWithAllFiveDigitsFedBackAndShakesWithoutSmoothing) {
  constexpr int kFew = 4;
  const LoopRun smoothed = run_s2_fig5_driven({}, kFew);
  std::set<int> digits;
  for (const int segment : smoothed.curves.touching) digits.insert(digit_of_segment(segment));
  EXPECT_EQ(digits, (std::set<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(smoothed.stable(), kFew);
  for (const TrialResult& trial : smoothed.trials) EXPECT_TRUE(trial.valid) << trial.why_invalid;
  for (int j = 0; j < kJoints; ++j)
    EXPECT_LT(smoothed.unrendered[static_cast<std::size_t>(j)], 1e-9) << joint_name(j) << " [Nm]";
  EXPECT_EQ(run_s2_fig5_driven({{"stabiliser.method", "none"}}, kFew).unstable(), kFew);
}

TEST(S2Fig5, ReportsEveryTouchingPhalanx) {
  const ExperimentReport report = s2_fig5();
  ASSERT_EQ(report.rows.size(), 2U);
  for (const PaperRow& row : report.rows) EXPECT_EQ(row.difference, "agrees") << row.quantity;
  EXPECT_THAT(report.json, ::testing::StartsWith("{\n  \"experiment\": \"s2-fig5\",\n"));
  const auto json = nlohmann::json::parse(report.json);
  EXPECT_EQ(json["paper_values"], "not printed");
  EXPECT_EQ(json["grasp"]["stable_seeds"], kLoopSeeds);
  EXPECT_EQ(json["index_alone"]["stable_seeds"], kLoopSeeds);
  EXPECT_EQ(json["all_driven"]["stable_seeds"], kLoopSeeds);
  EXPECT_FALSE(json["all_driven"].contains("largest_unrendered_nm"));
  const auto touching = json["touching"].get<std::string>();
  EXPECT_THAT(report.text, ::testing::HasSubstr("\ntouching: " + touching + "\n"));
  for (const char* name : {"thumb distal", "index distal", "middle distal", "ring distal", "little distal"})
    EXPECT_THAT(touching, ::testing::HasSubstr(name));
  EXPECT_THAT(report.csv, ::testing::HasSubstr("pinky_finger_phalanx_distal_force_n"));
  EXPECT_THAT(report.svg, ::testing::HasSubstr("</svg>"));
}

}  // namespace
}  // namespace phalanx
