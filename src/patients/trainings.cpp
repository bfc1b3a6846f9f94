// SPDX-License-Identifier: Apache-2.0
#include "phalanx/patients/trainings.h"

#include <optional>
#include <set>

#include "phalanx/patients/prescribed_line.h"
#include "phalanx/registry/result_detail.h"
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

std::vector<TrainingSession> training_history(std::span<const ResultRow> results,
                                              const std::string& exercise) {
  std::vector<TrainingSession> history;
  for (const ResultRow& row : results)
    if (row.exercise == exercise && !row.assessment && row.valid)
      history.push_back(
          {.difficulty = row.difficulty, .successes = row.successes, .counted = counted_trials(row)});
  return history;
}

std::vector<TrainingReport> training_reports(const Patient& patient, std::span<const ResultRow> results) {
  std::set<std::string> trainings;
  for (const ResultRow& row : results)
    if (!row.assessment) trainings.insert(row.exercise);
  if (trainings.empty()) return {};
  const std::vector<ExerciseInfo> known = list_exercises();
  std::vector<TrainingReport> reports;
  for (const std::string& exercise : trainings) {
    const double target = target_success_of(patient, exercise, known);
    const std::vector<TrainingSession> history = training_history(results, exercise);
    reports.push_back({.exercise = exercise,
                       .target_success = target,
                       .success = success_report(history, target),
                       .sessions = static_cast<int>(history.size())});
  }
  return reports;
}

}  // namespace phalanx
