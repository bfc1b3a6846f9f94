// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>

#include "exercise/run/exercise_fixture.h"
#include "phalanx/core/random.h"

namespace phalanx {
namespace {

using Kind = ExerciseInput::Kind;
using ::testing::HasSubstr;

const Score& score_named(const std::vector<Score>& scores, const std::string& name) {
  static const Score kNone = {
      .name = "none", .unit = "", .value = 0.0, .origin = {}, .invalid = "no such score"};
  const auto found =
      std::find_if(scores.begin(), scores.end(), [&](const Score& score) { return score.name == name; });
  return found == scores.end() ? kNone : *found;
}

TEST(ExerciseRun, GoesThroughItsPhasesAndScoresEachTrial) {
  ExerciseDescription exercise = small_exercise(ExerciseMeasure::kPressAndHold);
  exercise.warm_up_s = 2.0;
  Bench bench(exercise);
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kReady);
  EXPECT_FALSE(bench.run.demand().torque);
  bench.steps(5.0);
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kReady) << "it waits";
  bench.begin();
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kWarmUp);
  EXPECT_TRUE(bench.run.demand().torque);
  bench.steps(2.0);
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kRest);
  bench.steps(1.0);
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kTrial);
  EXPECT_EQ(bench.run.view().trial, 1);
  bench.steps(3.0);
  EXPECT_NEAR(bench.run.view().progress, 0.5, 0.01);
  EXPECT_NEAR(bench.run.view().value.value_or(0.0), 2.5, 1e-9);
  ASSERT_TRUE(bench.until(ExercisePhase::kDone));
  const ExerciseResult result = bench.run.result();
  EXPECT_FALSE(result.interrupted);
  EXPECT_EQ(result.ended, "all trials are done");
  EXPECT_EQ(result.repetitions, 2);
  ASSERT_EQ(result.trials.size(), 2U);
  EXPECT_EQ(result.trials[0].invalid, "");
  EXPECT_NEAR(result.trials[0].end - result.trials[0].begin, 6.0, 1e-9);
  EXPECT_NEAR(result.trials[0].target.value_or(0.0), 2.5, 1e-12) << "half of 5 N";
  EXPECT_NEAR(score_named(result.scores, "mean_force_n").value, 2.5, 1e-9);
  EXPECT_NEAR(result.seconds, 2.0 + 2 * 7.0, 0.2);
}

TEST(ExerciseRun, ATargetIsAShareOfTheOwnForceAndWithinTheStationsReach) {
  PersonLimits person = able_person();
  person.own_force[1] = 30.0;
  ExerciseDescription exercise = small_exercise(ExerciseMeasure::kPressAndHold);
  exercise.target = 1.0;
  Bench bench(exercise, person);
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kTrial));
  EXPECT_NEAR(bench.run.view().target.force[1], 0.8 * 5.0, 1e-12);
  exercise.limits.force = 2.0;
  Bench lower(exercise, person);
  lower.begin();
  ASSERT_TRUE(lower.until(ExercisePhase::kTrial));
  EXPECT_NEAR(lower.run.view().target.force[1], 0.8 * 2.0, 1e-12);
}

TEST(ExerciseRun, APauseStopsTheTorqueAndTheTrialIsRepeated) {
  Bench bench(small_exercise(ExerciseMeasure::kPressAndHold));
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kTrial));
  bench.steps(1.0);
  EXPECT_EQ(bench.input(Kind::kPause), "");
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kPaused);
  EXPECT_FALSE(bench.run.demand().torque);
  const double active = bench.run.result().seconds;
  bench.steps(30.0);
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kPaused);
  EXPECT_DOUBLE_EQ(bench.run.result().seconds, active) << "a pause is no active time";
  EXPECT_EQ(bench.input(Kind::kResume), "");
  EXPECT_TRUE(bench.run.demand().torque);
  ASSERT_TRUE(bench.until(ExercisePhase::kDone));
  const ExerciseResult result = bench.run.result();
  ASSERT_EQ(result.trials.size(), 3U);
  EXPECT_EQ(result.trials[0].invalid, "it was paused");
  EXPECT_EQ(result.trials[0].number, 1);
  for (const Score& score : result.trials[0].scores) EXPECT_FALSE(score.valid()) << score.name;
  EXPECT_EQ(result.trials[1].number, 1) << "repeated";
  EXPECT_EQ(result.trials[2].number, 2);
}

