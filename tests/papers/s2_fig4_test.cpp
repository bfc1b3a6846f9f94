// SPDX-License-Identifier: Apache-2.0
// S2 fig. 4 in closed loop: the index finger presses the teapot at 0.9 N/mm.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "papers/s2_experiments.h"
#include "papers/s2_loop_figures.h"
#include "phalanx/scene/scene_trial.h"
#include "phalanx/simulation/closed_loop/trial.h"

namespace phalanx {
namespace {

constexpr double kSceneValue = std::numeric_limits<double>::quiet_NaN();
constexpr double kWithin = 0.2;  // [s]
constexpr std::size_t kIndexTip = 5;
const Overrides kNoSmoothing = {{"stabiliser.method", "\"none\""}};

/// A trial as the snapshots tell it.
struct Watched {
  TrialResult result;
  std::vector<double> oscillating;  ///< times of the steps whose snapshot said so, before the release [s]
  double least_factor = 1.0;        ///< smallest stiffness_factor
  double late_swing = 0.0;          ///< of the index tip's force, in the last half second of the window [N]

  [[nodiscard]] bool said_between(double from, double to) const {
    return std::any_of(oscillating.begin(), oscillating.end(),
                       [&](double t) { return t >= from && t <= to; });
  }
};

Watched watch_trial(const TrialSetup& setup, std::uint64_t seed) {
  Watched watched;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  watched.result = run_trial(setup, kSceneValue, kSceneValue, seed,
                             [&](double t, const Snapshot& snapshot, const SimulatedExoskeleton&) {
                               if (t < setup.schedule.release && has(snapshot.status, Status::kOscillating))
                                 watched.oscillating.push_back(t);
                               watched.least_factor =
                                   std::min(watched.least_factor, snapshot.stiffness_factor);
                               if (t < setup.schedule.window_end - 0.5 || t >= setup.schedule.window_end)
                                 return;
                               low = std::min(low, snapshot.segment[kIndexTip].force);
                               high = std::max(high, snapshot.segment[kIndexTip].force);
                             });
  watched.late_swing = high - low;
  return watched;
}

TEST(S2Fig4, ShakesWithoutSmoothingAndIsSteadyWithIt) {
  const std::vector<LoopRun> runs = run_s2_fig4(kLoopSeeds);
  ASSERT_EQ(runs.size(), 2U);
  for (const LoopRun& run : runs) EXPECT_EQ(run.stiffness, 900.0);
  EXPECT_EQ(runs[0].stable(), 0);
  EXPECT_EQ(runs[1].stable(), kLoopSeeds);
  for (const TrialResult& trial : runs[1].trials) EXPECT_TRUE(trial.valid) << trial.why_invalid;
  EXPECT_LE(runs[1].largest_force_swing(), 0.5);
  EXPECT_LE(runs[1].largest_position_swing(), 0.5e-3);
}

TEST(S2Fig4, RecordsTheCurvesOfTheFirstSeed) {
  for (const LoopRun& run : run_s2_fig4(1)) {
    EXPECT_THAT(run.curves.touching, ::testing::ElementsAre(static_cast<int>(kIndexTip)));
    const std::size_t steps = run.curves.time_s.size();
    EXPECT_NEAR(static_cast<double>(steps), 5.3 * 200.0, 1.0);
    EXPECT_EQ(run.curves.force[kIndexTip].size(), steps);
    EXPECT_EQ(run.curves.position[kIndexTip].size(), steps);
    double deepest = 0.0;
    for (const double into : run.curves.position[kIndexTip])
      if (!std::isnan(into)) deepest = std::max(deepest, into);
    EXPECT_GT(deepest, 0.8 * run.trials[0].peak_depth);
  }
}

// Nothing swings before the bump, so what swings for good began with it.
TEST(S2Fig4, SeesEveryOscillationWithinAFifthOfASecondAndNoneWithSmoothing) {
  const auto setup = make_trial_setup(load_scene("stability_press", kNoSmoothing));
  const LoopRun without = run_loop("without", "stability_press", kNoSmoothing, kLoopSeeds);
  for (std::uint64_t seed = 1; seed <= kLoopSeeds; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Watched watched = watch_trial(*setup, seed);
    const Detection& detection = without.detections[seed - 1];
    ASSERT_FALSE(watched.result.stable);
    ASSERT_FALSE(std::isnan(detection.swung_s));
    ASSERT_FALSE(std::isnan(detection.fired_s));
    EXPECT_GE(detection.swung_s, setup->patient.bump_start);
    EXPECT_LE(detection.fired_s, detection.swung_s + kWithin);
    EXPECT_TRUE(watched.said_between(detection.swung_s, detection.swung_s + kWithin));
    EXPECT_TRUE(watched.said_between(setup->patient.bump_start, setup->patient.bump_start + kWithin));
    EXPECT_EQ(detection.fired_s, watched.oscillating.front());
  }
  const auto smoothed = make_trial_setup(load_scene("stability_press"));
  for (std::uint64_t seed = 1; seed <= kLoopSeeds; ++seed)
    EXPECT_TRUE(watch_trial(*smoothed, seed).oscillating.empty()) << "seed " << seed;
}

// One halving is enough: 0.45 N/mm is below the limit.
TEST(S2Fig4, ComesToRestWhereTheStiffnessIsHalvedOnceItOscillates) {
  const auto setup = make_trial_setup(load_scene(
      "stability_press", {{"stabiliser.method", "\"none\""}, {"oscillation.reaction", "\"halve\""}}));
  for (std::uint64_t seed = 1; seed <= kLoopSeeds; ++seed) {
    const Watched watched = watch_trial(*setup, seed);
    EXPECT_EQ(watched.least_factor, 0.5) << "seed " << seed;
    EXPECT_LT(watched.late_swing, 0.5) << "seed " << seed;
  }
}

// One seed is stable and proves it, the other is stable but not valid: neither steady nor oscillating.
TEST(StabilityRow, AgreesWithNoPaperWhereNothingIsProven) {
  LoopRun run;
  run.trials.resize(2);
  for (TrialResult& trial : run.trials) trial.stable = true;
  run.trials[1].valid = false;
  for (const bool stable_in_paper : {false, true}) {
    const PaperRow row = stability_row("e", "q", run, stable_in_paper);
    EXPECT_EQ(row.ours, "not proven (1 of 2 seeds stable, 0 not)");
    EXPECT_EQ(row.difference, "differs") << row.paper;
  }
}

// The columns are of both runs' segments, in the hand's order; a position that there is not yet stays empty.
TEST(CurvesCsv, HasTheSegmentsOfAllRunsInTheirOrder) {
  LoopRun tip;
  tip.name = "tip";
  tip.curves.time_s = {0.0, 0.005};
  tip.curves.touching = {5};
  tip.curves.force[3] = {0.0, 0.0};
  tip.curves.position[3] = {kSceneValue, kSceneValue};
  tip.curves.force[5] = {1.5, 2.5};
  tip.curves.position[5] = {kSceneValue, 0.001};
  LoopRun both;
  both.name = "both, 0.1 N";
  both.curves.time_s = {0.25};
  both.curves.touching = {3, 5};
  both.curves.force[3] = {0.5};
  both.curves.position[3] = {0.002};
  both.curves.force[5] = {3.5};
  both.curves.position[5] = {0.003};
  EXPECT_EQ(curves_csv({tip, both}),
            "run,time_s,index_finger_phalanx_proximal_force_n,index_finger_phalanx_proximal_into_m,"
            "index_finger_phalanx_distal_force_n,index_finger_phalanx_distal_into_m\n"
            "tip,0,0,,1.5,\n"
            "tip,0.005,0,,2.5,0.001\n"
            "\"both, 0.1 N\",0.25,0.5,0.002,3.5,0.003\n");
}

TEST(S2Fig4, ReportsWhatItFound) {
  const ExperimentReport report = s2_fig4();
  const auto json = nlohmann::json::parse(report.json);
  EXPECT_EQ(json["experiment"], "s2-fig4");
  EXPECT_EQ(json["paper_values"], "not printed");
  EXPECT_EQ(json["none"]["stable_seeds"], 0);
  EXPECT_EQ(json["smoothing"]["stable_seeds"], kLoopSeeds);
  EXPECT_EQ(json["none"]["trials"].size(), static_cast<std::size_t>(kLoopSeeds));
  EXPECT_LE(json["slowest_detection_s"].get<double>(), kWithin);
  EXPECT_GE(json["slowest_detection_s"].get<double>(), 0.0);
  ASSERT_EQ(report.rows.size(), 2U);
  for (const PaperRow& row : report.rows) {
    EXPECT_EQ(row.kind, RowKind::kPredicted);
    EXPECT_EQ(row.difference, "agrees");
  }
  EXPECT_THAT(report.text, ::testing::HasSubstr("stable in 20 of 20 seeds"));
  EXPECT_THAT(report.csv, ::testing::StartsWith("run,time_s,index_finger_phalanx_distal_force_n,"));
  EXPECT_THAT(report.svg, ::testing::HasSubstr("</svg>"));
  ASSERT_EQ(report.sections.size(), 1U);
  ASSERT_EQ(report.sections[0].text.size(), 3U);
  EXPECT_THAT(report.sections[0].text[0],
              ::testing::StartsWith("Without smoothing: stable in 0 of 20 seeds"));
  EXPECT_THAT(report.sections[0].text[1],
              ::testing::StartsWith("With at most 0.05 N a step: stable in 20 of 20 seeds"));
}

}  // namespace
}  // namespace phalanx
