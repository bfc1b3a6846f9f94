// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "exercise/run/exercise_fixture.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;

std::string refusal_of(const ExerciseDescription& exercise) {
  try {
    check_exercise(exercise);
  } catch (const ExerciseError& error) {
    return error.what();
  }
  return "accepted";
}

std::string refusal_of(const ExerciseDescription& exercise, const PersonLimits& person) {
  try {
    check_person(exercise, person);
  } catch (const ExerciseError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ExerciseCheck, AcceptsASmallExerciseOfEveryMeasure) {
  for (int i = 0; i < kExerciseMeasures; ++i) {
    const auto measure = static_cast<ExerciseMeasure>(i);
    EXPECT_EQ(refusal_of(small_exercise(measure)), "accepted") << exercise_measure_name(measure);
    EXPECT_EQ(find_exercise_measure(exercise_measure_name(measure)), measure);
  }
  EXPECT_EQ(refusal_of(small_training()), "accepted");
}

TEST(ExerciseCheck, NamesKeyValueAndRemedy) {
  ExerciseDescription exercise = small_exercise(ExerciseMeasure::kPressAndHold);
  exercise.trials = 0;
  EXPECT_THAT(refusal_of(exercise), HasSubstr("trials = 0: it must be >= 1, <= 60"));
  exercise = small_exercise(ExerciseMeasure::kForceTracking);
  exercise.trial_s = 5.0;
  EXPECT_THAT(refusal_of(exercise), HasSubstr("trial_s = 5: a trial of force_tracking needs at least 6 s"));
  exercise = small_exercise(ExerciseMeasure::kPinch);
  exercise.digits[0] = true;
  EXPECT_THAT(refusal_of(exercise), HasSubstr("name only the fingers"));
  exercise = small_exercise(ExerciseMeasure::kPressAndHold);
  exercise.title = "two\nlines";
  EXPECT_THAT(refusal_of(exercise), HasSubstr("title"));
  exercise = small_exercise(ExerciseMeasure::kPressAndHold);
  exercise.limits.force = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal_of(exercise), HasSubstr("limits.force_n = nan"));
}

TEST(ExerciseCheck, AnAssessmentMustNotAdapt) {
  ExerciseDescription exercise = small_training();
  exercise.kind = ExerciseKind::kAssessment;
  EXPECT_THAT(refusal_of(exercise), HasSubstr("fixed conditions"));
}

TEST(ExerciseCheck, ATrainingNeedsAScoreThatItsTrialsHave) {
  ExerciseDescription exercise = small_training();
  exercise.success->score = "time_in_targt_share";
  EXPECT_THAT(refusal_of(exercise), HasSubstr("did you mean \"time_in_target_share\"?"));
  exercise = small_training();
  exercise.difficulty->tolerance.reset();
  EXPECT_THAT(refusal_of(exercise), HasSubstr("[easy, hard]"));
  exercise = small_training();
  exercise.measure = ExerciseMeasure::kOwnForce;
  EXPECT_THAT(refusal_of(exercise), HasSubstr("own_force is an assessment"));
}

TEST(ExerciseCheck, RefusesMoreScoresThanAResultCanHold) {
  ExerciseDescription exercise = small_exercise(ExerciseMeasure::kRangeOfMotion);
  exercise.digits.fill(true);
  exercise.trials = 18;
  EXPECT_THAT(refusal_of(exercise), HasSubstr("trials = 18: the result of so many trials"));
}

TEST(PersonCheck, NamesTheAssessmentThatMeasuresWhatIsMissing) {
  PersonLimits person = able_person();
  person.own_force[1].reset();
  EXPECT_THAT(refusal_of(small_exercise(ExerciseMeasure::kPressAndHold), person),
              HasSubstr("that of the index is not measured; do the assessment own_force first"));
  person = able_person();
  person.own_range = {};
  EXPECT_THAT(refusal_of(small_exercise(ExerciseMeasure::kSmoothness), person),
              HasSubstr("do the assessment range_of_motion first"));
  EXPECT_EQ(refusal_of(small_exercise(ExerciseMeasure::kPressAndHold), person), "accepted");
}

TEST(PersonCheck, RefusesADigitThatFollowsAnotherOne) {
  PersonLimits person = able_person();
  person.felt[1] = false;
  EXPECT_THAT(refusal_of(small_exercise(ExerciseMeasure::kPressAndHold), person),
              HasSubstr("the index follows another digit"));
  ExerciseDescription two = small_exercise(ExerciseMeasure::kOwnForce);
  two.digits[2] = true;
  EXPECT_EQ(refusal_of(two, person), "accepted") << "the middle finger is measured";
}

TEST(PersonCheck, RefusesAUsedUpDose) {
  PersonLimits person = able_person();
  person.repetitions_today = 100;
  EXPECT_THAT(refusal_of(small_training(), person), HasSubstr("100 of 100 repetitions"));
  person.repetitions_today = 0;
  person.minutes_today = 30.0;
  EXPECT_THAT(refusal_of(small_training(), person), HasSubstr("30.0 of 30 minutes; continue tomorrow"));
}

}  // namespace
}  // namespace phalanx
