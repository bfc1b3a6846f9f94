// SPDX-License-Identifier: Apache-2.0
#include "patient/rebuilt_measurements.h"

#include <algorithm>
#include <tuple>

#include "phalanx/clinic/exercise_patient.h"

namespace phalanx {

RebuiltMeasurements::RebuiltMeasurements(Registry& registry, const Actor& actor)
    : registry_(registry), actor_(actor) {
  try {
    for (const Patient& patient : registry.patients(actor))
      known_.emplace(patient.record, registry.results(actor, patient.record));
  } catch (
      const RegistryError&) {  // a damaged one: rebuild() states it, and what is not known changes nothing
  }
}

std::vector<ResultRow> RebuiltMeasurements::read(const std::filesystem::path& recording,
                                                 const FindRecordingKey& keys) {
  const std::string name = recording.filename().string();
  std::vector<ResultRow> rows;
  for (RecordedExercise& exercise : recorded_exercises(recording, keys)) {
    rows.push_back(result_row(exercise, name));
    if (exercise.start.exercise.kind == ExerciseKind::kAssessment)
      read_.emplace_back(name, std::move(exercise));
  }
  return rows;
}

std::vector<std::string> RebuiltMeasurements::take_over() {
  std::sort(read_.begin(), read_.end(), [](const auto& a, const auto& b) {
    return std::tie(a.second.begin_utc, a.first, a.second.number) <
           std::tie(b.second.begin_utc, b.first, b.second.number);
  });
  std::vector<std::string> changed;
  for (const Patient& before : registry_.patients(actor_)) {
    const auto known = known_.find(before.record);
    Patient patient = before;
    if (known == known_.end() || !take_over_of(patient, known->second)) continue;
    registry_.edit_patient(actor_, patient, patient_revision(before));
    changed.push_back(patient.code);
  }
  return changed;
}

bool RebuiltMeasurements::take_over_of(Patient& patient, std::vector<ResultRow> known) const {
  const std::vector<ResultRow> rows = registry_.results(actor_, patient.record);
  bool takes = false;
  for (const auto& [name, exercise] : read_) {
    const bool has_row = std::any_of(rows.begin(), rows.end(), [&](const ResultRow& row) {
      return row.recording == name && row.number == exercise.number;
    });
    if (!has_row || !take_late(patient, exercise, name, known)) continue;
    takes = true;
    known.push_back(result_row(exercise, name));  // has measured what the next one may replace
  }
  return takes;
}

}  // namespace phalanx
