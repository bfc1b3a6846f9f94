// SPDX-License-Identifier: Apache-2.0
// What is read and checked before an exercise of a patient begins on a station, and what is kept after it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "phalanx/clinic/exercise_host.h"
#include "phalanx/clinic/exercise_plan.h"
#include "phalanx/clinic/exercise_results.h"
#include "phalanx/record/recording_keys.h"
#include "phalanx/registry/registry.h"
#include "phalanx/station/session.h"

namespace phalanx {

/// Exercise that may begin.
struct PreparedExercise {
  Actor actor = {};
  KnownPatient known = {};
  ExercisePlan plan = {};
  RecordingEncryption key = {};  ///< of the patient's recordings

  /// @returns finder of that key alone
  [[nodiscard]] FindRecordingKey keys() const;
  /// @returns the station of the exercise, which begins stopped
  /// @param source     of the hand's motion; none: as before
  /// @param recording  RunRecorder::next_recording()
  [[nodiscard]] StationOrder station(std::optional<HandSource> source, std::uint64_t recording) const;
};

/// Where an exercise is to take place.
struct ExercisePlace {
  PlannedStation station = {};
  std::filesystem::path recordings = {};  ///< folder
  std::string today = {};                 ///< UTC, "2026-05-04"
};

/// Replaces a patient's code by "the patient", in a text for a log or for pages without a session.
[[nodiscard]] std::string without_code(const std::string& text, const std::string& code);

/// Reads the patient, takes up left recordings, and plans the exercise. It reads the registry and may replay recordings.
/// @param say   gets words without the patient's code
/// @param ends  true: the program ends, and no further recording is replayed
/// @throws as ExerciseHost::begin(), with the remedies of the page
[[nodiscard]] PreparedExercise prepare_exercise(Registry& registry, const Actor& actor,
                                                const ExerciseOrder& order, ExercisePlace place,
                                                const ExerciseWords& say, const std::function<bool()>& ends);

/// What became of an exercise.
struct KeptExercise {
  std::optional<ExerciseResult> result = {};
  std::string trouble = {};  ///< why there is no result, or what is missing of it; empty: nothing
};

/// Recording of an exercise whose steps are over.
struct EndedRecording {
  std::filesystem::path file = {};
  bool whole = false;  ///< false: the disk has refused its end
};

/// Makes the result of an exercise from its recording, and keeps it in the registry, or at least its dose. It replays the
/// recording: not for a thread that must return soon.
/// @param done  as the station carried it out; none: it did not begin
/// @param tries_again  asked when another program holds the registry (RegistryFault::kBusy), with the words of that; true:
/// it is tried again. Empty: never
[[nodiscard]] KeptExercise keep_exercise(Registry& registry, const PreparedExercise& prepared,
                                         const EndedRecording& recording,
                                         const std::optional<UnscoredExercise>& done,
                                         const std::function<bool(const std::string& why)>& tries_again);

}  // namespace phalanx
