// SPDX-License-Identifier: Apache-2.0
// What the games of the patient's screen reward: strong simulated participants above weak ones, and a hand that moves at
// random no more than by chance. The games show what the exercise says, so that the exercise is what is tested.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "phalanx/clinic/exercise_participant.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/core/random.h"
#include "phalanx/exercise/exercise_run.h"
#include "phalanx/hand/pad.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/exercise_file.h"
#include "phalanx/scene/scene_file.h"

namespace phalanx {
namespace {

constexpr double kStepPeriod = 0.01;       // [s]
constexpr double kLongestExercise = 3600;  // [s]
constexpr double kLever = 0.04;            // depth of a fingertip in the object per flexion [m/rad]
constexpr double kBegins = 0.25;           // share of the flexion at which the object begins [-]
constexpr double kBallStiffness = 600.0;   // [N/m]
constexpr double kLargestForce = 5.0;      // [N]
constexpr std::array<std::uint64_t, 4> kSeeds = {9101, 9102, 9103, 9104};

/// What a hand does, from what its owner sees.
using Hand = std::function<ExerciseParticipant::Act(double now, const ExerciseView& view,
                                                    const std::optional<Observation>& felt,
                                                    const std::optional<int>& object)>;

PersonLimits person_of_hand(const HandParameters& hand) {
  PersonLimits person;
  person.own_force.fill(kLargestForce);
  for (std::size_t j = 0; j < kJoints; ++j)
    if (const double closed = hand.closed_angle[j].value_or(hand.max_angle[j]); closed > hand.open_angle[j])
      person.own_range[j] = OwnRange{.min = hand.open_angle[j], .max = closed};
  person.calibration_independent = true;
  person.stable_stiffness = 800.0;
  person.detects_slips = true;
  return person;
}

/// Observes a hand at a compliant object: each digit's depth rises with its flexion.
Observation observed(const HandModel& model, const JointArray& angle, double now, std::uint64_t tick,
                     const ExerciseDemand& demand) {
  const HandParameters& hand = model.parameters();
  Observation out;
  out.time = now;
  out.sample_time = now;
  out.tick = tick;
  out.angle = angle;
  out.angle_origin.fill(AngleOrigin::kMeasured);
  out.torque_on = demand.torque;
  out.factor = demand.torque ? 1.0 : 0.0;
  out.stiffness = demand.stiffness.value_or(kBallStiffness);
  out.measured_force.fill(std::numeric_limits<double>::quiet_NaN());
  out.sent_stiffness.fill(std::numeric_limits<double>::quiet_NaN());
  out.depth.fill(std::numeric_limits<double>::quiet_NaN());
  for (int digit = 0; digit < kDigits; ++digit) {
    double flexion = 0.0;
    double range = 0.0;
    for (int k = 0; k < kJointsPerDigit; ++k) {
      if (k == kAbductionJoint) continue;
      const std::size_t j = idx(joint_index(digit, k));
      flexion += angle[j] - hand.open_angle[j];
      range += hand.closed_angle[j].value_or(hand.max_angle[j]) - hand.open_angle[j];
    }
    const std::size_t d = idx(digit);
    out.pad[d] = pad_at(model, digit, digit_angles(angle, digit));
    const double depth = kLever * (flexion - kBegins * range);
    if (!demand.torque || depth <= 0.0) continue;
    out.touching[d] = true;
    out.force[d] = std::min(kLargestForce, out.stiffness * depth);
    out.depth[d] = depth;
    out.sent_stiffness[d] = out.force[d] / depth;
  }
  return out;
}

ExerciseResult carried_out(const ExerciseDescription& exercise, const HandModel& model, std::uint64_t seed,
                           const Hand& hand) {
  ExerciseRun run(exercise, person_of_hand(model.parameters()), seed);
  EXPECT_EQ(run.input({.kind = ExerciseInput::Kind::kBegin}), "");
  std::optional<Observation> felt;
  std::uint64_t tick = 0;
  for (double now = kStepPeriod; now < kLongestExercise && !run.done(); now += kStepPeriod) {
    const ExerciseParticipant::Act act = hand(now, run.view(), felt, run.demand().object);
    felt = observed(model, act.angle, now, ++tick, run.demand());
    run.step(*felt);
    if (act.input) static_cast<void>(run.input(*act.input));
  }
  EXPECT_TRUE(run.done()) << exercise.name << ", seed " << seed;
  return run.result();
}

ExerciseResult of_participant(const ExerciseDescription& exercise, const HandModel& model,
                              const ParticipantSkill& skill, std::uint64_t seed) {
  ExerciseParticipant participant(model, exercise, skill, seed, std::nullopt);
  return carried_out(
      exercise, model, seed,
      [&](double now, const ExerciseView& view, const std::optional<Observation>& felt,
          const std::optional<int>& object) { return participant.act(now, view, felt, object); });
}

/// A hand whose digits bend and stretch at random, whatever is asked, and whose answers are drawn.
ExerciseResult of_random_input(const ExerciseDescription& exercise, const HandModel& model,
                               std::uint64_t seed) {
  const HandParameters& limits = model.parameters();
  Random random(seed);
  std::array<double, kDigits> curl{};
  std::array<double, kDigits> aim{};
  std::array<double, kDigits> until{};
  double answered = 0.0;
  return carried_out(
      exercise, model, seed,
      [&](double now, const ExerciseView& view, const std::optional<Observation>&,
          const std::optional<int>&) {
        ExerciseParticipant::Act act{.angle = limits.open_angle, .input = {}};
        for (int digit = 0; digit < kDigits; ++digit) {
          const std::size_t d = idx(digit);
          if (now >= until[d]) {
            aim[d] = random.uniform();
            until[d] = now + random.between(0.3, 2.0);
          }
          curl[d] += 5.0 * kStepPeriod * (aim[d] - curl[d]);
          for (int k = 0; k < kJointsPerDigit; ++k) {
            const std::size_t j = idx(joint_index(digit, k));
            const double closed = limits.closed_angle[j].value_or(limits.max_angle[j]);
            act.angle[j] = limits.open_angle[j] + curl[d] * (closed - limits.open_angle[j]);
          }
        }
        if (view.asks) {
          act.input = ExerciseInput{.kind = *view.asks, .value = 0.0};
        } else if (view.phase == ExercisePhase::kAnswer && now - answered > 0.5) {
          answered = now;
          const double choice = std::floor(random.between(0.0, static_cast<double>(view.choices.size())));
          act.input = ExerciseInput{.kind = ExerciseInput::Kind::kAnswer, .value = 1.0 + choice};
        }
        return act;
      });
}

const HandModel& games_hand() {
  static const HapticModel kModel = build_model(load_scene("wave"));
  return kModel.hand;
}

/// Successes of trainings at the difficulty of the first session, and the trials that counted.
struct Successes {
  int successes = 0;
  int counted = 0;
  void add(const ExerciseResult& result) {
    successes += result.successes;
    counted += result.counted;
  }
  [[nodiscard]] double share() const { return counted == 0 ? 0.0 : static_cast<double>(successes) / counted; }
};

double score_of(const ExerciseResult& result, const std::string& name) {
  for (const Score& score : result.scores)
    if (score.name == name && score.valid()) return score.value;
  ADD_FAILURE() << result.name << " has no valid score " << name << ": " << result.ended
                << (result.scores.empty() ? "" : result.scores.front().invalid);
  return std::numeric_limits<double>::quiet_NaN();
}

/// Mean of the scores whose names contain a text.
double mean_of(const ExerciseResult& result, const std::string& part) {
  double sum = 0.0;
  int count = 0;
  for (const Score& score : result.scores) {
    if (score.name.find(part) == std::string::npos || !score.valid()) continue;
    sum += score.value;
    ++count;
  }
  EXPECT_GT(count, 0) << part;
  return sum / std::max(1, count);
}

/// Trainings of River (press, tracking) and of Melody (opposition).
class TrainingGames : public testing::TestWithParam<const char*> {};

TEST_P(TrainingGames, RewardStrongParticipantsAboveWeakOnesAndNoRandomInput) {
  const ExerciseDescription exercise = load_exercise(GetParam());
  Successes strong;
  Successes weak;
  Successes random;
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE(seed);
    const ExerciseResult healthy = of_participant(exercise, games_hand(), demo_skill("healthy"), seed);
    const ExerciseResult severe = of_participant(exercise, games_hand(), demo_skill("severe"), seed);
    EXPECT_GT(healthy.successes, severe.successes);
    strong.add(healthy);
    weak.add(severe);
    random.add(of_random_input(exercise, games_hand(), seed));
  }
  EXPECT_GT(strong.share(), 0.9);
  EXPECT_GT(random.counted, 70);
  EXPECT_LT(random.share(), 0.15);  // what a hand that ignores the target may get
  RecordProperty("strong", std::to_string(strong.share()));
  RecordProperty("weak", std::to_string(weak.share()));
  RecordProperty("random", std::to_string(random.share()));
}

INSTANTIATE_TEST_SUITE_P(Of, TrainingGames,
                         testing::Values("train_press", "train_tracking", "train_opposition"));

TEST(FeelAndFindGame, FindsSmallThresholdsOfStrongParticipantsAndLargeOnesOfWeakOnes) {
  const ExerciseDescription exercise = load_exercise("feel_and_find");
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE(seed);
    const char* const threshold = "stiffness_threshold_percent";
    EXPECT_LT(score_of(of_participant(exercise, games_hand(), demo_skill("healthy"), seed), threshold),
              score_of(of_participant(exercise, games_hand(), demo_skill("severe"), seed), threshold));
  }
}

