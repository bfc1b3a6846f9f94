// SPDX-License-Identifier: Apache-2.0
#include "patient/trainings.h"

#include <optional>
#include <set>

#include "exercise/exercise_patient.h"
#include "phalanx/patients/prescribed_line.h"
#include "phalanx/scene/exercise_file.h"

namespace phalanx {
namespace {

/// @returns the share of success that a training of this patient steers to
double target_success_of(const Patient& patient, const std::string& exercise,
                         const std::vector<ExerciseInfo>& known) {
  for (const PrescribedExercise& line : patient.prescription) {
    if (line.exercise != exercise) continue;
    const auto stated = parse_prescription(prescribed_exercise_line(line)).target_success;
    if (stated) return *stated;
  }
  for (const ExerciseInfo& info : known)
    if (info.name == exercise && info.readable && info.exercise.difficulty)
      return info.exercise.difficulty->target_success;
  return Difficulty{}.target_success;
}

}  // namespace

std::vector<TrainingReport> training_reports(const Patient& patient, std::span<const ResultRow> results) {
  std::set<std::string> trainings;
  for (const ResultRow& row : results)
    if (!row.assessment) trainings.insert(row.exercise);
  if (trainings.empty()) return {};
  const std::vector<ExerciseInfo> known = list_exercises();
  std::vector<TrainingReport> reports;
  for (const std::string& exercise : trainings)
    reports.push_back({.exercise = exercise,
                       .success = success_report(training_history(results, exercise),
                                                 target_success_of(patient, exercise, known))});
  return reports;
}

}  // namespace phalanx
