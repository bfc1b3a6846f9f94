// SPDX-License-Identifier: Apache-2.0
// S2's largest stable stiffness, and what it must not depend on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tbb/parallel_for.h>

#include <array>
#include <atomic>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "papers/s2_experiments.h"
#include "papers/s2_loop_figures.h"
#include "phalanx/scene/scene_trial.h"
#include "phalanx/simulation/closed_loop/trial.h"
#include "phalanx/study/laboratory/limit_search.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kGrid = 100.0;            // [N/m]
constexpr double kOneStep = 100.0 + 1e-6;  // [N/m]
constexpr double kHalfStep = 0.5 * Plant::kDefaultStep;
const Overrides kUnsmoothed = {{"stabiliser.method", "\"none\""}};
const Overrides kSmoothing = {{"smoothing.min_n", "-0.1"}, {"smoothing.max_n", "0.1"}};

/// The press, integrated at another step.
class Press {
 public:
  Press(const Overrides& overrides, double step) : setup_(with_step(overrides, step)) {}

  /// Whether every seed is stable and valid.
  [[nodiscard]] bool stable_at(double stiffness) const {
    std::atomic<bool> all{true};
    tbb::parallel_for(1, kLoopSeeds + 1, [&](int seed) {
      if (!all) return;
      const TrialResult result = run_trial(*setup_, stiffness, std::numeric_limits<double>::quiet_NaN(),
                                           static_cast<std::uint64_t>(seed));
      if (!result.stable || !result.valid) all = false;
    });
    return all;
  }

 private:
  static std::shared_ptr<const TrialSetup> with_step(const Overrides& overrides, double step) {
    // The set-up is not shared yet, so that it may change.
    const auto setup =
        std::const_pointer_cast<TrialSetup>(make_trial_setup(load_scene("stability_press", overrides)));
    setup->step = step;
    return setup;
  }
  std::shared_ptr<const TrialSetup> setup_;
};

/// Half the step moves the limit by at most one point of the grid.
void expect_same_with_half_the_step(const Overrides& overrides, double limit) {
  const Press press(overrides, kHalfStep);
  EXPECT_TRUE(press.stable_at(limit - kGrid));
  EXPECT_FALSE(press.stable_at(limit + 2.0 * kGrid));
}

TEST(S2Limit, IsThePapersWithinAStepOfTheGridAndKeepsItWithHalfTheStepAndOtherSeeds) {
  const LimitRow row = find_limits("as it is", {}, kLoopSeeds);
  EXPECT_NEAR(row.none.k_lim, 700.0, kOneStep);
  EXPECT_NEAR(row.smoothing.k_lim, 1600.0, kOneStep);
  expect_same_with_half_the_step(kUnsmoothed, row.none.k_lim);
  expect_same_with_half_the_step(kSmoothing, row.smoothing.k_lim);

  const LimitRow other = find_limits("seeds 21 to 40", {}, kLoopSeeds, 21);
  EXPECT_NEAR(other.none.k_lim, row.none.k_lim, kOneStep);
  EXPECT_NEAR(other.smoothing.k_lim, row.smoothing.k_lim, kOneStep);
}

// Below the least that IsThePapersWithinAStepOfTheGrid allows with friction.
TEST(S2Limit, FallsWithoutFrictionInTheSheaths) {
  const LimitRow row =
      find_limits("no friction in the sheaths", {{"device.scale.sheath_friction", "0"}}, kLoopSeeds);
  EXPECT_LT(row.none.k_lim, 700.0 - kOneStep);
  EXPECT_LT(row.smoothing.k_lim, 1600.0 - kOneStep);
}

// On both sides of the limits: 1 N/mm shakes without smoothing and is steady with it, 2 N/mm shakes with
// both.
TEST(S2Limit, GivesTheSameVerdictsAtOneAndTwoNewtonsAMillimetreWithHalfTheStep) {
  for (const double step : {Plant::kDefaultStep, kHalfStep}) {
    SCOPED_TRACE(::testing::Message() << "step " << step);
    EXPECT_FALSE(Press(kUnsmoothed, step).stable_at(1000.0));
    EXPECT_TRUE(Press(kSmoothing, step).stable_at(1000.0));
    EXPECT_FALSE(Press(kUnsmoothed, step).stable_at(2000.0));
    EXPECT_FALSE(Press(kSmoothing, step).stable_at(2000.0));
  }
}