TEST(ExerciseRun, AFaultMakesATrialInvalidAndItIsRepeatedNotOftenerThanPlanned) {
  Bench bench(small_exercise(ExerciseMeasure::kPressAndHold));
  bench.begin();
  int faults = 0;
  while (!bench.run.done() && faults < 100) {
    ASSERT_TRUE(bench.until(ExercisePhase::kTrial));
    bench.steps(1.0);
    bench.observation.fault = ObservationFault::kNoSample;
    bench.step();
    bench.observation.fault = ObservationFault::kNone;
    ++faults;
  }
  EXPECT_EQ(faults, 4) << "two trials, two repetitions";
  const ExerciseResult result = bench.run.result();
  for (const ExerciseTrial& trial : result.trials) EXPECT_THAT(trial.invalid, HasSubstr("no sample"));
  for (const Score& score : result.scores) EXPECT_FALSE(score.valid()) << score.name;
}

TEST(ExerciseRun, AGapInTimeMakesATrialInvalid) {
  for (const double jump : {5.0, -1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    SCOPED_TRACE(jump);
    Bench bench(small_exercise(ExerciseMeasure::kPressAndHold));
    bench.begin();
    ASSERT_TRUE(bench.until(ExercisePhase::kTrial));
    bench.steps(1.0);
    Observation odd = bench.observation;
    odd.time += jump;
    bench.run.step(odd);
    ASSERT_FALSE(bench.run.result().trials.empty());
    EXPECT_NE(bench.run.result().trials[0].invalid, "");
  }
}

TEST(ExerciseRun, TorqueThatAPersonSwitchesOffPausesUntilAResume) {
  Bench bench(small_exercise(ExerciseMeasure::kPressAndHold));
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kTrial));
  bench.steps(1.0);
  bench.obeys = false;
  bench.observation.torque_on = false;
  bench.observation.factor = 0.0;
  bench.step();
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kPaused);
  EXPECT_FALSE(bench.run.demand().torque) << "a STOP must not be undone";
  bench.steps(5.0);
  EXPECT_FALSE(bench.run.demand().torque);
  EXPECT_THAT(bench.run.view().note, HasSubstr("switched off"));
}

TEST(ExerciseRun, ATrialWaitsUntilTheTorqueIsFullyOn) {
  Bench bench(small_exercise(ExerciseMeasure::kPressAndHold));
  bench.begin();
  bench.obeys = false;
  bench.observation.torque_on = true;
  bench.observation.factor = 0.5;
  bench.steps(10.0);
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kRest);
  EXPECT_EQ(bench.run.view().note, "it waits: the torque is not fully on");
  bench.observation.factor = 1.0;
  bench.step();
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kTrial);
  EXPECT_EQ(bench.run.view().note, "");
}

TEST(ExerciseRun, MotionIsMeasuredWithoutTorque) {
  Bench bench(small_exercise(ExerciseMeasure::kTotalActiveMotion));
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kTrial));
  EXPECT_FALSE(bench.run.demand().torque);
  ASSERT_TRUE(bench.until(ExercisePhase::kDone));
  EXPECT_EQ(score_named(bench.run.result().scores, "tam_index_deg").invalid, "");
}

TEST(ExerciseRun, ADigitThatFollowsHasNoTurnAndIsNotMeasured) {
  ExerciseDescription exercise = small_exercise(ExerciseMeasure::kOwnForce);
  exercise.digits = {false, true, true, false, false};
  PersonLimits person = able_person();
  person.felt[2] = false;
  Bench bench(exercise, person);
  EXPECT_EQ(bench.run.view().trials, 2);
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kDone));
  const ExerciseResult result = bench.run.result();
  EXPECT_NEAR(score_named(result.scores, "index_peak_force_n").value, 3.0, 1e-9);
  EXPECT_THAT(score_named(result.scores, "middle_peak_force_n").invalid, HasSubstr("not measured"));
  const PersonLimits measured = with_measured({}, result);
  EXPECT_NEAR(measured.own_force[1].value_or(0.0), 3.0, 1e-9);
  EXPECT_FALSE(measured.own_force[2].has_value());
}

TEST(ExerciseRun, TheDaysDoseEndsItAndSaysSo) {
  ExerciseDescription exercise = small_training();
  exercise.trials = 10;
  exercise.dose.repetitions = 10;
  PersonLimits person = able_person();
  person.repetitions_today = 7;
  Bench bench(exercise, person);
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kDone));
  EXPECT_EQ(bench.run.result().repetitions, 3);
  EXPECT_EQ(bench.run.result().ended, "the day's dose of 10 repetitions is done");
  EXPECT_FALSE(bench.run.result().interrupted);

  person.repetitions_today = 0;
  person.minutes_today = 29.9;
  Bench minutes(exercise, person);
  minutes.begin();
  ASSERT_TRUE(minutes.until(ExercisePhase::kDone));
  EXPECT_EQ(minutes.run.result().ended, "the day's dose of 30 minutes is done");
  EXPECT_NEAR(minutes.run.result().seconds, 6.0, 0.1);
}

