// SPDX-License-Identifier: Apache-2.0
// The hidden stimuli of an exercise with answers: pairs of sponges, or objects in the hand.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/exercise/discrimination.h"
#include "phalanx/exercise/exercise.h"
#include "phalanx/exercise/exercise_run.h"
#include "phalanx/exercise/identification.h"
#include "phalanx/exercise/sent_stiffness.h"

namespace phalanx {

/// Stimuli of one run of kFeelAndFind or kObjectInHand, in their order, and what was answered.
class ExerciseStimuli {
 public:
  /// @throws ExerciseError if the person's stable zone is too narrow for a useful pair
  ExerciseStimuli(const ExerciseDescription& exercise, const PersonLimits& person, std::uint64_t seed);

  [[nodiscard]] bool finished() const;
  /// @returns how many stimuli are felt before an answer: two sponges, or one object
  [[nodiscard]] int parts() const noexcept { return discrimination_ ? 2 : 1; }
  /// @returns the commanded stiffness of a part of the present trial [N/m]; none for objects
  [[nodiscard]] std::optional<double> stiffness(int part) const;
  /// @returns the depth at which the participant stops pressing a part [m]; 0 for objects
  [[nodiscard]] double depth(int part) const;
  /// @returns the object of the present trial; none for sponges
  [[nodiscard]] std::optional<int> object() const;
  /// @returns the answers that a participant can give
  [[nodiscard]] const std::vector<std::string>& choices() const noexcept { return choices_; }
  /// @returns number of the present trial, from 1, and of trials that are planned
  [[nodiscard]] int number() const noexcept { return number_; }
  [[nodiscard]] int planned() const noexcept { return planned_; }

  /// Begins a part of the present trial.
  void begin(int part);
  /// Takes an observation of the part. @returns true if the end position was reached
  [[nodiscard]] bool add(const Observation& observation);
  /// Takes the answer, from 1, and goes on to the next trial. @returns the trial's condition,
  /// scores and validity
  [[nodiscard]] ExerciseTrial answer(int choice);
  /// Goes on to the next trial without an answer. @returns what was sent up to now, and the reason
  [[nodiscard]] ExerciseTrial skip(const std::string& reason);
  /// @returns the scores of all answers
  [[nodiscard]] std::vector<Score> scores() const;

 private:
  [[nodiscard]] ExerciseTrial answer_pair(int choice);
  /// @returns commanded and sent stiffness of both sponges
  [[nodiscard]] std::vector<Score> pair_scores() const;
  /// @returns mean sent stiffness of both sponges; NaN: not known [N/m]
  [[nodiscard]] std::array<double, 2> sent_means() const;
  [[nodiscard]] ExerciseTrial answer_object(int choice);

  std::array<bool, kDigits> digits_;
  std::vector<std::string> choices_;
  std::optional<StiffnessDiscrimination> discrimination_;
  std::optional<Identification> identification_;
  std::array<std::optional<SentStiffness>, 2> sent_;
  int part_ = 0;
  int number_ = 1;
  int planned_ = 0;
};

}  // namespace phalanx
