// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/simulated_participant.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "phalanx/core/index.h"
#include "phalanx/exercise/discrimination.h"
#include "phalanx/exercise/participant_skill.h"

namespace phalanx {
namespace {

using Kind = ParticipantTarget::Kind;

constexpr double kPeriod = 0.005;
constexpr int kIndexFlexion = joint_index(1, 0);
constexpr int kMiddleFlexion = joint_index(2, 0);
constexpr int kLittleFlexion = joint_index(4, 0);
constexpr std::array<bool, kDigits> kIndex{false, true, false, false, false};

/// A hand whose flexion joints go from 0 to 1.5 rad.
ParticipantHand plain_hand() {
  ParticipantHand hand;
  for (int joint = 0; joint < kJoints; ++joint) {
    const bool sideways = joint % kJointsPerDigit == kAbductionJoint;
    hand.least[idx(joint)] = sideways ? -0.3 : -0.2;
    hand.most[idx(joint)] = sideways ? 0.3 : 1.6;
    hand.closed[idx(joint)] = sideways ? 0.0 : 1.5;
  }
  return hand;
}

/// A skill without noise, mistakes and fatigue.
ParticipantSkill exact() {
  return {.reaction_time = 0.25,
          .reaction_sd = 0.0,
          .tremor = 0.0,
          .force_noise = 0.0,
          .enslaving = 0.0,
          .fatigue_time = 1e6,
          .mistakes = 0.0,
          .lapses = 0.0,
          .recognition = 1.0};
}

/// A sponge in front of each digit: the pad goes 60 mm a radian of its first joint, behind a device with a
/// lag of 0.05 s.
struct Sponge {
  double stiffness = 400.0;
  double begin = 0.03;  ///< of the sponge on the pad's way [m]
  std::array<double, kDigits> lagged{};
  ParticipantFelt last{};

