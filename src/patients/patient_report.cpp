// SPDX-License-Identifier: Apache-2.0
#include "phalanx/patients/patient_report.h"

#include <algorithm>

#include "phalanx/patients/trainings.h"
#include "phalanx/scene/exercise_file.h"
#include "phalanx/scene/scene.h"

namespace phalanx {
namespace {

std::vector<ReportedExercise> reported_exercises(const Patient& patient, std::span<const ResultRow> results) {
  std::vector<ReportedExercise> all;
  for (const ExerciseInfo& info : list_exercises())
    if (info.readable)
      all.push_back({.name = info.name, .title = info.title, .title_de = info.exercise.title_de});
  for (const TrainingReport& training : training_reports(patient, results)) {
    auto found = std::find_if(all.begin(), all.end(),
                              [&](const ReportedExercise& each) { return each.name == training.exercise; });
    if (found == all.end()) found = all.insert(all.end(), ReportedExercise{.name = training.exercise});
    found->target_success = training.target_success;
    found->success = training.success;
    found->sessions = training.sessions;
    found->needs_attention = training.needs_attention();
  }
  return all;
}

}  // namespace

ReportInput read_report_input(Registry& registry, const Actor& actor, const std::string& code_or_record,
                              const std::string& day, const std::string& today) {
  check_report_day(day);
  ReportInput input;
  input.patient = registry.patient(actor, code_or_record);
  const std::string& record = input.patient.record;
  input.results = registry.results(actor, record);
  input.tests = registry.tests(actor, record);
  input.notes = registry.notes(actor, record);
  input.trends = make_trends(input.results, input.tests);
  try {
    input.exercises = reported_exercises(input.patient, input.results);
  } catch (const SceneError&) {  // an installation without its assets: the report has all else
  }
  input.day = day;
  input.today = today;
  input.version = PHALANX_VERSION;
  return input;
}

}  // namespace phalanx
