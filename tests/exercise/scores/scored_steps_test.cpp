// SPDX-License-Identifier: Apache-2.0
// Which trials are not scored, by any function of scores.
#include "phalanx/exercise/scored_steps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "exercise/scores/generated_trial.h"

namespace phalanx::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::uint64_t kWholeSeed = 8;  ///< of generated steps without any fault, slip or missing sensor

std::vector<Observation> three_steps() { return {running_step(0.0), running_step(0.5), running_step(1.0)}; }

TEST(ScoredSteps, WholeTrialsAreScored) { EXPECT_THAT(why_not_scored(three_steps()), IsEmpty()); }

TEST(ScoredSteps, EachFaultIsNamedWithItsTime) {
  const std::pair<ObservationFault, const char*> faults[] = {
      {ObservationFault::kNoSample, "the device sent no sample at 0.500 s"},
      {ObservationFault::kFault, "the station was in a fault, or the device was lost at 0.500 s"},
      {ObservationFault::kGap, "steps are missing before 0.500 s"},
      {ObservationFault::kNotFinite, "an angle, force or time was not a finite number at 0.500 s"},
  };
  for (const auto& [fault, words] : faults) {
    auto steps = three_steps();
    steps[1].fault = fault;
    EXPECT_THAT(why_not_scored(steps), HasSubstr(words));
  }
}

TEST(ScoredSteps, TimesMustIncreaseAndBeFinite) {
  auto steps = three_steps();
  steps[2].time = 0.5;
  EXPECT_THAT(why_not_scored(steps), HasSubstr("time does not increase at 0.500 s"));
  steps[2].time = kNaN;
  EXPECT_THAT(why_not_scored(steps), HasSubstr("a time is not a finite number"));
  steps[2].time = kInfinity;
  EXPECT_THAT(why_not_scored(steps), HasSubstr("a time is not a finite number"));
  steps[2].time = 1e12;
  EXPECT_THAT(why_not_scored(steps), HasSubstr("3600 s are allowed at most"));
}

TEST(ScoredSteps, OneStepIsNoTrial) {
  EXPECT_THAT(why_not_scored(std::span<const Observation>()), HasSubstr("has 0 steps"));
  EXPECT_THAT(why_not_scored(std::vector<Observation>(1, running_step(0.0))), HasSubstr("has 1 steps"));
}

TEST(ScoredSteps, AFaultInAnyStepMakesEachScoreOfEachMeasureInvalid) {
  const auto whole = generated_steps(kWholeSeed);
  const auto tasks = generated_tasks(kWholeSeed, whole);
  std::size_t valid = 0;
  for (const ScoredTask& task : tasks)
    for (const Score& score : task.scores(whole)) valid += score.valid() ? 1U : 0U;
  EXPECT_GT(valid, 20U) << "the whole trial is scored";
  for (const std::size_t place : {std::size_t{0}, whole.size() / 2, whole.size() - 1})
    for (const ObservationFault fault : {ObservationFault::kNoSample, ObservationFault::kFault,
                                         ObservationFault::kGap, ObservationFault::kNotFinite}) {
      auto steps = whole;
      steps[place].fault = fault;
      for (const ScoredTask& task : tasks) {
        SCOPED_TRACE(task.json.substr(0, 60));
        expect_none(task.scores(steps), "not scored: ");
      }
    }
}

TEST(ScoredSteps, NoScoreComesFromNumbersThatAreNotFinite) {
  const auto whole = generated_steps(kWholeSeed);
  const auto tasks = generated_tasks(kWholeSeed, whole);
  for (const double bad : {kNaN, kInfinity, -kInfinity})
    for (int part = 0; part < 3; ++part) {
      auto steps = whole;
      Observation& step = steps[steps.size() / 2];
      if (part == 0) step.angle.fill(bad);
      if (part == 1) step.force.fill(bad);
      if (part == 2) step.pad.fill(Vec3::Constant(bad));
      std::size_t invalid = 0;
      for (const ScoredTask& task : tasks)
        for (const Score& score : task.scores(steps)) {
          EXPECT_EQ(score.valid(), std::isfinite(score.value)) << score.name;
          invalid += score.valid() ? 0U : 1U;
        }
      EXPECT_GT(invalid, 0U) << part;
    }
}

TEST(ScoredSteps, AnInvalidTrialHasTheSameNamesAsAValidOne) {
  const auto whole = generated_steps(kWholeSeed);
  auto lost = whole;
  lost[3].fault = ObservationFault::kFault;
  for (const ScoredTask& task : generated_tasks(kWholeSeed, whole)) {
    const auto scores = task.scores(whole);
    const auto none = task.scores(lost);
    ASSERT_EQ(scores.size(), none.size());
    for (std::size_t i = 0; i < scores.size(); ++i) {
      EXPECT_EQ(scores[i].name, none[i].name);
      EXPECT_EQ(scores[i].unit, none[i].unit);
      EXPECT_EQ(scores[i].origin, none[i].origin);
    }
  }
}

}  // namespace
}  // namespace phalanx::test
