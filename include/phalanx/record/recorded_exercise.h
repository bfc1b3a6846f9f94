// SPDX-License-Identifier: Apache-2.0
// The exercises of a recording, carried out again from its steps. docs/exercises.md ("Recorded exercises")
// has the events.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "phalanx/exercise/exercise.h"
#include "phalanx/exercise/exercise_run.h"
#include "phalanx/record/recording_keys.h"

namespace phalanx {

/// What an exercise begins with. It is recorded as the event "exercise_begin", so that a replay carries
/// out the same.
struct ExerciseStart {
  ExerciseDescription exercise;
  PersonLimits person;
  std::uint64_t seed = 0;
  /// Random id of the patient's records, 32 hexadecimal digits; empty: no patient. Never a code.
  std::string record = {};
  bool simulated = false;  ///< a simulated participant, whose results never join those of a person
  /// Under which results are compared: device, serial, calibration, contact_mode, stabiliser, rendering, scene, and of an
  /// assessment protocol. `side` is that of the hand: "left" or "right".
  std::map<std::string, std::string> conditions = {};
};

/// One exercise of a recording.
struct RecordedExercise {
  int number = 0;  ///< in its recording, from 1
  ExerciseStart start;
  double begin_utc = 0.0;  ///< of its first step [s since 1970]; 0: none is in the file
  ExerciseResult result;   ///< as the replay carried it out
  std::string text;        ///< exercise_result_text() of it
  std::string recorded;  ///< the same as the recording has it; empty: the recording ends before the exercise
  std::string recorded_by;  ///< version and commit of the program that recorded it
  /// Why nothing of it may be scored, in words: steps are missing, or the recording ends before the exercise.
  /// Empty: it may.
  std::string invalid;
  /// How `text` differs from `recorded`, in words; empty: they have the same bytes, or there is
  /// no recorded one.
  std::string difference;
  /// The result differs because another version recorded it, or a machine with other mathematical functions.
  /// All steps are there; those of the same version are equal within the replay's tolerance. The recorded
  /// result then holds.
  bool other_program = false;

  /// @returns true if the result is that of the recording, byte for byte, and may be scored
  [[nodiscard]] bool proven() const noexcept { return invalid.empty() && difference.empty(); }
};

/// Carries out all exercises of a recording again: a replay makes each step, HandObserver observes it, and
/// ExerciseRun gets the recorded inputs at the steps at which they took effect.
/// @param keys         of encrypted recordings; may be empty
/// @param on_progress  as replay()
/// @returns the exercises in the order of their beginnings; empty: the recording has none
/// @throws std::runtime_error as replay(), or if an event of an exercise cannot be read; what() names the
/// place and the remedy
[[nodiscard]] std::vector<RecordedExercise> recorded_exercises(
    const std::filesystem::path& file, const FindRecordingKey& keys = {},
    const std::function<void(double)>& on_progress = {});

/// Reads exercise_result_text() back.
/// @param exercise  whose kind and measure the result has
/// @throws std::runtime_error naming what is missing
[[nodiscard]] ExerciseResult read_exercise_result(const std::string& text,
                                                  const ExerciseDescription& exercise);

/// @returns the exercise as a recording without its result has it: every score invalid with the reason,
/// no trial counted
[[nodiscard]] ExerciseResult without_scores(ExerciseResult result, const std::string& why);

}  // namespace phalanx
