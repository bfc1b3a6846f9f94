// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "exercise/run/exercise_fixture.h"
#include "phalanx/core/random.h"

namespace phalanx {
namespace {

using Kind = ExerciseInput::Kind;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

double score_of(const std::vector<Score>& scores, const std::string& name) {
  for (const Score& score : scores)
    if (score.name == name && score.valid()) return score.value;
  return std::numeric_limits<double>::quiet_NaN();
}

/// Presents one pair. @returns the commanded stiffness of both sponges
std::array<double, 2> feel_pair(Bench& bench) {
  std::array<double, 2> stiffness{};
  for (double& part : stiffness) {
    EXPECT_TRUE(bench.until(ExercisePhase::kTrial));
    part = bench.run.demand().stiffness.value_or(0.0);
    while (bench.run.view().phase == ExercisePhase::kTrial) bench.step();
  }
  return stiffness;
}

TEST(ExerciseStimuli, APersonWhoAlwaysFeelsTheSofterOneHasASmallThreshold) {
  Bench bench(small_exercise(ExerciseMeasure::kFeelAndFind));
  bench.begin();
  int pairs = 0;
  while (!bench.run.done() && pairs < 20) {
    const std::array<double, 2> stiffness = feel_pair(bench);
    ASSERT_EQ(bench.run.view().phase, ExercisePhase::kAnswer);
    EXPECT_THAT(bench.run.view().choices, ElementsAre("the first", "the second"));
    EXPECT_EQ(bench.input(Kind::kAnswer, stiffness[0] < stiffness[1] ? 1 : 2), "");
    ++pairs;
  }
  EXPECT_EQ(pairs, 10);
  const ExerciseResult result = bench.run.result();
  ASSERT_EQ(result.trials.size(), 10U);
  for (const ExerciseTrial& trial : result.trials) {
    EXPECT_EQ(trial.invalid, "");
    EXPECT_NEAR(score_of(trial.scores, "sent_first_n_per_mm"),
                score_of(trial.scores, "commanded_first_n_per_mm"), 1e-9);
    EXPECT_LE(score_of(trial.scores, "commanded_second_n_per_mm"), 0.7);
    // Both sponges: to each end position at 4 mm/s and 0.5 s there, with a rest of 1 s between them.
    EXPECT_GT(trial.end - trial.begin, 2.0);
  }
  EXPECT_LT(score_of(result.scores, "stiffness_threshold_percent"), 15.0);
}

/// Presses, lets go and touches at times drawn by a seed, but as the view asks for: no sponge is touched
/// in a rest.
class DrawnPresses {
 public:
  explicit DrawnPresses(std::uint64_t seed) : random_(seed) {}
  void operator()(Observation& observation, const ExerciseView& view) {
    Bench::follow(observation, view);
    if (view.phase != ExercisePhase::kTrial) return;
    depth_ = std::clamp(depth_ + random_.between(-0.5e-3, 0.9e-3), 0.0, 8e-3);
    if (view.progress < 0.02) depth_ = 0.0;
    const bool thumb = random_.uniform() < 0.3;
    for (const int digit : {0, 1}) {
      const bool touches = digit == 1 ? depth_ > 0.0 : thumb && depth_ > 0.0;
      observation.touching[idx(digit)] = touches;
      observation.force[idx(digit)] = touches ? observation.stiffness * depth_ : 0.0;
      observation.sent_stiffness[idx(digit)] =
          touches ? observation.stiffness : std::numeric_limits<double>::quiet_NaN();
      observation.depth[idx(digit)] = touches ? depth_ : std::numeric_limits<double>::quiet_NaN();
    }
  }