// Three rows by hand, with each flag set in one place.
TEST(S2LimitReport, GivesEachLimitItsFlagsAndThePapers) {
  PointResult below_the_grid;
  below_the_grid.k_lim = 0.0;
  PointResult not_monotone;
  not_monotone.k_lim = 700.0;
  not_monotone.non_monotone = true;
  not_monotone.checked.resize(2);
  not_monotone.checked[0].n_per_mm = 0.7;
  not_monotone.checked[0].verdict = Verdict::kStable;
  not_monotone.checked[1].n_per_mm = 0.8;
  not_monotone.checked[1].verdict = Verdict::kUnstable;
  PointResult ends_above;
  ends_above.k_lim = 4000.0;
  ends_above.at_least = true;
  const ExperimentReport report =
      s2_limit_report({{.change = "as it is", .none = not_monotone, .smoothing = ends_above},
                       {.change = "softer", .none = below_the_grid, .smoothing = not_monotone}});

  const auto json = nlohmann::json::parse(report.json);
  EXPECT_EQ(json.at("k_lim_n_per_mm"), nlohmann::json::parse(R"({"none": 0.7, "smoothing": 4.0})"));
  EXPECT_EQ(json.at("paper_n_per_mm"), nlohmann::json::parse(R"({"none": 0.7, "smoothing": 1.6})"));
  EXPECT_EQ(json.at("rows"), nlohmann::json::parse(R"([
    {"change": "as it is",
     "none": {"k_lim_n_per_mm": 0.7, "at_least": false, "non_monotone": true,
              "checked": [{"n_per_mm": 0.7, "verdict": "stable"}, {"n_per_mm": 0.8, "verdict": "unstable"}]},
     "smoothing": {"k_lim_n_per_mm": 4.0, "at_least": true, "non_monotone": false}},
    {"change": "softer",
     "none": {"k_lim_n_per_mm": 0.0, "at_least": false, "non_monotone": false},
     "smoothing": {"k_lim_n_per_mm": 0.7, "at_least": false, "non_monotone": true,
                   "checked": [{"n_per_mm": 0.7, "verdict": "stable"}, {"n_per_mm": 0.8, "verdict": "unstable"}]}}])"));

  EXPECT_EQ(report.csv, "change,none_n_per_mm,smoothing_n_per_mm\nas it is,0.7,4\nsofter,0,0.7\n");
  ASSERT_EQ(report.rows.size(), 2U);
  EXPECT_EQ(report.rows[0].paper, "0.7");
  EXPECT_EQ(report.rows[0].ours, "0.7");
  EXPECT_EQ(report.rows[0].difference, "+0.0");
  EXPECT_EQ(report.rows[1].paper, "1.6");
  EXPECT_EQ(report.rows[1].ours, ">= 4.0");
  EXPECT_EQ(report.rows[1].difference, "+2.4");
  const std::vector<std::vector<std::string>> table = {{"as it is", "0.7", ">= 4.0"},
                                                       {"softer", "< 0.1", "0.7"}};
  EXPECT_EQ(report.sections.at(0).table.rows, table);
}

// The sensitivities have a table of their own and nothing of the papers.
TEST(S2SensitivityReport, HasEachChangeWithItsTwoLimits) {
  PointResult low;
  low.k_lim = 600.0;
  PointResult high;
  high.k_lim = 1700.0;
  const ExperimentReport report =
      s2_sensitivity_report({{.change = "as it is", .none = low, .smoothing = high},
                             {.change = "softer", .none = low, .smoothing = low}});
  const auto json = nlohmann::json::parse(report.json);
  EXPECT_EQ(json.at("experiment"), "s2-sensitivity");
  EXPECT_EQ(json.at("paper"), "not in the papers");
  EXPECT_EQ(json.at("rows"), nlohmann::json::parse(R"([
    {"change": "as it is",
     "none": {"k_lim_n_per_mm": 0.6, "at_least": false, "non_monotone": false},
     "smoothing": {"k_lim_n_per_mm": 1.7, "at_least": false, "non_monotone": false}},
    {"change": "softer",
     "none": {"k_lim_n_per_mm": 0.6, "at_least": false, "non_monotone": false},
     "smoothing": {"k_lim_n_per_mm": 0.6, "at_least": false, "non_monotone": false}}])"));
  EXPECT_TRUE(json.contains("made"));
  EXPECT_EQ(report.csv, "change,none_n_per_mm,smoothing_n_per_mm\nas it is,0.6,1.7\nsofter,0.6,0.6\n");
  EXPECT_TRUE(report.rows.empty());
  EXPECT_THAT(report.text, StartsWith("What moves the two limits of s2-limit (each with 20 seeds).\n"));
  EXPECT_THAT(
      report.text,
      HasSubstr("softer                                                   0.6                   0.6\n"));
  const std::vector<std::vector<std::string>> table = {{"as it is", "0.6", "1.7"}, {"softer", "0.6", "0.6"}};
  EXPECT_EQ(report.sections.at(0).table.rows, table);
}

TEST(SoakS2Limit, MovesByAtMostOneStepOfTheGridWithHalfTheStep) {
  for (const Overrides& overrides : {kUnsmoothed, kSmoothing}) {
    std::array<double, 2> limit{};
    for (std::size_t i = 0; i < limit.size(); ++i) {
      const Press press(overrides, i == 0 ? Plant::kDefaultStep : kHalfStep);
      limit[i] =
          kGrid * (search_limit(30, [&](int at) { return press.stable_at(kGrid * (at + 1)); }).limit + 1);
    }
    EXPECT_NEAR(limit[1], limit[0], kOneStep);
  }
}

}  // namespace
}  // namespace phalanx
