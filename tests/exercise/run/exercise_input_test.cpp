// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "exercise/run/exercise_fixture.h"

namespace phalanx {
namespace {

using Kind = ExerciseInput::Kind;
using ::testing::HasSubstr;

TEST(ExerciseInputText, ReadsWhatItWrites) {
  for (const ExerciseInput& input :
       {ExerciseInput{.kind = Kind::kBegin}, ExerciseInput{.kind = Kind::kPain, .value = 3.0},
        ExerciseInput{.kind = Kind::kAnswer, .value = 2.0},
        ExerciseInput{.kind = Kind::kDifficulty, .value = 0.1}, ExerciseInput{.kind = Kind::kAbort}})
    EXPECT_EQ(parse_exercise_input(exercise_input_text(input)), input);
  EXPECT_EQ(exercise_input_text({.kind = Kind::kDifficulty, .value = 0.25}), "difficulty 0.25");
}

TEST(ExerciseInputText, RefusesOtherTextsInWords) {
  const auto refusal = [](const char* text) -> std::string {
    try {
      static_cast<void>(parse_exercise_input(text));
    } catch (const ExerciseError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal("pauze"), HasSubstr("did you mean \"pause\"?"));
  EXPECT_THAT(refusal("pain"), HasSubstr("\"pain 3\""));
  EXPECT_THAT(refusal("pain x"), HasSubstr("\"pain 3\""));
  EXPECT_THAT(refusal("pain inf"), HasSubstr("\"pain 3\""));
  EXPECT_THAT(refusal("pause 3"), HasSubstr("has no number"));
  EXPECT_THAT(refusal(""), HasSubstr("known are"));
}

TEST(ExerciseInputs, ARatingAtItsLimitEndsTheExercise) {
  Bench bench(small_exercise(ExerciseMeasure::kPressAndHold));
  EXPECT_EQ(bench.input(Kind::kPain, 4), "");
  bench.begin();
  bench.steps(2.0);
  EXPECT_THAT(bench.input(Kind::kFatigue, 7.5), HasSubstr("whole number from 0 to 10"));
  EXPECT_THAT(bench.input(Kind::kFatigue, 11), HasSubstr("whole number from 0 to 10"));
  EXPECT_EQ(bench.input(Kind::kFatigue, 7), "");
  EXPECT_FALSE(bench.run.done());
  EXPECT_EQ(bench.input(Kind::kPain, 5), "");
  EXPECT_TRUE(bench.run.done());
  EXPECT_FALSE(bench.run.demand().torque);
  const ExerciseResult result = bench.run.result();
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.ended, "pain 5 of 10 has reached the limit 5");
  ASSERT_EQ(result.ratings.size(), 3U);
  EXPECT_EQ(result.ratings[1].value, 7);
  EXPECT_THAT(bench.input(Kind::kResume), HasSubstr("has ended: pain 5 of 10"));
}

TEST(ExerciseInputs, TheTherapistOverridesTheDifficultyOfATrainingOnly) {
  Bench training(small_training());
  training.begin();
  ASSERT_TRUE(training.until(ExercisePhase::kTrial));
  const double wide = training.run.view().target.high - training.run.view().target.low;
  EXPECT_EQ(training.input(Kind::kDifficulty, 1.0), "");
  EXPECT_THAT(training.input(Kind::kDifficulty, 1.5), HasSubstr(">= 0, <= 1"));
  ASSERT_TRUE(training.until(ExercisePhase::kRest));
  ASSERT_TRUE(training.until(ExercisePhase::kTrial));
  // Difficulty 0.3 has a tolerance of 0.4 - 0.3 * 0.3 = 0.31, difficulty 1 has 0.1; the target is 0.5 * 5 N.
  EXPECT_NEAR(wide, 2 * 0.31 * 2.5, 1e-12);
  EXPECT_NEAR(training.run.view().target.high - training.run.view().target.low, 2 * 0.1 * 2.5, 1e-12);

  Bench assessment(small_exercise(ExerciseMeasure::kPressAndHold));
  EXPECT_THAT(assessment.input(Kind::kDifficulty, 0.5), HasSubstr("fixed conditions"));
}

TEST(ExerciseInputs, AreRefusedInPhasesThatDoNotKnowThem) {
  Bench bench(small_exercise(ExerciseMeasure::kPressAndHold));
  EXPECT_NE(bench.input(Kind::kPause), "");
  EXPECT_NE(bench.input(Kind::kResume), "");
  EXPECT_NE(bench.input(Kind::kSkip), "");
  EXPECT_NE(bench.input(Kind::kAnswer, 1), "");
  bench.begin();
  EXPECT_NE(bench.input(Kind::kBegin), "");
  EXPECT_NE(bench.input(Kind::kAnswer, 1), "");
}

}  // namespace
}  // namespace phalanx