 private:
  Random random_;
  double depth_ = 0.0;
};

TEST(ExerciseStimuli, TheViewHasNoPropertyOfAStimulus) {
  // Two runs differ only in stiffness and order: the same person with the same movements sees the same at
  // each step, up to the end position, which discrimination.h balances. Forces differ, since the sponges do.
  bool stimuli_differ = false;
  bool presses = false;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    ExerciseDescription exercise = small_exercise(ExerciseMeasure::kFeelAndFind);
    Bench one(exercise, able_person(), 2 * seed);
    exercise.feel.softest = 150.0;
    Bench other(exercise, able_person(), 2 * seed);  // equal end positions, other sponges
    one.act = DrawnPresses(seed);
    other.act = DrawnPresses(seed);
    one.begin();
    other.begin();
    for (int i = 0; i < 3000 && !one.run.done(); ++i) {
      one.step();
      other.step();
      const ExerciseView& a = one.run.view();
      const ExerciseView& b = other.run.view();
      ASSERT_EQ(a.phase, b.phase) << i;
      EXPECT_EQ(a.instruction, b.instruction);
      EXPECT_EQ(a.note, b.note);
      EXPECT_EQ(a.value, std::nullopt);
      EXPECT_EQ(a.target.depth, b.target.depth);
      EXPECT_EQ(a.progress, b.progress);
      EXPECT_EQ(a.remaining_s, b.remaining_s);
      EXPECT_EQ(one.run.demand().torque, other.run.demand().torque);
      const bool felt = a.phase == ExercisePhase::kTrial;
      if (felt) {
        EXPECT_TRUE(a.hides_scene);
      }
      presses = presses || (felt && one.observation.force[1] > 0.0);
      stimuli_differ = stimuli_differ || one.run.demand().stiffness != other.run.demand().stiffness;
      if (a.phase == ExercisePhase::kAnswer) {
        EXPECT_EQ(one.input(Kind::kAnswer, 1), "");
        EXPECT_EQ(other.input(Kind::kAnswer, 1), "");
      }
    }
  }
  EXPECT_TRUE(stimuli_differ);
  EXPECT_TRUE(presses);
}

TEST(ExerciseStimuli, NothingIsFeltOutsideOfAPress) {
  for (const auto measure : {ExerciseMeasure::kFeelAndFind, ExerciseMeasure::kObjectInHand}) {
    SCOPED_TRACE(exercise_measure_name(measure));
    ExerciseDescription exercise = small_exercise(measure);
    exercise.warm_up_s = 2.0;
    Bench bench(exercise);
    bench.begin();
    std::optional<double> stiffness;
    std::optional<int> object;
    int trials = 0;
    for (int i = 0; i < 8000 && !bench.run.done(); ++i) {
      const ExercisePhase before = bench.run.view().phase;
      bench.step();
      const ExercisePhase phase = bench.run.view().phase;
      const ExerciseDemand& demand = bench.run.demand();
      if (phase == ExercisePhase::kTrial && before != phase) ++trials;
      if (phase == ExercisePhase::kRest && before != phase) {
        EXPECT_FALSE(demand.torque) << "before each trial, whether the stimulus changes or not";
      }
      if (phase != ExercisePhase::kRest && phase != ExercisePhase::kTrial) {
        EXPECT_FALSE(demand.torque) << exercise_phase_name(phase);
      }
      if (demand.stiffness != stiffness || demand.object != object) {
        EXPECT_FALSE(demand.torque) << "a stimulus changes at zero torque";
      }
      stiffness = demand.stiffness;
      object = demand.object;
      if (phase == ExercisePhase::kAnswer) {
        bench.steps(1.0);
        EXPECT_FALSE(bench.run.demand().torque);
        EXPECT_EQ(bench.input(Kind::kAnswer, 1), "");
      }
    }
    EXPECT_TRUE(bench.run.done());
    EXPECT_GE(trials, 4);
  }
}

TEST(ExerciseStimuli, ATouchBeforeThePressTurnsTheTorqueOff) {
  Bench bench(small_exercise(ExerciseMeasure::kFeelAndFind));
  bench.begin();
  bench.steps(0.8);
  ASSERT_EQ(bench.run.view().phase, ExercisePhase::kRest);
  ASSERT_TRUE(bench.run.demand().torque);
  bench.act = [](Observation& observation, const ExerciseView& view) {
    Bench::follow(observation, view);
    observation.touching[0] = true;  // the thumb, which is not instructed
  };
  bench.step();
  EXPECT_FALSE(bench.run.demand().torque);
  bench.steps(3.0);
  EXPECT_EQ(bench.run.view().note, "it waits: the thumb touches; let go");
  EXPECT_FALSE(bench.run.demand().torque);
  bench.act = Bench::follow;
  bench.steps(0.1);
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kTrial);
}