TEST(ExerciseRun, ATrainingCountsItsSuccesses) {
  Bench bench(small_training());
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kTrial));
  ASSERT_TRUE(bench.until(ExercisePhase::kRest));
  bench.act = [](Observation& observation, const ExerciseView&) { observation.force.fill(0.1); };
  ASSERT_TRUE(bench.until(ExercisePhase::kDone));
  const ExerciseResult result = bench.run.result();
  EXPECT_EQ(result.counted, 2);
  EXPECT_EQ(result.successes, 1);
  EXPECT_EQ(result.trials[0].success, std::optional(true));
  EXPECT_EQ(result.trials[1].success, std::optional(false));
  EXPECT_DOUBLE_EQ(result.difficulty.value_or(-1.0), 0.3);
}

TEST(ExerciseRun, AnAbortedTrainingCarriesItsMark) {
  Bench bench(small_training());
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kTrial));
  bench.steps(1.0);
  EXPECT_TRUE(bench.run.result().interrupted) << "before its end";
  EXPECT_EQ(bench.input(Kind::kAbort), "");
  const ExerciseResult result = bench.run.result();
  EXPECT_TRUE(result.interrupted);
  ASSERT_EQ(result.trials.size(), 1U);
  EXPECT_EQ(result.trials[0].invalid, "a person has ended it");
}

TEST(ExerciseRun, ASlipInAPinchIsInvalidAndRepeated) {
  Bench bench(small_exercise(ExerciseMeasure::kPinch));
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kTrial));
  bench.steps(2.0);
  bench.observation.slips[1] = true;
  bench.step();
  bench.observation.slips[1] = false;
  ASSERT_TRUE(bench.until(ExercisePhase::kRest));
  ASSERT_TRUE(bench.until(ExercisePhase::kDone));
  const ExerciseResult result = bench.run.result();
  ASSERT_EQ(result.trials.size(), 3U);
  EXPECT_NE(result.trials[0].invalid, "");
  EXPECT_EQ(result.trials[1].number, 1);
}

TEST(ExerciseRun, APinchWhoseSlipsAreNotSeenIsNotMeasured) {
  PersonLimits person = able_person();
  person.detects_slips = false;
  Bench bench(small_exercise(ExerciseMeasure::kPinch), person);
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kDone));
  for (const Score& score : bench.run.result().scores)
    EXPECT_THAT(score.invalid, HasSubstr("not measured: contacts of this scene cannot slide")) << score.name;
  EXPECT_TRUE(bench.run.result().interrupted);
}

TEST(ExerciseRun, APinchIsScoredByItsTimeInTheBandThatIsShown) {
  Bench bench(small_exercise(ExerciseMeasure::kPinch));
  bench.act = [](Observation& observation, const ExerciseView& view) {
    Bench::follow(observation, view);
    // In the band for the first 3 of 6 s, of which the first one does not count: 2 of 5 s.
    if (view.progress > 0.5) observation.force.fill(0.1);
    observation.touching[0] = observation.touching[1] = true;
  };
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kTrial));
  EXPECT_NEAR(bench.run.view().target.low, 0.9 * 5.0, 1e-9) << "half of 5 N, by two digits";
  ASSERT_TRUE(bench.until(ExercisePhase::kDone));
  const ExerciseResult result = bench.run.result();
  EXPECT_NEAR(score_named(result.scores, "index_time_in_target_share").value, 0.4, 0.01);
  EXPECT_NEAR(score_named(result.scores, "index_hold_time_s").value, 3.0, 0.05);
}