  ParticipantFelt felt(const JointArray& angle) {
    ParticipantFelt out;
    out.stiffness.fill(std::numeric_limits<double>::quiet_NaN());
    for (int digit = 0; digit < kDigits; ++digit) {
      double& x = lagged[idx(digit)];
      x += (1.0 - std::exp(-kPeriod / 0.05)) * (0.06 * angle[idx(joint_index(digit, 0))] - x);
      const double depth = std::max(0.0, x - begin);
      out.force[idx(digit)] = stiffness * depth;
      if (depth > 0.3e-3) out.stiffness[idx(digit)] = stiffness;
    }
    return out;
  }
};

/// Runs a participant; `each` sees every action and what was felt.
template <typename Each>
void run(SimulatedParticipant& participant, Sponge& sponge, double& now, double seconds,
         const ParticipantTarget& target, Each&& each) {
  for (const double end = now + seconds; now < end - 1e-9;) {
    now += kPeriod;
    const ParticipantAction action = participant.step(now, target, sponge.last);
    sponge.last = sponge.felt(action.angle);
    each(action, sponge.last);
  }
}

ParticipantTarget to_angle(double angle, std::uint64_t number) {
  ParticipantTarget target{.kind = Kind::kAngles, .number = number, .digits = kIndex};
  target.angle[idx(kIndexFlexion)] = angle;
  return target;
}

TEST(SimulatedParticipant, ReactsAfterItsReactionTimeAndArrivesAfterItsMovementTime) {
  SimulatedParticipant participant(plain_hand(), exact(), 1);
  Sponge far{.begin = 1.0};
  double now = 0.0;
  run(participant, far, now, 1.0, {}, [](const auto&, const auto&) {});
  const double begin = now;
  double moved = 0.0;
  double arrived = 0.0;
  run(participant, far, now, 2.0, to_angle(1.0, 1), [&](const ParticipantAction& action, const auto&) {
    const double angle = action.angle[idx(kIndexFlexion)];
    if (moved == 0.0 && angle > 1e-6) moved = now - begin;
    if (arrived == 0.0 && angle > 0.9) arrived = now - begin;
  });
  EXPECT_NEAR(moved, 0.25, 0.02);
  EXPECT_NEAR(arrived, 0.25 + 0.35, 0.02);
}

TEST(SimulatedParticipant, FollowsAMovingTargetWithALag) {
  SimulatedParticipant participant(plain_hand(), exact(), 2);
  double lag = 0.0;
  int samples = 0;
  for (int i = 1; i < 4000; ++i) {
    const double now = kPeriod * i;
    const double speed = 0.05;
    const ParticipantAction action = participant.step(now, to_angle(speed * now, 1), {});
    if (now < 4.0) continue;
    lag += now - action.angle[idx(kIndexFlexion)] / speed;
    ++samples;
  }
  // The reaction time and, for a ramp, 2 / w of the critically damped movement: 0.25 + 2 * 0.35 / 3.89.
  EXPECT_NEAR(lag / samples, 0.43, 0.01);
}

TEST(SimulatedParticipant, ReachesAndHoldsAForce) {
  for (const double stiffness : {100.0, 400.0, 1600.0}) {
    for (const double newton : {1.0, 4.0}) {
      SCOPED_TRACE(stiffness);
      SCOPED_TRACE(newton);
      SimulatedParticipant participant(plain_hand(), exact(), 3);
      Sponge sponge{.stiffness = stiffness, .begin = 0.01};
      ParticipantTarget target{.kind = Kind::kForce, .number = 1, .digits = kIndex};
      target.force[1] = newton;
      double now = 0.0;
      run(participant, sponge, now, 6.0, target, [](const auto&, const auto&) {});
      double least = 1e9;
      double most = 0.0;
      run(participant, sponge, now, 2.0, target, [&](const auto&, const ParticipantFelt& felt) {
        least = std::min(least, felt.force[1]);
        most = std::max(most, felt.force[1]);
      });
      EXPECT_NEAR(least, newton, 0.05 * newton);
      EXPECT_NEAR(most, newton, 0.05 * newton);
    }
  }
}

TEST(SimulatedParticipant, EveryPresetHoldsHalfOfItsStrengthOnAverageAndReleasesIt) {
  for (const std::string_view name : participant_skill_names()) {
    SCOPED_TRACE(name);
    ParticipantSkill skill = *find_participant_skill(name);
    skill.mistakes = 0.0;
    SimulatedParticipant participant(plain_hand(), skill, 30);
    Sponge sponge{.stiffness = 400.0, .begin = 0.03};
    ParticipantTarget target{.kind = Kind::kForce, .number = 1, .digits = kIndex};
    target.force[1] = std::min(3.0, 0.5 * skill.strength);
    double now = 0.0;
    run(participant, sponge, now, 15.0, target, [](const auto&, const auto&) {});
    double mean = 0.0;
    run(participant, sponge, now, 5.0, target,
        [&](const auto&, const ParticipantFelt& felt) { mean += felt.force[1] * kPeriod / 5.0; });
    EXPECT_NEAR(mean, target.force[1], 0.2 * target.force[1]);
    target.number = 2;
    target.force[1] = 0.0;
    run(participant, sponge, now, 4.0, target, [](const auto&, const auto&) {});
    EXPECT_LT(sponge.last.force[1], 0.2 * skill.strength * 0.5);
  }
}

TEST(SimulatedParticipant, AWeakOneDoesNotExceedItsStrength) {
  ParticipantSkill skill = exact();
  skill.strength = 2.0;
  SimulatedParticipant participant(plain_hand(), skill, 4);
  Sponge sponge{.stiffness = 400.0, .begin = 0.01};
  ParticipantTarget target{.kind = Kind::kForce, .number = 1, .digits = kIndex};
  target.force[1] = 6.0;
  double now = 0.0;
  double last = 0.0;
  run(participant, sponge, now, 8.0, target,
      [&](const auto&, const ParticipantFelt& felt) { last = felt.force[1]; });
  EXPECT_NEAR(last, 2.0, 0.1);
}

TEST(SimulatedParticipant, PressesToADepthWhateverTheStiffness) {
  for (const double stiffness : {150.0, 600.0}) {
    SCOPED_TRACE(stiffness);
    SimulatedParticipant participant(plain_hand(), exact(), 5);
    Sponge sponge{.stiffness = stiffness, .begin = 0.01};
    const ParticipantTarget target{.kind = Kind::kDepth, .number = 1, .digits = kIndex, .depth = 4e-3};
    double now = 0.0;
    double depth = 0.0;
    run(participant, sponge, now, 8.0, target,
        [&](const auto&, const ParticipantFelt& felt) { depth = felt.force[1] / stiffness; });
    EXPECT_NEAR(depth, 4e-3, 0.2e-3);
  }
}

TEST(SimulatedParticipant, OtherDigitsFollowByEnslavingLessWithDistance) {
  ParticipantSkill skill = exact();
  skill.enslaving = 0.3;
  SimulatedParticipant participant(plain_hand(), skill, 6);
  Sponge far{.begin = 1.0};
  double now = 0.0;
  JointArray angle{};
  run(participant, far, now, 6.0, to_angle(1.0, 1),
      [&](const ParticipantAction& action, const auto&) { angle = action.angle; });
  EXPECT_NEAR(angle[idx(kIndexFlexion)], 1.0, 1e-3);
  EXPECT_NEAR(angle[idx(kMiddleFlexion)], 0.3, 1e-3);
  EXPECT_NEAR(angle[idx(kLittleFlexion)], 0.1, 1e-3);
}

TEST(SimulatedParticipant, ALimitedRangeIsNotLeft) {
  ParticipantSkill skill = exact();
  skill.flexion_deficit = 0.5;
  skill.extension_deficit = 0.25;
  SimulatedParticipant participant(plain_hand(), skill, 7);
  Sponge far{.begin = 1.0};
  double now = 0.0;
  double most = 0.0;
  double least = 9.0;
  for (const double angle : {1.5, -0.2}) {
    run(participant, far, now, 4.0, to_angle(angle, static_cast<std::uint64_t>(10.0 * angle + 100.0)),
        [&](const ParticipantAction& action, const auto&) {
          most = std::max(most, action.angle[idx(kIndexFlexion)]);
          least = std::min(least, action.angle[idx(kIndexFlexion)]);
        });
  }
  EXPECT_NEAR(most, 1.6 - 0.5 * 1.8, 0.01);
  EXPECT_NEAR(least, -0.2 + 0.25 * 1.8, 0.01);
}

TEST(SimulatedParticipant, TrembleHasItsAmplitude) {
  ParticipantSkill skill = exact();
  skill.tremor = 0.02;
  SimulatedParticipant participant(plain_hand(), skill, 8);
  Sponge far{.begin = 1.0};
  double now = 0.0;
  double most = 0.0;
  double least = 9.0;
  int crossings = 0;
  double before = 0.0;
  run(participant, far, now, 10.0, {}, [&](const ParticipantAction& action, const auto&) {
    const double angle = action.angle[idx(kIndexFlexion)];
    most = std::max(most, angle);
    least = std::min(least, angle);
    if (before < 0.0 && angle >= 0.0) ++crossings;
    before = angle;
  });
  EXPECT_NEAR(most, 0.02 * 1.5, 1e-3);
  EXPECT_NEAR(least, -0.02 * 1.5, 1e-3);
  EXPECT_NEAR(crossings, 90, 2) << "9 Hz for 10 s";
}

TEST(SimulatedParticipant, EffortTiresAndRestRecovers) {
  ParticipantSkill skill = exact();
  skill.strength = 4.0;
  skill.fatigue_time = 20.0;
  skill.recovery_time = 10.0;
  SimulatedParticipant participant(plain_hand(), skill, 9);
  Sponge sponge{.stiffness = 400.0, .begin = 0.01};
  ParticipantTarget target{.kind = Kind::kForce, .number = 1, .digits = kIndex};
  target.force[1] = 4.0;
  double now = 0.0;
  double last = 0.0;
  run(participant, sponge, now, 30.0, target,
      [&](const auto&, const ParticipantFelt& felt) { last = felt.force[1]; });
  EXPECT_GT(participant.fatigue(), 0.4);
  EXPECT_LT(last, 3.2);
  const double tired = participant.fatigue();
  run(participant, sponge, now, 30.0, {.number = 2}, [](const auto&, const auto&) {});
  EXPECT_LT(participant.fatigue(), 0.3 * tired);
  participant.new_session(skill);
  EXPECT_EQ(participant.fatigue(), 0.0);
}

TEST(SimulatedParticipant, MistakesMoveAnotherDigitOrNone) {
  ParticipantSkill skill = exact();
  skill.mistakes = 1.0;
  SimulatedParticipant participant(plain_hand(), skill, 10);
  Sponge far{.begin = 1.0};
  double now = 0.0;
  for (std::uint64_t number = 1; number < 9; ++number) {
    double index = 0.0;
    run(participant, far, now, 2.0, to_angle(1.0, number),
        [&](const ParticipantAction& action, const auto&) { index = action.angle[idx(kIndexFlexion)]; });
    EXPECT_LT(index, 0.01);
  }
}

TEST(SimulatedParticipant, AnswersEachQuestionOnce) {
  SimulatedParticipant participant(plain_hand(), exact(), 11);
  Sponge far{.begin = 1.0};
  double now = 0.0;
  std::vector<int> answers;
  const auto collect = [&](const ParticipantAction& action, const auto&) {
    if (action.answer) answers.push_back(*action.answer);
  };
  run(participant, far, now, 2.0, {.kind = Kind::kObject, .number = 1, .options = 5, .truth = 3}, collect);
  run(participant, far, now, 2.0, {.kind = Kind::kObject, .number = 2, .options = 5, .truth = 0}, collect);
  run(participant, far, now, 2.0, {.kind = Kind::kPain, .number = 3}, collect);
  run(participant, far, now, 2.0, {.kind = Kind::kFatigue, .number = 4}, collect);
  EXPECT_EQ(answers, (std::vector<int>{3, 0, 0, 0}));
}

TEST(SimulatedParticipant, QuestionsAndTargetsInQuickSuccessionAreNoticedInOrder) {
  ParticipantSkill skill = exact();
  skill.reaction_sd = 0.3;  // a later target may have a shorter or a longer delay
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    SimulatedParticipant participant(plain_hand(), skill, seed);
    Sponge far{.begin = 1.0};
    double now = 0.0;
    int answers = 0;
    for (std::uint64_t number = 1; number <= 20; ++number) {
      run(participant, far, now, 0.3, {.kind = Kind::kPain, .number = number},
          [&](const ParticipantAction& action, const auto&) { answers += action.answer ? 1 : 0; });
    }
    EXPECT_LE(answers, 20);
    EXPECT_GE(answers, 5);
  }
}

TEST(SimulatedParticipant, RecognisesObjectsWithItsProbability) {
  ParticipantSkill skill = exact();
  skill.recognition = 0.7;
  SimulatedParticipant participant(plain_hand(), skill, 12);
  int right = 0;
  double now = 0.0;
  for (std::uint64_t number = 1; number <= 2000; ++number) {
    const ParticipantTarget target{.kind = Kind::kObject, .number = number, .options = 4, .truth = 2};
    std::optional<int> answer;
    for (int i = 0; i < 100 && !answer; ++i) answer = participant.step(now += 0.05, target, {}).answer;
    ASSERT_TRUE(answer.has_value());
    ASSERT_GE(*answer, 0);
    ASSERT_LT(*answer, 4);
    right += *answer == 2 ? 1 : 0;
  }
  EXPECT_NEAR(right / 2000.0, 0.7, 0.04);
}

// The whole chain: pairs of the staircase, sponges that are pressed to the end position, answers by
// what was felt.
TEST(SimulatedParticipant, FeelsTheDifferenceOfSpongesThatItPresses) {
  ParticipantSkill skill = exact();
  skill.weber = 0.3;
  skill.lapses = 0.05;
  skill.movement_time = 0.2;
  SimulatedParticipant participant(plain_hand(), skill, 13);
  StiffnessDiscrimination staircase({}, 14);
  double now = 0.0;
  std::uint64_t number = 0;
  while (const auto pair = staircase.pair()) {
    for (int i = 0; i < 2; ++i) {
      Sponge sponge{.stiffness = pair->stiffness[idx(i)], .begin = 0.01};
      run(participant, sponge, now, 1.2,
          {.kind = Kind::kDepth,
           .number = ++number,
           .digits = kIndex,
           .depth = pair->end_position[idx(i)],
           .sponge = i},
          [](const auto&, const auto&) {});
      run(participant, sponge, now, 0.5, {.number = ++number}, [](const auto&, const auto&) {});
    }
    Sponge none{.begin = 1.0};
    std::optional<int> answer;
    run(participant, none, now, 0.5, {.kind = Kind::kSofter, .number = ++number},
        [&](const ParticipantAction& action, const auto&) {
          if (action.answer) answer = action.answer;
        });
    ASSERT_TRUE(answer.has_value());
    staircase.answer(*answer, pair->stiffness);
  }
  const StiffnessThreshold threshold = staircase.threshold();
  EXPECT_EQ(threshold.invalid, "");
  EXPECT_GT(threshold.right, 28);
  EXPECT_LT(threshold.low, 0.3);
  EXPECT_GT(threshold.high, 0.3);
}

TEST(SimulatedParticipant, SameSeedGivesTheSameActionsAndAnotherSeedOthers) {
  const auto angles = [](std::uint64_t seed) {
    SimulatedParticipant participant(plain_hand(), *find_participant_skill("moderate"), seed);
    Sponge sponge;
    double now = 0.0;
    std::vector<double> out;
    run(participant, sponge, now, 3.0, to_angle(1.2, 1), [&](const ParticipantAction& action, const auto&) {
      out.insert(out.end(), action.angle.begin(), action.angle.end());
    });
    return out;
  };
  EXPECT_EQ(angles(15), angles(15));
  EXPECT_NE(angles(15), angles(16));
}

TEST(SimulatedParticipant, WrongTimesForcesAndTargetsAreHarmless) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  SimulatedParticipant participant(plain_hand(), *find_participant_skill("severe"), 17);
  ParticipantTarget target{.kind = Kind::kForce, .number = 1, .digits = kIndex, .depth = nan};
  target.angle.fill(nan);
  target.force.fill(nan);
  target.sponge = 7;
  ParticipantFelt felt;
  felt.force.fill(nan);
  felt.stiffness.fill(-std::numeric_limits<double>::infinity());
  Random random(18);
  double now = 0.0;
  for (int i = 0; i < 5000; ++i) {
    target.kind = static_cast<Kind>(static_cast<int>(8.0 * random.uniform()));
    if (random.uniform() < 0.02) ++target.number;
    target.options = static_cast<int>(random.between(-3.0, 4.0));
    target.truth = static_cast<int>(random.between(-9.0, 9.0));
    felt.force[1] = random.uniform() < 0.3 ? 1e300 : nan;
    const double step = random.uniform();
    now += step < 0.1 ? -1.0 : step < 0.2 ? 50.0 : 0.005;
    const ParticipantAction action = participant.step(step < 0.05 ? nan : now, target, felt);
    for (int joint = 0; joint < kJoints; ++joint) {
      ASSERT_GE(action.angle[idx(joint)], plain_hand().least[idx(joint)]);
      ASSERT_LE(action.angle[idx(joint)], plain_hand().most[idx(joint)]);
    }
  }
}

