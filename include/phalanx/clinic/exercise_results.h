// SPDX-License-Identifier: Apache-2.0
// What is kept of an exercise: its results, or at least its dose, from its recording into the registry.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "phalanx/clinic/exercise_plan.h"
#include "phalanx/record/recorded_exercise.h"
#include "phalanx/registry/registry.h"

namespace phalanx {

/// Gets one message for people, without a line's end.
using ExerciseWords = std::function<void(const std::string& text)>;

/// Registry with the person who acts. Both outlive what they are given to.
struct ActingRegistry {
  Registry& registry;
  const Actor& actor;
};

/// Adds the results of recordings that a killed program has left without one, so that their dose counts, and
/// takes over what they have measured. A recording without an end is repaired first; the original stays beside
/// it. What cannot be read is named, and prevents nothing. It replays recordings, so that it may take minutes.
/// @param known   gets the results that were added, and the fields that were measured
/// @param folder  of the recordings
/// @param ends    asked before each recording; true: the program ends. Empty: never
/// @throws std::runtime_error if the program ends
void take_up_left_recordings(const ActingRegistry& acting, KnownPatient& known,
                             const std::filesystem::path& folder, const ExerciseWords& say,
                             const std::function<bool()>& ends = {});

/// Adds the results of a recording to the registry, and takes over what was measured.
/// @param record  of the patient
/// @throws RegistryError as Registry
void keep_results(const ActingRegistry& acting, const std::string& record,
                  const std::vector<RecordedExercise>& exercises, const std::filesystem::path& file,
                  const ExerciseWords& complain);

/// What an exercise has done as the station carried it out, without its recording.
struct UnscoredExercise {
  ExerciseStart start = {};
  ExerciseResult result = {};
  double began = 0.0;  ///< UTC [s]
};

/// Adds the dose of an exercise whose recording gives no result. `patient rebuild` replaces it if the recording is mended.
/// @returns false if it has no trial, or the registry refuses; complain() has then stated why
/// @throws RegistryError kBusy as Registry: try again later, or leave the recording to the next exercise
bool keep_dose(const ActingRegistry& acting, const std::string& record, const UnscoredExercise& done,
               const std::filesystem::path& file, const ExerciseWords& complain);

}  // namespace phalanx