TEST(ExerciseRun, AnAssessmentIsInterruptedUnlessAllPlannedTrialsAreValid) {
  ExerciseDescription exercise = small_exercise(ExerciseMeasure::kPressAndHold);
  exercise.trials = 5;
  PersonLimits person = able_person();
  person.repetitions_today = 99;
  Bench cut(exercise, person);
  cut.begin();
  ASSERT_TRUE(cut.until(ExercisePhase::kDone));
  EXPECT_EQ(cut.run.result().trials.size(), 1U);
  EXPECT_EQ(cut.run.result().ended, "the day's dose of 100 repetitions is done");
  EXPECT_TRUE(cut.run.result().interrupted);

  Bench skipped(exercise);
  skipped.begin();
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(skipped.until(ExercisePhase::kTrial));
    EXPECT_EQ(skipped.input(Kind::kSkip), "");
  }
  ASSERT_TRUE(skipped.until(ExercisePhase::kDone));
  EXPECT_EQ(skipped.run.result().ended, "all trials are done");
  EXPECT_TRUE(skipped.run.result().interrupted) << "one of five is valid";

  Bench whole(exercise);
  whole.begin();
  bool failed_once = false;
  while (!whole.run.done()) {
    whole.observation.fault = ObservationFault::kNone;
    if (!failed_once && whole.run.view().phase == ExercisePhase::kTrial) {
      whole.observation.fault = ObservationFault::kNoSample;
      failed_once = true;
    }
    whole.step();
  }
  EXPECT_EQ(whole.run.result().trials.size(), 6U) << "one is repeated";
  EXPECT_FALSE(whole.run.result().interrupted);
}

TEST(ExerciseRun, AsksForPainAndFatigueAfterTheWarmUpAndAtTheEnd) {
  ExerciseDescription exercise = small_exercise(ExerciseMeasure::kPressAndHold);
  exercise.warm_up_s = 2.0;
  Bench bench(exercise);
  bench.rates = false;
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kRating));
  EXPECT_FALSE(bench.run.demand().torque);
  EXPECT_EQ(bench.run.view().asks, std::optional(Kind::kPain));
  EXPECT_THAT(bench.run.view().instruction, HasSubstr("pain N"));
  EXPECT_EQ(bench.input(Kind::kPain, 2), "");
  EXPECT_EQ(bench.run.view().asks, std::optional(Kind::kFatigue));
  EXPECT_EQ(bench.input(Kind::kFatigue, 1), "");
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kRest);
  EXPECT_FALSE(bench.run.view().asks.has_value());

  ASSERT_TRUE(bench.until(ExercisePhase::kRating)) << "after the last trial";
  EXPECT_EQ(bench.run.result().trials.size(), 2U);
  const double seconds = bench.run.result().seconds;
  bench.steps(5.0);
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kRating);
  EXPECT_EQ(bench.input(Kind::kPain, 6), "") << "at its limit, but the trials are done";
  EXPECT_EQ(bench.input(Kind::kFatigue, 3), "");
  EXPECT_TRUE(bench.run.done());
  const ExerciseResult result = bench.run.result();
  EXPECT_EQ(result.ended, "all trials are done; pain 6 of 10 has reached the limit 5");
  EXPECT_FALSE(result.interrupted);
  EXPECT_EQ(result.seconds, seconds) << "a rating is no active time";
  ASSERT_EQ(result.ratings.size(), 4U);
  EXPECT_EQ(result.ratings[2].value, 6);
}

TEST(ExerciseRun, GoesOnWithoutARatingAfterAWhile) {
  ExerciseDescription exercise = small_exercise(ExerciseMeasure::kPressAndHold);
  exercise.warm_up_s = 2.0;
  Bench bench(exercise);
  bench.rates = false;
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kRating));
  bench.steps(kRatingWait + 0.1);
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kRest);
  ASSERT_TRUE(bench.until(ExercisePhase::kRating));
  EXPECT_EQ(bench.input(Kind::kAbort), "") << "its trials are done";
  EXPECT_TRUE(bench.run.done());
  EXPECT_FALSE(bench.run.result().interrupted);
  EXPECT_EQ(bench.run.result().ended, "all trials are done");
}

TEST(ExerciseRun, AsksAgainAfterTwentyTrials) {
  ExerciseDescription exercise = small_exercise(ExerciseMeasure::kPressAndHold);
  exercise.trials = 25;
  exercise.trial_s = 3.0;
  Bench bench(exercise);
  bench.begin();
  while (!bench.run.done()) bench.step();
  EXPECT_EQ(bench.run.result().ratings.size(), 4U) << "after 20 trials and at the end, pain and fatigue each";
}