TEST(ParticipantSkills, PresetsAreAllowedAndGetWorse) {
  for (const std::string_view name : participant_skill_names()) {
    SCOPED_TRACE(name);
    const auto skill = find_participant_skill(name);
    ASSERT_TRUE(skill.has_value());
    EXPECT_NO_THROW(check_skill(*skill));
  }
  EXPECT_FALSE(find_participant_skill("superhuman").has_value());
  const double mild = find_participant_skill("mild")->strength;
  const double moderate = find_participant_skill("moderate")->strength;
  const double severe = find_participant_skill("severe")->strength;
  EXPECT_GT(mild, moderate);
  EXPECT_GT(moderate, severe);
}

TEST(ParticipantSkills, BetweenTwoLiesWhatAPatientReachesWhileItRecovers) {
  const ParticipantSkill from{.reaction_time = 0.9, .tremor = 0.02, .weber = 0.8};
  const ParticipantSkill to{.reaction_time = 0.4, .tremor = 0.0, .weber = 0.2};
  EXPECT_NEAR(between_skills(from, to, 0.5).reaction_time, 0.6, 1e-12);
  EXPECT_NEAR(between_skills(from, to, 0.5).tremor, 0.01, 1e-12);
  EXPECT_NEAR(between_skills(from, to, 0.5).weber, 0.4, 1e-12);
  EXPECT_EQ(between_skills(from, to, 0.0).weber, 0.8);
}

TEST(ParticipantSkills, NumbersOutOfTheirRangeAreRefused) {
  EXPECT_THROW(check_skill({.reaction_time = 0.0}), std::invalid_argument);
  EXPECT_THROW(check_skill({.strength = std::numeric_limits<double>::quiet_NaN()}), std::invalid_argument);
  EXPECT_THROW(check_skill({.extension_deficit = 0.6, .flexion_deficit = 0.6}), std::invalid_argument);
  ParticipantHand hand = plain_hand();
  hand.least[3] = 2.0;
  EXPECT_THROW(SimulatedParticipant(hand, {}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace phalanx