TEST(FeelAndFindGame, GivesNoThresholdToAnswersThatAreDrawnAndFindsObjectsAsByChance) {
  ParticipantSkill guesses = demo_skill("healthy");
  guesses.lapses = 1.0;
  guesses.recognition = 0.0;
  double object = 0.0;
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE(seed);
    const ExerciseResult felt = of_participant(load_exercise("feel_and_find"), games_hand(), guesses, seed);
    EXPECT_FALSE(felt.interrupted) << felt.ended;
    EXPECT_TRUE(std::none_of(felt.scores.begin(), felt.scores.end(),
                             [](const Score& score) { return score.valid(); }));
    object += score_of(of_participant(load_exercise("object_in_hand"), games_hand(), guesses, seed),
                       "identified_percent");
  }
  // 72 answers of three: three standard deviations of the binomial around 33.3 %.
  EXPECT_NEAR(object / kSeeds.size(), 100.0 / 3.0, 17.0);
}

TEST(MelodyGame, HearsOneFingerOfAStrongParticipantAndMoreOfAWeakOne) {
  const ExerciseDescription exercise = load_exercise("independence");
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE(seed);
    const double strong =
        mean_of(of_participant(exercise, games_hand(), demo_skill("healthy"), seed), "enslaving");
    const double weak =
        mean_of(of_participant(exercise, games_hand(), demo_skill("severe"), seed), "enslaving");
    const double random = mean_of(of_random_input(exercise, games_hand(), seed), "enslaving");
    EXPECT_LT(strong, weak);
    EXPECT_LT(weak, random);
  }
}

}  // namespace
}  // namespace phalanx
