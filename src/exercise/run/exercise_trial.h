// SPDX-License-Identifier: Apache-2.0
// One trial of an exercise without answers: its plan, what the participant should do at each
// time, and its scores.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "phalanx/exercise/exercise.h"
#include "phalanx/exercise/exercise_run.h"
#include "phalanx/exercise/observation.h"
#include "phalanx/exercise/score.h"

namespace phalanx {

/// Time at the begin of a trial of kForceTracking with a constant target, which is not scored [s].
inline constexpr double kTrackingLeadIn = 2.0;
/// Amplitude of its moving target over the target's centre [-].
inline constexpr double kTrackingSwing = 0.5;
/// Time at the begin of a trial of kPressAndHold in which the force rises [s].
inline constexpr double kPressSettle = 1.0;
/// Time at the begin of a trial of kSmoothness with the digit extended [s].
inline constexpr double kMoveLeadIn = 1.0;
/// Largest target of a digit over the station's fingertip force: above it, a target could not be reached.
inline constexpr double kReachableForce = 0.8;

/// A trial that is to be done, with all numbers resolved for the person and the difficulty.
struct TrialPlan {
  int number = 1;       ///< from 1
  int digit = -1;       ///< instructed digit of a measure with digits_in_turn(); -1: all of the exercise
  double target = 0.0;  ///< share [-]
  double tolerance = 0.1;
  double rate_hz = 0.2;
  std::optional<double> difficulty = {};
  std::optional<SuccessRule> success = {};
};

/// Resolves a trial. Digits that come in turn are the instructed ones that are felt.
/// @param index  from 0, of all trials of the exercise
[[nodiscard]] TrialPlan plan_trial(const ExerciseDescription& exercise, const PersonLimits& person, int index,
                                   double difficulty);
/// @returns the number of trials of an exercise without answers
[[nodiscard]] int planned_trials(const ExerciseDescription& exercise, const PersonLimits& person);

/// @returns digits that a trial instructs; with the thumb for kPinch and kOpposition
[[nodiscard]] std::array<bool, kDigits> trial_digits(const ExerciseDescription& exercise,
                                                     const TrialPlan& plan);

/// Calculates each digit's target force; 0 for others. It is a share of the own force, and at most
/// kReachableForce of the person's cap [N].
[[nodiscard]] std::array<double, kDigits> target_forces(const ExerciseDescription& exercise,
                                                        const PersonLimits& person, const TrialPlan& plan);

/// @returns what the participant should do at time t since the trial's first observation
[[nodiscard]] ExerciseTarget trial_target(const ExerciseDescription& exercise, const PersonLimits& person,
                                          const TrialPlan& plan, double t);

/// Scores a trial. Names are always the same ones; digits_in_turn() adds the digit to names that do
/// not have it.
[[nodiscard]] std::vector<Score> trial_scores(const ExerciseDescription& exercise, const PersonLimits& person,
                                              const TrialPlan& plan, std::span<const Observation> steps);

/// @returns the scores of digits that do not come in turn because they follow another one: "not measured"
[[nodiscard]] std::vector<Score> scores_of_followers(const ExerciseDescription& exercise,
                                                     const PersonLimits& person);

/// @returns the score that a rule names: by its name, or without the digit that a measure with
/// digits_in_turn() adds ("opposition_mm" for opposition_ring_mm); null: no score has it
[[nodiscard]] const Score* scored_by(const SuccessRule& rule, const TrialPlan& plan,
                                     const std::vector<Score>& scores);

/// States the trial's conditions in its result: condition, target, tolerance and rate.
void state_conditions(const ExerciseDescription& exercise, const PersonLimits& person, const TrialPlan& plan,
                      ExerciseTrial& trial);

/// Calculates active flexion and release of one digit: entry_flexion_<digit>_deg, entry_release_<digit>_deg.
[[nodiscard]] std::vector<Score> entry_scores(std::span<const Observation> steps, int digit,
                                              bool calibration_independent);
/// Judges the entry check by the scores of the whole exercise.
[[nodiscard]] EntryVerdict entry_verdict(const ExerciseDescription& exercise, const PersonLimits& person,
                                         const std::vector<Score>& scores);

/// @returns the scores of a whole exercise: by name the mean of the valid trials, in the order of
/// the first trial
[[nodiscard]] std::vector<Score> mean_scores(const std::vector<ExerciseTrial>& trials);

}  // namespace phalanx