TEST(ExerciseStimuli, APressThatDoesNotReachItsEndPositionDoesNotCount) {
  Bench bench(small_exercise(ExerciseMeasure::kFeelAndFind));
  bench.act = [](Observation& observation, const ExerciseView& view) {
    Bench::follow(observation, view);
    if (view.phase != ExercisePhase::kTrial) return;
    observation.depth[1] = std::min(observation.depth[1], 0.5e-3);
  };
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kTrial));
  ASSERT_TRUE(bench.until(ExercisePhase::kRest));
  ASSERT_EQ(bench.run.result().trials.size(), 1U) << "without an answer";
  const ExerciseTrial trial = bench.run.result().trials[0];
  EXPECT_EQ(trial.invalid, "the end position was not reached within 6 s");
  EXPECT_NEAR(score_of(trial.scores, "sent_first_n_per_mm"),
              score_of(trial.scores, "commanded_first_n_per_mm"), 1e-9);
}

TEST(ExerciseStimuli, AnObjectThatWasNotTouchedHasNoAnswer) {
  Bench bench(small_exercise(ExerciseMeasure::kObjectInHand));
  bench.act = [](Observation& observation, const ExerciseView& view) {
    Bench::follow(observation, view);
    observation.touching.fill(false);
  };
  bench.begin();
  ASSERT_TRUE(bench.until(ExercisePhase::kTrial));
  bench.steps(2.0);
  EXPECT_TRUE(bench.run.view().choices.empty());
  EXPECT_EQ(bench.input(Kind::kAnswer, 1), "feel the object first, for at least 1 s");
  ASSERT_TRUE(bench.until(ExercisePhase::kRest));
  ASSERT_EQ(bench.run.result().trials.size(), 1U);
  EXPECT_EQ(bench.run.result().trials[0].invalid, "the object was touched for less than 1 s");

  bench.act = Bench::follow;
  ASSERT_TRUE(bench.until(ExercisePhase::kTrial));
  bench.steps(1.2);
  EXPECT_THAT(bench.run.view().choices, ElementsAre("ball", "cube"));
  EXPECT_EQ(bench.input(Kind::kAnswer, 1), "");
}

TEST(ExerciseStimuli, WithoutAKnownStableStiffnessNoPairIsPresented) {
  PersonLimits person = able_person();
  person.stable_stiffness.reset();
  try {
    const Bench bench(small_exercise(ExerciseMeasure::kFeelAndFind), person);
    ADD_FAILURE() << "accepted";
  } catch (const ExerciseError& error) {
    EXPECT_THAT(error.what(), HasSubstr("stable is not known"));
  }
  EXPECT_NO_THROW(Bench(small_exercise(ExerciseMeasure::kPressAndHold), person));
}

TEST(ExerciseStimuli, NoStimulusExceedsALimitOfPersonDeviceOrExercise) {
  for (const int limit : {0, 1, 2}) {
    PersonLimits person = able_person();
    ExerciseDescription exercise = small_exercise(ExerciseMeasure::kFeelAndFind);
    if (limit == 0) person.stable_stiffness = 400.0;
    if (limit == 1) person.stiffness_cap = 400.0;
    if (limit == 2) exercise.limits.stiffness = 400.0;
    Bench bench(exercise, person);
    bench.begin();
    for (int i = 0; i < 4000 && !bench.run.done(); ++i) {
      bench.step();
      EXPECT_LE(bench.run.demand().stiffness.value_or(0.0), 400.0);
      if (bench.run.view().phase == ExercisePhase::kAnswer) {
        EXPECT_EQ(bench.input(Kind::kAnswer, 1 + i % 2), "");
      }
    }
    EXPECT_TRUE(bench.run.done());
  }
  PersonLimits person = able_person();
  person.stable_stiffness = 101.0;
  EXPECT_THROW(Bench(small_exercise(ExerciseMeasure::kFeelAndFind), person), ExerciseError);
}

