// SPDX-License-Identifier: Apache-2.0
// phalanx patient add | edit | delete.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "patient/patient_commands.h"
#include "patient/patient_fields.h"
#include "patient/patient_text.h"

namespace phalanx {
namespace {

struct PatientEditOptions : PatientOptions {
  PatientFields fields = {};
  std::string new_code = {};
};

struct PatientDeleteOptions : PatientOptions {
  std::string confirmed = {};  ///< the code again
};

void print_changes(const Patient& patient, const std::vector<ResultRow>& results,
                   const std::vector<std::string>& said) {
  for (const std::string& line : said) fmt::print(stderr, "{}\n", printable(line));
  fmt::print("{}{}", patient_text(patient, utc_today()), entry_checks_text(patient, results));
}

int add_new_patient(const PatientEditOptions& o) {
  Patient patient;
  patient.code = o.code;
  const std::vector<std::string> said = change_patient(patient, o.fields, utc_today());
  Patient checked = patient;  // before a registry is made
  if (checked.symbol.empty()) checked.symbol = patient_symbols().front();
  check_patient_fields(checked);
  OpenedRegistry opened = open_registry(o.registry, MissingRegistry::kMade);
  print_changes(opened.registry.add_patient(opened.actor, patient), {}, said);
  return kDone;
}

int edit_known_patient(const PatientEditOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  Patient patient = opened.registry.patient(opened.actor, o.code);
  const std::string base = patient_revision(patient);  // another program may change the patient meanwhile
  if (!o.new_code.empty()) patient.code = o.new_code;
  const std::vector<std::string> said = change_patient(patient, o.fields, utc_today());
  patient = opened.registry.edit_patient(opened.actor, patient, base);
  print_changes(patient, opened.registry.results(opened.actor, patient.record), said);
  return kDone;
}

/// @param code  of a patient, or a damaged record
/// @returns the patient; of a damaged record its record id alone, also as the code
Patient patient_to_delete(OpenedRegistry& opened, const std::string& code) {
  const std::vector<std::string> damaged = opened.registry.damaged_patients(opened.actor);
  if (std::find(damaged.begin(), damaged.end(), code) == damaged.end())
    return opened.registry.patient(opened.actor, code);
  Patient record;
  record.record = code;
  record.code = code;
  return record;
}

/// Asks for the code again, unless --confirm has it.
void confirm_deletion(const PatientDeleteOptions& o, const Patient& patient) {
  std::string confirmed = o.confirmed;
  if (confirmed.empty()) {
    if (::isatty(STDIN_FILENO) != 1)
      throw std::invalid_argument(fmt::format(
          "{} and all its results would be gone for good; type the same with --confirm {}", o.code, o.code));
    const std::string who =
        patient.code == patient.record
            ? fmt::format("the damaged record {}", patient.record)
            : fmt::format("{} ({} hand, {})", patient.code, side_name(patient.side), patient.symbol);
    fmt::print(stderr, "{} and all its results will be gone for good. Type the code again: ", who);
    std::getline(std::cin, confirmed);
  }
  if (confirmed != patient.code)
    throw std::invalid_argument(
        fmt::format("'{}' is not the code {}; nothing was deleted", printable(confirmed), patient.code));
}

/// States what the deletion cannot reach.
void print_remains(const Patient& patient, const DeleteReport& report) {
  for (const std::string& file : {patient.calibration, patient.range})
    if (!file.empty())
      fmt::print("  remains: {} (it may state the code; remove it yourself)\n", printable(file));
  for (const std::filesystem::path& file : report.exports_missing)
    fmt::print("  not found: the export {}; remove its copies yourself\n", printable(file.string()));
  for (const std::string& file : report.plain_recordings)
    fmt::print("  remains: the plain recording {}; `phalanx session delete` removes it\n", printable(file));
}

int delete_known_patient(const PatientDeleteOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  const Patient patient = patient_to_delete(opened, o.code);
  confirm_deletion(o, patient);
  const DeleteReport report = opened.registry.delete_patient(opened.actor, patient.record);
  fmt::print("deleted; the record {} remains as a tombstone\n", report.record);
  for (const std::filesystem::path& file : report.exports_removed)
    fmt::print("  removed: {}\n", printable(file.string()));
  for (const std::string& file : report.encrypted_recordings)
    fmt::print("  unreadable from now on, copies too: {}\n", printable(file));
  print_remains(patient, report);
  return kDone;
}

}  // namespace

void add_patient_edit_commands(CLI::App& patient, Job& job) {
  auto added = std::make_shared<PatientEditOptions>();
  CLI::App* add = add_patient_job(patient, "add", "Add a patient", added, job, add_new_patient);
  add_code(*add, *added);
  add_patient_fields(*add, added->fields);
  add->get_option("--side")->required();
  auto edited = std::make_shared<PatientEditOptions>();
  CLI::App* edit =
      add_patient_job(patient, "edit", "Change fields of a patient", edited, job, edit_known_patient);
  add_code(*edit, *edited);
  edit->add_option("--new-code", edited->new_code, "another code")->type_name("CODE");
  add_patient_fields(*edit, edited->fields);
  add_cleared_fields(*edit, edited->fields);
  auto deleted = std::make_shared<PatientDeleteOptions>();
  CLI::App* removal =
      add_patient_job(patient, "delete", "Delete a patient for good, with key, results and exports", deleted,
                      job, delete_known_patient);
  add_code(*removal, *deleted);
  removal->add_option("--confirm", deleted->confirmed, "the code again, for scripts")->type_name("CODE");
}

}  // namespace phalanx
