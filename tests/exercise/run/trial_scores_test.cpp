// SPDX-License-Identifier: Apache-2.0
// Targets and parameters with which a trial is scored.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "exercise/run/exercise_fixture.h"
#include "exercise/run/exercise_trial.h"

namespace phalanx {
namespace {

TEST(TrialScores, TheTargetOfAMovementIsTheSumOfItsAngles) {
  PersonLimits person = able_person();
  person.own_range.fill(OwnRange{.min = 0.2, .max = 1.2});
  ExerciseDescription exercise = small_exercise(ExerciseMeasure::kSmoothness);
  exercise.target = 0.5;
  for (const int digit : {0, 1}) {
    TrialPlan plan = plan_trial(exercise, person, 0, 0.0);
    plan.digit = digit;
    ExerciseTrial trial;
    state_conditions(exercise, person, plan, trial);
    const ExerciseTarget target = trial_target(exercise, person, plan, 3.0);
    double sum = 0.0;
    for (const double angle : target.angle) sum += std::isnan(angle) ? 0.0 : angle;
    EXPECT_NEAR(sum, digit == 0 ? 2.0 * 0.7 : 3.0 * 0.7, 1e-12)
        << "MCP and IP of the thumb; MCP, PIP and DIP";
    EXPECT_NEAR(trial.target.value_or(0.0), sum, 1e-12);
  }
}

TEST(TrialScores, TheLagBehindAFastTargetIsLookedForWithinHalfItsPeriod) {
  ExerciseDescription exercise = small_exercise(ExerciseMeasure::kForceTracking);
  exercise.rate_hz = 2.0;
  exercise.trial_s = 3.5;
  const PersonLimits person = able_person();
  const TrialPlan plan = plan_trial(exercise, person, 0, 0.0);
  std::vector<Observation> steps;
  for (int i = 0; i <= 350; ++i) {
    Observation step;
    step.time = step.sample_time = 0.01 * i;
    step.torque_on = true;
    step.factor = 1.0;
    step.measured_force.fill(std::numeric_limits<double>::quiet_NaN());
    step.force[1] = 2.5 * (1.0 + 0.5 * std::sin(2.0 * std::numbers::pi * 2.0 * (step.time - 2.0 - 0.1)));
    steps.push_back(step);
  }
  for (const Score& score : trial_scores(exercise, person, plan, steps))
    if (score.name == "lag_s") {
      EXPECT_EQ(score.invalid, "") << "1.5 s are more than twice the longest lag";
      EXPECT_NEAR(score.value, 0.1, 0.002);
      return;
    }
  FAIL() << "there is no lag";
}

}  // namespace
}  // namespace phalanx
