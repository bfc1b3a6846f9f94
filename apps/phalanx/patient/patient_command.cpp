// SPDX-License-Identifier: Apache-2.0
// phalanx patient: the registry of patients. Its commands are in patient_*_commands.cpp; list and
// show are here.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "patient/patient_commands.h"
#include "patient/patient_fields.h"
#include "patient/patient_text.h"
#include "phalanx/patients/bound_files.h"
#include "phalanx/patients/trainings.h"

namespace phalanx {
namespace {

struct PatientViewOptions : PatientOptions {
  bool json = false;
};

/// Words about what must be seen before a session.
std::string attention_text(const Patient& patient, const std::string& today) {
  std::vector<std::string> words;
  if (!patient.contraindications.empty())
    words.push_back(fmt::format("{} contraindications", patient.contraindications.size()));
  if (patient.entry && !patient.entry->suitable) words.emplace_back("not suitable on this device");
  if (!patient.consent) words.emplace_back("no consent");
  if (calibration_validity(patient, today).starts_with("expired")) words.emplace_back("calibration expired");
  if (!patient.warnings.empty()) words.push_back(fmt::format("{} warnings", patient.warnings.size()));
  return fmt::format("{}", fmt::join(words, ", "));
}

int list_patients(const PatientViewOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  const std::vector<Patient> patients = opened.registry.patients(opened.actor);
  const std::vector<std::string> locked = opened.registry.patients_without_key(opened.actor);
  if (o.json) {
    std::vector<std::string> objects;
    for (const Patient& patient : patients) objects.push_back(patient_json(patient));
    fmt::print("[{}]\n", fmt::join(objects, ",\n"));
  } else if (patients.empty()) {
    fmt::print("no patients in {}\n", opened.registry.folder().string());
  } else {
    const std::string today = utc_today();
    fmt::print("{:<16} {:<6} {:<10} {:<22} {}\n", "code", "hand", "symbol", "calibration", "attention");
    for (const Patient& patient : patients)
      fmt::print("{:<16} {:<6} {:<10} {:<22} {}\n", patient.code, side_name(patient.side), patient.symbol,
                 calibration_validity(patient, today), attention_text(patient, today));
  }
  for (const std::string& record : opened.registry.damaged_patients(opened.actor))
    fmt::print(stderr, "the record {} is damaged; `phalanx patient restore` brings it back from a backup\n",
               record);
  if (!locked.empty())
    fmt::print(stderr, "{} further patients cannot be read: their keys are not in {}\n", locked.size(),
               opened.registry.keys().file().string());
  return kDone;
}

int show_patient(const PatientViewOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  const Patient patient = opened.registry.patient(opened.actor, o.code);
  if (o.json) {
    fmt::print("{}\n", patient_json(patient));
    return kDone;
  }
  fmt::print("{}", patient_text(patient, utc_today()));
  const std::vector<ResultRow> results = opened.registry.results(opened.actor, patient.record);
  fmt::print("{}", entry_checks_text(patient, results));
  for (const TrainingReport& report : training_reports(patient, results))
    if (report.needs_attention())
      fmt::print("  {:<18} {}: {}\n", "attention:", printable(report.exercise),
                 printable(report.success.text));
  const std::vector<EnteredTest> tests = opened.registry.tests(opened.actor, patient.record);
  const std::vector<PatientNote> notes = opened.registry.notes(opened.actor, patient.record);
  fmt::print("{} results, {} entered tests, {} notes\n", results.size(), tests.size(), notes.size());
  for (const EnteredTest& test : tests) fmt::print("  {}\n", test_text(test));
  for (const PatientNote& note : notes)
    fmt::print("  {}  {}: {}\n", utc_day(note.date), printable(note.account), printable(note.text));
  return kDone;
}

/// Adds list and show.
void add_patient_view_commands(CLI::App& patient, Job& job) {
  auto listed = std::make_shared<PatientViewOptions>();
  CLI::App* list = add_patient_job(patient, "list", "List the patients by code", listed, job, list_patients);
  list->add_flag("--json", listed->json, "all fields, as one JSON array");
  auto shown = std::make_shared<PatientViewOptions>();
  CLI::App* show =
      add_patient_job(patient, "show", "Print a patient's fields, tests and notes", shown, job, show_patient);
  add_code(*show, *shown);
  show->add_flag("--json", shown->json, "the fields alone, as one JSON object");
}

}  // namespace

void add_patient_command(CLI::App& app, Job& job) {
  CLI::App* patient = app.add_subcommand(
      "patient", "Patients by code: limits, prescription, results, tests, deletion, backup");
  patient->require_subcommand(1);
  add_patient_edit_commands(*patient, job);
  add_patient_view_commands(*patient, job);
  add_patient_result_commands(*patient, job);
  add_patient_report_commands(*patient, job);
  add_patient_store_commands(*patient, job);
  add_patient_control_commands(*patient, job);
  patient->footer(
      "A patient is a code such as P07, never a name or a date of birth: the clinic keeps that list.\n"
      "What is stored where, who may see it, and what deletion reaches: docs/patients.md.\n"
      "`phalanx patient COMMAND --help` explains each.");
}

}  // namespace phalanx
