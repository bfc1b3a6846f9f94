// SPDX-License-Identifier: Apache-2.0
#include "study/laboratory/measure_point.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <set>
#include <stdexcept>
#include <tuple>

#include "study/laboratory/synthetic.h"

namespace phalanx {
namespace {

using testing::study_of;
using testing::synthetic_trial;

const StiffnessVerdict& checked_at(const PointResult& result, double n_per_mm) {
  for (const StiffnessVerdict& checked : result.checked) {
    if (checked.n_per_mm == n_per_mm) return checked;
  }
  throw std::runtime_error("not checked");
}

// Point 6: gain 2, friction 0.2: seeds are stable up to 2600 - seed N/m. The grid's largest below 2595 is 2.5
// N/mm.
TEST(MeasurePoint, FindsTheLimitThatAllSeedsBear) {
  const PointResult result = measure_point(study_of(testing::kTwelvePoints), 6, synthetic_trial);
  EXPECT_EQ(result.index, 6);
  EXPECT_EQ(result.k_lim, 2500.0);
  EXPECT_FALSE(result.at_least);
  EXPECT_FALSE(result.non_monotone);
  EXPECT_FALSE(result.ends_in_invalid);
  EXPECT_TRUE(result.stable);
  EXPECT_EQ(checked_at(result, 2.5).verdict, Verdict::kStable);
  EXPECT_EQ(checked_at(result, 2.5).seeds_run, 5);
  EXPECT_EQ(checked_at(result, 2.6).verdict, Verdict::kUnstable);
}

// Of five seeds the last swings most, by 0.05 N; at 2.6 N/mm the first one alone was run, which swings by 2
// N.
TEST(MeasurePoint, SaysOfEachStiffnessByHowMuchItsSeedsSwung) {
  const PointResult result = measure_point(study_of(testing::kTwelvePoints), 6, synthetic_trial);
  EXPECT_NEAR(checked_at(result, 2.5).force_swing, 0.05, 1e-15);
  EXPECT_NEAR(checked_at(result, 2.5).position_swing, 0.05 / 2500.0, 1e-15);
  EXPECT_EQ(checked_at(result, 2.6).seeds_run, 1);
  EXPECT_EQ(checked_at(result, 2.6).force_swing, 2.0);
  EXPECT_NEAR(checked_at(result, 2.6).position_swing, 2.0 / 2600.0, 1e-15);
}

// Seed s swings by 0.01 s N, ghosts for 0.1 s; 3 N at 0.8 x 2500 N/m press 1.5 mm deep, the peak is half as
// deep again.
TEST(MeasurePoint, MeasuresAtTheLimit) {
  const PointResult result = measure_point(study_of(testing::kTwelvePoints), 6, synthetic_trial);
  EXPECT_EQ(result.measured_at, 2500.0);
  EXPECT_NEAR(result.k_eff, 2000.0, 1e-9);
  EXPECT_EQ(result.k_eff_seeds, 5);
  EXPECT_NEAR(result.peak_depth, 2.25e-3, 1e-15);
  EXPECT_NEAR(result.force_swing, 0.05, 1e-15);
  EXPECT_NEAR(result.position_swing, 0.05 / 2500.0, 1e-15);
  EXPECT_NEAR(result.ghost_s.mean, 0.3, 1e-15);
  EXPECT_NEAR(result.ghost_s.largest, 0.5, 1e-15);
  EXPECT_NEAR(result.ghost_energy.mean, 0.003, 1e-15);
  EXPECT_EQ(result.invalid_trials, 0);
}

TEST(MeasurePoint, StopsAtTheBatchWithTheFirstUnstableSeed) {
  const Study study = study_of(testing::kTwelvePoints);
  for (const auto& [fails, runs] : {std::pair{1U, 1}, {2U, 2}, {3U, 4}, {4U, 4}, {5U, 5}}) {
    const PointResult result =
        measure_point(study, 0, [&](const Overrides&, double, double, std::uint64_t seed) {
          TrialResult trial;
          trial.stable = seed < fails;
          return trial;
        });
    EXPECT_EQ(result.checked.front().seeds_run, runs) << fails;
    EXPECT_EQ(result.trials, runs * static_cast<int>(result.checked.size())) << fails;
  }
}

TEST(MeasurePoint, SaysZeroIfNoStiffnessIsStable) {
  const auto never = [](const Overrides&, double, double, std::uint64_t) { return TrialResult{}; };
  const PointResult result = measure_point(study_of(testing::kTwelvePoints), 0, never);
  EXPECT_EQ(result.k_lim, 0.0);
  EXPECT_FALSE(result.at_least);
  EXPECT_FALSE(result.stable);
  EXPECT_TRUE(std::isnan(result.k_eff) && std::isnan(result.peak_depth) && std::isnan(result.measured_at));
}

TEST(MeasurePoint, SaysAtLeastIfEveryStiffnessIsStable) {
  const auto always = [](const Overrides& overrides, double, double press, std::uint64_t seed) {
    return synthetic_trial(overrides, 100.0, press, seed);
  };
  const PointResult result = measure_point(study_of(testing::kTwelvePoints), 0, always);
  EXPECT_EQ(result.k_lim, 4000.0);
  EXPECT_TRUE(result.at_least);
}

TEST(MeasurePoint, ReportsAnIslandOfInstability) {
  const auto island = [](const Overrides&, double k, double, std::uint64_t) {
    TrialResult trial;
    trial.stable = k < 2050.0 && std::abs(k - 1800.0) > 1.0;
    return trial;
  };
  const PointResult result = measure_point(study_of(testing::kTwelvePoints), 0, island);
  EXPECT_EQ(result.k_lim, 1700.0);
  EXPECT_TRUE(result.non_monotone);
  EXPECT_EQ(checked_at(result, 1.8).verdict, Verdict::kUnstable);
  EXPECT_EQ(checked_at(result, 2.0).verdict, Verdict::kStable);
}

// An invalid trial proves nothing: it may be stable only because a limiter held it.
TEST(MeasurePoint, DoesNotCountAnInvalidTrialAsStable) {
  const auto limited = [](const Overrides& overrides, double k, double press, std::uint64_t seed) {
    TrialResult trial = synthetic_trial(overrides, 100.0, press, seed);
    trial.valid = k < 1250.0 || seed != 2;
    if (!trial.valid) trial.why_invalid = "the fingertip cap acted";
    return trial;
  };
  const PointResult result = measure_point(study_of(testing::kTwelvePoints), 0, limited);
  EXPECT_EQ(result.k_lim, 1200.0);
  EXPECT_TRUE(result.ends_in_invalid);
  EXPECT_EQ(result.why_invalid, "the fingertip cap acted");
  EXPECT_EQ(checked_at(result, 1.3).verdict, Verdict::kInvalid);
  int invalid = 0;
  for (const StiffnessVerdict& checked : result.checked)
    invalid += checked.verdict == Verdict::kInvalid ? 1 : 0;
  EXPECT_GT(invalid, 3);
  EXPECT_EQ(result.invalid_trials, invalid);  // seed 2 once at each of them
}

// Three seeds and three presses, each invalid but with the first seed: six of nine.
TEST(MeasurePoint, SaysWhyTheFirstInvalidTrialProvesNothing) {
  const auto trial = [](const Overrides&, double, double, std::uint64_t seed) {
    TrialResult result;
    result.stable = true;
    result.valid = seed == 1;
    if (!result.valid) result.why_invalid = "seed " + std::to_string(seed);
    return result;
  };
  const PointResult result = measure_point(study_of("scene = \"a\"\nseeds = 3"), 0, trial);
  EXPECT_EQ(result.trials, 9);
  EXPECT_EQ(result.invalid_trials, 6);
  EXPECT_EQ(result.why_invalid, "seed 2");
}

// The same as a scan finds: 5 seeds at 2.5 N/mm, and one that is unstable at 2.6.
TEST(MeasurePoint, TracesTheSameLimitWithFewerTrials) {
  Study study = study_of(testing::kTwelvePoints);
  const PointResult scanned = measure_point(study, 6, synthetic_trial);
  study.stiffness->search = StiffnessSearch::kTrace;
  const PointResult traced = measure_point(study, 6, synthetic_trial);
  EXPECT_EQ(traced.k_lim, scanned.k_lim);
  EXPECT_EQ(traced.at_least, scanned.at_least);
  EXPECT_EQ(traced.measured_at, scanned.measured_at);
  EXPECT_EQ(traced.peak_depth, scanned.peak_depth);
  EXPECT_EQ(traced.ghost_energy.mean, scanned.ghost_energy.mean);
  EXPECT_EQ(checked_at(traced, 2.5).seeds_run, 5);
  EXPECT_EQ(checked_at(traced, 2.5).verdict, Verdict::kStable);
  EXPECT_EQ(checked_at(traced, 2.6).verdict, Verdict::kUnstable);
  EXPECT_TRUE(std::isnan(traced.k_eff)) << "is not measured in a trace";
  int runs = 0;
  for (const StiffnessVerdict& checked : traced.checked) runs += checked.seeds_run;
  EXPECT_EQ(runs, traced.trials);
  EXPECT_LT(4 * traced.trials, scanned.trials);
}

TEST(MeasurePoint, StatesThatATraceEndsInAnInvalidTrial) {
  Study study = study_of(testing::kTwelvePoints);
  study.stiffness->search = StiffnessSearch::kTrace;
  const PointResult result =
      measure_point(study, 6, [](const Overrides& overrides, double k, double press, std::uint64_t seed) {
        TrialResult trial = synthetic_trial(overrides, k, press, seed);
        if (k > 1000.0) trial = {.valid = false, .why_invalid = "capped", .stable = true};
        return trial;
      });
  EXPECT_EQ(result.k_lim, 1000.0);
  EXPECT_TRUE(result.ends_in_invalid);
  EXPECT_EQ(result.why_invalid, "capped");
}

// The light press of seed 1 shakes, the firm press of seed 2 comes no deeper, that of seed 3 proves nothing:
// two of five seeds are left.
TEST(MeasurePoint, LeavesSeedsOutOfTheEffectiveStiffnessThatHaveNone) {
  const auto trial = [](const Overrides& overrides, double k, double press, std::uint64_t seed) {
    TrialResult result = synthetic_trial(overrides, k, press, seed);
    if (seed == 1 && press == 2.0) result.stable = false;
    if (seed == 2 && press == 4.0) result.mean_depth = 0.0;
    if (seed == 3 && press == 4.0) result.valid = false;
    return result;
  };
  const PointResult result = measure_point(study_of(testing::kTwelvePoints), 6, trial);
  EXPECT_EQ(result.k_eff_seeds, 2);
  EXPECT_NEAR(result.k_eff, 2000.0, 1e-9);
}

TEST(MeasurePoint, MeasuresAtTheScenesStiffnessIfThereIsNoGrid) {
  const Study study =
      study_of("scene = \"a\"\nseeds = 3\nfirst_seed = 21\nset = { \"synthetic.friction\" = 0.1 }");
  std::mutex mutex;
  std::set<std::uint64_t> seeds;
  std::set<std::tuple<bool, double, std::uint64_t>> runs;
  const PointResult result =
      measure_point(study, 0, [&](const Overrides& overrides, double k, double press, std::uint64_t seed) {
        const std::lock_guard<std::mutex> guard(mutex);
        EXPECT_TRUE(std::isnan(k));
        runs.emplace(std::isnan(press), std::isnan(press) ? 0.0 : press, seed);
        seeds.insert(seed);
        return synthetic_trial(overrides, k, press, seed);
      });
  EXPECT_EQ(runs.size(), 9U);
  EXPECT_THAT(seeds, ::testing::ElementsAre(21U, 22U, 23U));
  EXPECT_EQ(result.trials, 9);
  EXPECT_TRUE(std::isnan(result.k_lim) && std::isnan(result.measured_at));
  EXPECT_TRUE(result.stable);
  EXPECT_NEAR(result.k_eff, 240.0, 1e-9);
  ASSERT_EQ(result.checked.size(), 1U);
  EXPECT_EQ(result.checked[0].seeds_run, 3);
}

// All seeds are run there, also after an unstable one: how much it shakes is the answer.
TEST(MeasurePoint, MeasuresAnUnstableSceneToo) {
  const Study study = study_of("scene = \"a\"\nseeds = 3");
  const auto shaking = [](const Overrides&, double, double, std::uint64_t seed) {
    TrialResult trial;
    trial.force_swing = static_cast<double>(seed);
    return trial;
  };
  const PointResult result = measure_point(study, 0, shaking);
  EXPECT_FALSE(result.stable);
  EXPECT_EQ(result.force_swing, 3.0);
  EXPECT_EQ(result.k_eff_seeds, 0);
  EXPECT_TRUE(std::isnan(result.k_eff));
}

TEST(MeasurePoint, ThrowsWhatTheFirstSeedInOrderThrows) {
  const Study study = study_of("scene = \"a\"\nseeds = 8");
  const auto fails = [](const Overrides&, double, double, std::uint64_t seed) -> TrialResult {
    if (seed >= 3) throw std::runtime_error("seed " + std::to_string(seed));
    return {};
  };
  for (int i = 0; i < 20; ++i) {
    try {
      static_cast<void>(measure_point(study, 0, fails));
      ADD_FAILURE() << "nothing thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "seed 3");
    }
  }
}

}  // namespace
}  // namespace phalanx
