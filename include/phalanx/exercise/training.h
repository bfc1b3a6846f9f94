// SPDX-License-Identifier: Apache-2.0
// What a training does from session to session: its prescription, its difficulty, and the
// report of its success.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/exercise/exercise.h"

namespace phalanx {

/// What a therapist prescribes for one exercise: its name, and what differs from its file. A prescription can
/// make an exercise shorter, easier or more careful; it can raise no dose and no limit.
struct Prescription {
  std::string exercise = {};
  std::optional<int> trials = {};             ///< training only
  std::optional<double> target_success = {};  ///< replaces Difficulty::target_success; training only [-]
  std::optional<double> difficulty =
      {};  ///< of the next session, instead of next_difficulty(); training only [-]
  std::optional<int> pain_limit = {};        ///< replaces RatingLimits::pain if it is lower
  std::optional<int> fatigue_limit = {};     ///< replaces RatingLimits::fatigue if it is lower
  std::optional<int> most_repetitions = {};  ///< replaces DoseCap::repetitions if it is lower
  std::optional<double> most_minutes = {};   ///< replaces DoseCap::minutes if it is lower [min]
  [[nodiscard]] bool operator==(const Prescription&) const = default;
};

/// Reads a prescription from one line: "press_hold trials=12 target_success=0.6 pain_limit=3". Keys are
/// the fields' names.
/// @throws ExerciseError naming the line, the key, the value and the remedy
[[nodiscard]] Prescription parse_prescription(std::string_view line);
/// Writes a prescription as parse_prescription() reads it.
[[nodiscard]] std::string prescription_text(const Prescription& prescription);

/// @returns the exercise with the prescription's overrides. `difficulty` becomes Difficulty::start.
/// @throws ExerciseError if the names differ, if a value is out of range, if it would raise a rating limit or
/// a dose, or if a training's key is prescribed for an assessment, whose conditions are fixed
[[nodiscard]] ExerciseDescription prescribed(ExerciseDescription exercise, const Prescription& prescription);

/// One past session of a training, as its result has it, or its part at one difficulty.
struct TrainingSession {
  double difficulty = 0.0;  ///< 0 .. 1 [-]
  int successes = 0;
  int counted = 0;         ///< valid trials; 0: the session says nothing
  bool continues = false;  ///< part of the same session as the entry before it
};

/// @returns the difficulty of the next session, 0 .. 1: the one at which a Bayesian filter of the
/// person's ability expects Difficulty::target_success. docs/exercises.md has the model. Without
/// a session, Difficulty::start.
[[nodiscard]] double next_difficulty(std::span<const TrainingSession> history, const Difficulty& difficulty);

/// Sessions after which a training's success is judged, and how many of the last ones are judged.
inline constexpr int kSessionsToJudge = 10;
inline constexpr int kJudgedSessions = 3;
/// Largest distance from the target success that is in range [-].
inline constexpr double kSuccessMargin = 0.1;

/// Verdict on the success of a training's last sessions.
enum class SuccessVerdict {
  kTooFewSessions,  ///< fewer than kSessionsToJudge, or a judged one has no valid trial
  kInRange,         ///< within kSuccessMargin of the target
  kNotShown,        ///< the observed share is in range but too close to its edge
  kOutOfRange,      ///< the observed share is out of range
};

/// Success of a training's last kJudgedSessions sessions.
struct SuccessReport {
  SuccessVerdict verdict = SuccessVerdict::kTooFewSessions;
  int successes = 0;
  int counted = 0;
  double share = 0.0;  ///< successes / counted; 0 without a counted trial [-]
  double low = 0.0;    ///< exact 95 % interval of Clopper and Pearson [-]
  double high = 1.0;
  /// For people: "in range: ..." or, for every other verdict, the report: "out of range after
  /// 10 sessions: ..."
  std::string text = {};
  /// @returns true if a therapist must be told
  [[nodiscard]] bool reported() const noexcept { return verdict != SuccessVerdict::kInRange; }
};

/// Judges a training by its observed successes only.
/// @param target_success  Difficulty::target_success
[[nodiscard]] SuccessReport success_report(std::span<const TrainingSession> history, double target_success);

}  // namespace phalanx