/// Carries out a run with inputs and faults drawn by the seed. @returns the result's text and a text
/// of all views
std::string random_run(std::uint64_t seed, ExerciseMeasure measure) {
  Random random(seed);
  Bench bench(small_exercise(measure), able_person(), seed);
  std::string views;
  for (int i = 0; i < 4000 && !bench.run.done(); ++i) {
    const double draw = random.uniform();
    if (draw < 0.004) {
      const auto kind = static_cast<Kind>(static_cast<int>(random.between(0.0, 9.0)));
      if (kind != Kind::kAbort || random.uniform() < 0.1) {
        // A rating of 4 ends nothing.
        views += bench.input(kind, std::floor(random.between(0.0, 5.0)));
      }
    }
    bench.observation.fault = draw > 0.9995 ? ObservationFault::kNoSample : ObservationFault::kNone;
    bench.step();
    views += exercise_phase_name(bench.run.view().phase);
    views += bench.run.view().instruction + bench.run.view().note;
  }
  return exercise_result_text(bench.run.result()) + views;
}

TEST(ExerciseRun, EqualObservationsAndInputsMakeEqualBytes) {
  for (int i = 0; i < kExerciseMeasures; ++i)
    for (std::uint64_t seed = 100; seed < 104; ++seed) {
      SCOPED_TRACE(seed);
      const auto measure = static_cast<ExerciseMeasure>(i);
      EXPECT_EQ(random_run(seed, measure), random_run(seed, measure)) << exercise_measure_name(measure);
    }
}

TEST(ExerciseRun, TheViewAndTheDemandHaveNoTorqueOutsideOfItsActivePhases) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Bench bench(small_exercise(ExerciseMeasure::kPressAndHold));
    for (int i = 0; i < 1500; ++i) {
      if (random.uniform() < 0.01)
        bench.input(static_cast<Kind>(static_cast<int>(random.between(0.0, 9.0))),
                    std::floor(random.between(0.0, 4.0)));
      if (random.uniform() < 0.002) bench.obeys = !bench.obeys;
      bench.step();
      const ExercisePhase phase = bench.run.view().phase;
      if (phase == ExercisePhase::kReady || phase == ExercisePhase::kPaused ||
          phase == ExercisePhase::kDone) {
        EXPECT_FALSE(bench.run.demand().torque);
      }
    }
  }
}

TEST(ExerciseResultText, FitsIntoAnEventOfARecordingForEveryAcceptedExercise) {
  // The most trials that check_exercise() accepts, all of them repeated, none valid: reasons are
  // longer than values.
  for (int i = 0; i < kExerciseMeasures; ++i) {
    const auto measure = static_cast<ExerciseMeasure>(i);
    SCOPED_TRACE(exercise_measure_name(measure));
    ExerciseDescription exercise = small_exercise(measure);
    exercise.digits.fill(true);
    if (measure == ExerciseMeasure::kPinch || measure == ExerciseMeasure::kOpposition)
      exercise.digits[0] = false;
    exercise.dose.repetitions = 500;
    exercise.rest_s = 0.0;
    exercise.trial_s = 6.0;
    const int most = measure == ExerciseMeasure::kFeelAndFind ? 40 : 60;
    for (exercise.trials = most; exercise.trials > 1; --exercise.trials) {
      try {
        check_exercise(exercise);
        break;
      } catch (const ExerciseError&) {
      }
    }
    PersonLimits person = able_person();
    person.calibration_independent = false;
    Bench bench(exercise, person);
    bench.begin();
    int step = 0;
    while (!bench.run.done() && step < 400'000) {
      // A fault a second after the begin of each trial.
      const bool late = bench.run.view().phase == ExercisePhase::kTrial && bench.run.view().progress > 0.1;
      bench.observation.fault = late ? ObservationFault::kFault : ObservationFault::kNone;
      bench.step();
      ++step;
      if (bench.run.view().phase == ExercisePhase::kAnswer) bench.input(Kind::kAnswer, 1);
    }
    ASSERT_TRUE(bench.run.done());
    const std::string text = exercise_result_text(bench.run.result());
    // As a JSON text in the event: each quotation mark has a backslash.
    const auto quotes = static_cast<std::size_t>(std::count(text.begin(), text.end(), '"'));
    EXPECT_LE(text.size() + quotes, 195'000U) << exercise.trials << " trials";
  }
}

TEST(ExerciseResultText, IsJsonWithAValueOrAReasonForEachScore) {
  Bench bench(small_exercise(ExerciseMeasure::kPressAndHold));
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kDone));
  const std::string text = exercise_result_text(bench.run.result());
  EXPECT_THAT(
      text,
      HasSubstr(R"({"name":"small","kind":"assessment","measure":"press_and_hold","interrupted":false)"));
  EXPECT_THAT(text, HasSubstr(R"("target":2.5,"tolerance":0.1)"));
  EXPECT_EQ(text.find("nan"), std::string::npos);
  EXPECT_EQ(text.find("null"), std::string::npos);
}

}  // namespace
}  // namespace phalanx