TEST(ExerciseStimuli, ASpongeIsPresentedOnlyWhenTheStationHasItsStiffness) {
  Bench bench(small_exercise(ExerciseMeasure::kFeelAndFind));
  double share = 1.02;
  bench.act = [&](Observation& observation, const ExerciseView& view) {
    observation.stiffness *= share;
    Bench::follow(observation, view);
  };
  bench.begin();
  bench.steps(10.0);
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kRest);
  EXPECT_FALSE(bench.run.demand().torque);
  EXPECT_EQ(bench.run.view().note, "it waits: the next one is not ready");
  share = 1.0;
  bench.steps(0.1);
  EXPECT_EQ(bench.run.view().phase, ExercisePhase::kTrial);
}

TEST(ExerciseStimuli, AStimulusThatWasNotSentAsCommandedReportsWhatWasSentAndDoesNotCount) {
  Bench bench(small_exercise(ExerciseMeasure::kFeelAndFind));
  bench.act = [](Observation& observation, const ExerciseView& view) {
    Bench::follow(observation, view);
    observation.sent_stiffness[1] *= 0.8;
  };
  bench.begin();
  const std::array<double, 2> commanded = feel_pair(bench);
  EXPECT_EQ(bench.input(Kind::kAnswer, 1), "");
  ASSERT_EQ(bench.run.result().trials.size(), 1U);
  const ExerciseTrial trial = bench.run.result().trials[0];
  EXPECT_THAT(trial.invalid,
              HasSubstr("100 % of the samples were not within 10 % of the commanded stiffness"));
  EXPECT_NEAR(score_of(trial.scores, "sent_first_n_per_mm"), 0.8e-3 * commanded[0], 1e-9);
  EXPECT_NEAR(score_of(trial.scores, "sent_second_n_per_mm"), 0.8e-3 * commanded[1], 1e-9);
  EXPECT_EQ(bench.run.view().note.find("N/m"), std::string::npos) << "a participant reads it";
  EXPECT_FALSE(bench.run.done());
}

TEST(ExerciseStimuli, ObjectsChangeAtZeroTorqueAndTheirAnswersAreCounted) {
  Bench bench(small_exercise(ExerciseMeasure::kObjectInHand));
  bench.begin();
  std::optional<int> shown;
  std::set<int> objects;
  bool was_on = false;
  for (int i = 0; i < 20'000 && !bench.run.done(); ++i) {
    bench.step();
    const std::optional<int> object = bench.run.demand().object;
    if (object != shown) {
      EXPECT_FALSE(bench.run.demand().torque) << "the object changes at zero torque";
      shown = object;
      if (object) objects.insert(*object);
    }
    was_on = was_on || bench.run.demand().torque;
    if (bench.run.view().phase == ExercisePhase::kAnswer) {
      EXPECT_THAT(bench.run.view().choices, ElementsAre("ball", "cube"));
      EXPECT_EQ(bench.input(Kind::kAnswer, shown.value_or(0) + 1), "");
    }
  }
  EXPECT_TRUE(was_on);
  EXPECT_EQ(objects.size(), 2U);
  const ExerciseResult result = bench.run.result();
  EXPECT_EQ(result.trials.size(), 4U);
  EXPECT_NEAR(score_of(result.scores, "identified_percent"), 100.0, 1e-9);
}

}  // namespace
}  // namespace phalanx
