// SPDX-License-Identifier: Apache-2.0
#include "phalanx/clinic/exercise_results.h"

#include <fmt/format.h>

#include <stdexcept>
#include <system_error>

#include "phalanx/clinic/exercise_patient.h"
#include "phalanx/core/error_text.h"
#include "phalanx/exercise/reasons.h"
#include "phalanx/record/recordings.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

/// Adds the exercises of one left recording. @returns true if a result was added
bool take_up(const ActingRegistry& acting, KnownPatient& known, const fs::path& file,
             const FindRecordingKey& keys, const ExerciseWords& say) {
  const RecordingSummary summary = summarise_recording(file, keys);
  if (summary.written) return false;  // by a program that lives
  if (!summary.has_end) {
    say(fmt::format("{} has no end: its program was killed. It is repaired and read for the dose",
                    file.string()));
    static_cast<void>(repair_recording(file, keys));
  }
  const std::string name = file.filename().string();
  bool added = false;
  for (const RecordedExercise& exercise : recorded_exercises(file, keys)) {
    if (exercise.start.record != known.patient.record) continue;
    const ResultRow row = result_row(exercise, name);
    acting.registry.add_result(acting.actor, known.patient.record, row);
    if (takes_late(known.patient, exercise, name, known.results))
      update_patient(acting.registry, acting.actor, known.patient.record,
                     [&](Patient& patient) { return take_late(patient, exercise, name, known.results); });
    known.results.push_back(row);  // has measured what the next one may replace
    say(fmt::format("{}: {} trials of {} are added to the dose", file.string(), row.repetitions,
                    row.exercise));
    added = true;
  }
  return added;
}

}  // namespace

void take_up_left_recordings(const ActingRegistry& acting, KnownPatient& known, const fs::path& folder,
                             const ExerciseWords& say, const std::function<bool()>& ends) {
  Registry& registry = acting.registry;
  FindRecordingKey keys;
  bool added = false;
  for (const std::string& name : registry.recordings_without_result(acting.actor, known.patient.record)) {
    if (ends && ends()) throw std::runtime_error("the program ends; no exercise begins");
    const fs::path file = folder / name;
    std::error_code ignored;
    if (!fs::exists(file, ignored)) continue;
    if (!keys) keys = registry.recording_keys(acting.actor);
    try {
      added = take_up(acting, known, file, keys, say) || added;
    } catch (const std::exception& error) {
      say(fmt::format("  warning: the dose of {} is not known: {}", file.string(), error_text(error)));
    }
  }
  if (!added) return;
  known.results = registry.results(acting.actor, known.patient.record);
  known.patient = registry.patient(acting.actor, known.patient.record);
}

void keep_results(const ActingRegistry& acting, const std::string& record,
                  const std::vector<RecordedExercise>& exercises, const fs::path& file,
                  const ExerciseWords& complain) {
  for (const RecordedExercise& exercise : exercises) {
    // Before the row: with it, `patient rebuild` takes nothing over again. The patient may have changed while
    // the exercise ran, and may change now.
    try {
      update_patient(acting.registry, acting.actor, record,
                     [&exercise](Patient& patient) { return take_measured(patient, exercise); });
    } catch (const RegistryError& error) {
      if (error.fault() != RegistryFault::kConflict) throw;
      complain(fmt::format("what {} has measured is not taken over: {}; its scores are kept",
                           exercise.start.exercise.name, error.what()));
    }
    acting.registry.add_result(acting.actor, record, result_row(exercise, file.filename().string()));
  }
}

bool keep_dose(const ActingRegistry& acting, const std::string& record, const UnscoredExercise& done,
               const fs::path& file, const ExerciseWords& complain) {
  if (done.result.repetitions == 0) return false;
  try {
    acting.registry.add_result(acting.actor, record,
                               dose_row(done.start, done.result, file.filename().string(), done.began,
                                        reason_text<Reason::kNoResultFromRecording>()));
    return true;
  } catch (const std::exception& error) {
    const auto* refused = dynamic_cast<const RegistryError*>(&error);
    if (refused != nullptr && refused->fault() == RegistryFault::kBusy) throw;
    complain(fmt::format("the dose of this exercise is not in the registry: {}", error_text(error)));
    return false;
  }
}

}  // namespace phalanx
