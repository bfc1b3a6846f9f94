// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "exercise/run/exercise_fixture.h"
#include "phalanx/exercise/training.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;

template <typename Act>
std::string refusal_by(Act&& act) {
  try {
    act();
  } catch (const ExerciseError& error) {
    return error.what();
  }
  return "accepted";
}

std::string refused_line(const char* line) {
  return refusal_by([line] { static_cast<void>(parse_prescription(line)); });
}

TEST(PrescriptionLine, ReadsWhatItWrites) {
  const char* line =
      "train_press trials=12 target_success=0.6 difficulty=0.4 pain_limit=3 fatigue_limit=6 "
      "most_repetitions=24 "
      "most_minutes=7.5";
  const Prescription prescription = parse_prescription(line);
  EXPECT_EQ(prescription.trials, std::optional(12));
  EXPECT_EQ(prescription.target_success, std::optional(0.6));
  EXPECT_EQ(prescription_text(prescription), line);
  EXPECT_EQ(parse_prescription("  pinch "), (Prescription{.exercise = "pinch"}));
}

TEST(PrescriptionLine, IsRefusedWithKeyAndRemedy) {
  EXPECT_THAT(refused_line(""), HasSubstr("names no exercise"));
  EXPECT_THAT(refused_line("trials=3"), HasSubstr("begins with the exercise's name"));
  EXPECT_THAT(refused_line("a trails=3"), HasSubstr("did you mean \"trials\"?"));
  EXPECT_THAT(refused_line("a trials=3 trials=4"), HasSubstr("stated twice"));
  EXPECT_THAT(refused_line("a trials=3.5"), HasSubstr("whole number"));
  EXPECT_THAT(refused_line("a target_success=0.95"), HasSubstr(">= 0.5, <= 0.9"));
  EXPECT_THAT(refused_line("a pain_limit=nan"), HasSubstr(">= 1, <= 10"));
  EXPECT_THAT(refused_line("a pain_limit"), HasSubstr("KEY=VALUE"));
}

TEST(PrescribedExercise, HasTheOverrides) {
  const ExerciseDescription exercise = prescribed(
      small_training(), {.exercise = "small", .trials = 5, .target_success = 0.6, .difficulty = 0.9});
  EXPECT_EQ(exercise.trials, 5);
  EXPECT_DOUBLE_EQ(exercise.difficulty->target_success, 0.6);
  EXPECT_DOUBLE_EQ(exercise.difficulty->start, 0.9);
}

TEST(PrescribedExercise, OwnRatingLimitsEndARunEarlier) {
  Bench usual(small_training());
  usual.begin();
  EXPECT_EQ(usual.input(ExerciseInput::Kind::kPain, 3), "");
  EXPECT_FALSE(usual.run.done());
  Bench careful(prescribed(small_training(), {.exercise = "small", .pain_limit = 3, .fatigue_limit = 2}));
  careful.begin();
  EXPECT_EQ(careful.input(ExerciseInput::Kind::kPain, 3), "");
  EXPECT_TRUE(careful.run.done());
  Bench tired(prescribed(small_training(), {.exercise = "small", .fatigue_limit = 2}));
  tired.begin();
  EXPECT_EQ(tired.input(ExerciseInput::Kind::kFatigue, 2), "");
  EXPECT_TRUE(tired.run.done());
}

TEST(PrescribedExercise, ALowerDoseShortensATrainingAndIsHeldOverTheDay) {
  const ExerciseDescription lower =
      prescribed(small_training(), {.exercise = "small", .most_repetitions = 1});
  EXPECT_EQ(lower.trials, 1);
  Bench bench(lower);
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kDone));
  EXPECT_EQ(bench.run.result().repetitions, 1);
  PersonLimits person = able_person();
  person.repetitions_today = 1;
  EXPECT_THROW(Bench(lower, person), ExerciseError);

  Bench minutes(prescribed(small_training(), {.exercise = "small", .most_minutes = 1.0}));
  minutes.begin();
  ASSERT_TRUE(minutes.until(ExercisePhase::kDone));
  EXPECT_LE(minutes.run.result().seconds, 60.1);
}

TEST(PrescribedExercise, TheTargetSuccessMovesTheDifficulty) {
  const std::vector<TrainingSession> history = {{.difficulty = 0.4, .successes = 14, .counted = 20}};
  const Difficulty usual = *small_training().difficulty;
  const Difficulty easier =
      *prescribed(small_training(), {.exercise = "small", .target_success = 0.9}).difficulty;
  EXPECT_LT(next_difficulty(history, easier), next_difficulty(history, usual) - 0.02);
}

TEST(PrescribedExercise, CanRaiseNothingAndAdaptsNoAssessment) {
  const auto refused = [](const ExerciseDescription& exercise, const Prescription& prescription) {
    return refusal_by([&] { static_cast<void>(prescribed(exercise, prescription)); });
  };
  EXPECT_THAT(refused(small_training(), {.exercise = "small", .pain_limit = 6}),
              HasSubstr("can only lower it"));
  EXPECT_THAT(refused(small_training(), {.exercise = "small", .most_repetitions = 101}),
              HasSubstr("allows at most 100"));
  EXPECT_THAT(refused(small_training(), {.exercise = "small", .most_minutes = 31.0}),
              HasSubstr("at most 30"));
  EXPECT_THAT(refused(small_training(), {.exercise = "other"}), HasSubstr("the exercise is small"));
  EXPECT_THAT(refused(small_exercise(ExerciseMeasure::kPinch), {.exercise = "small", .trials = 3}),
              HasSubstr("fixed conditions"));
  EXPECT_EQ(refused(small_exercise(ExerciseMeasure::kPinch), {.exercise = "small", .pain_limit = 3}),
            "accepted");
}

}  // namespace
}  // namespace phalanx
