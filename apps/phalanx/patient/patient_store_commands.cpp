// SPDX-License-Identifier: Apache-2.0
// phalanx patient export | rebuild | backup | restore.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "patient/patient_commands.h"
#include "patient/patient_text.h"
#include "patient/rebuilt_measurements.h"

namespace phalanx {
namespace {

constexpr const char* kRecordings = "out/recordings";

struct PatientExportOptions : PatientOptions {
  std::string out = {};
};

struct RebuildOptions {
  RegistryOptions registry = {};
  std::vector<std::string> recordings = {};
};

struct BackupOptions {
  RegistryOptions registry = {};
  std::string folder = {};
};

int export_known_patient(const PatientExportOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  const Patient patient = opened.registry.patient(opened.actor, o.code);
  const ExportReport report = opened.registry.export_patient(opened.actor, patient.record, o.out);
  for (const std::filesystem::path& file : report.files) fmt::print("{}\n", printable(file.string()));
  return kDone;
}

void print_each(const char* what, const std::vector<std::string>& lines) {
  for (const std::string& line : lines) fmt::print("  {}: {}\n", what, printable(line));
}

/// @returns the recordings to read: those of the command, else the folder of `phalanx run`, if it is there
std::vector<std::filesystem::path> chosen_recordings(const std::vector<std::string>& typed) {
  std::vector<std::filesystem::path> chosen(typed.begin(), typed.end());
  std::error_code ignored;
  for (const std::filesystem::path& path : chosen)
    if (!std::filesystem::exists(path, ignored))
      throw std::invalid_argument(fmt::format("there is no recording and no folder {}", path.string()));
  if (chosen.empty() && std::filesystem::is_directory(kRecordings, ignored)) chosen.emplace_back(kRecordings);
  return chosen;
}

int rebuild_rows(const RebuildOptions& o) {
  const std::vector<std::filesystem::path> recordings = chosen_recordings(o.recordings);
  OpenedRegistry opened = open_registry(o.registry);
  RebuiltMeasurements measured(opened.registry, opened.actor);
  const RebuildReport report = opened.registry.rebuild(
      opened.actor, recordings,
      [&measured](const auto& file, const auto& keys) { return measured.read(file, keys); });
  const std::vector<std::string> changed = measured.take_over();
  fmt::print("{} patients, {} results, {} entered tests, {} notes; {} rows added, {} changed\n",
             report.patients, report.results, report.tests, report.notes, report.added, report.changed);
  print_each("measured values taken over from recordings", changed);
  print_each("kept, its recording is missing", report.kept_without_file);
  print_each("differs from its recording, kept as it was", report.differ);
  print_each("of no patient", report.not_assigned);
  print_each("cannot be read", report.unreadable);
  print_each("record without a key, kept as it is", report.without_key);
  const std::vector<std::string> damaged = opened.registry.damaged_patients(opened.actor);
  print_each("damaged record, restore a backup", damaged);
  if (report.damaged_events > 0)
    fmt::print("  {} events of the journal were damaged; the rows of the database replaced what they had\n",
               report.damaged_events);
  return report.unreadable.empty() && report.differ.empty() && damaged.empty() && report.damaged_events == 0
             ? kDone
             : kFailed;
}

int make_backup(const BackupOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  const BackupReport report = opened.registry.backup(opened.actor, o.folder);
  fmt::print("{}: {} patients, {:.1f} MB\n", report.folder.string(), report.patients,
             1e-6 * static_cast<double>(report.bytes));
  fmt::print("  the keys are not in it: keep a copy of {} in another place\n",
             opened.registry.keys().file().string());
  return kDone;
}

int restore_backup(const BackupOptions& o) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(o.folder, ignored))
    throw std::invalid_argument(
        fmt::format("there is no backup {}; it is the folder that `phalanx patient backup` made", o.folder));
  OpenedRegistry opened = open_registry(o.registry, MissingRegistry::kRestored);
  const RestoreReport report = opened.registry.restore(opened.actor, o.folder);
  fmt::print("{} patients; {} events added; {} patients of the backup stay deleted\n", report.patients,
             report.events_added, report.deleted_stay_deleted);
  print_each("record without a key, unreadable here", report.without_key);
  if (report.audit_lines_missing > 0)
    fmt::print("  {} lines of the audit log are neither here nor in the backup\n",
               report.audit_lines_missing);
  print_each("damaged in the backup, left out", report.damaged_files);
  if (report.audit_log_left_out)
    fmt::print("  the backup's audit log does not fit to the one here, which stays as it is\n");
  if (report.accounts_left_out)
    fmt::print(
        "  the accounts could not be restored: take a backup that has them, and the key file of its time\n");
  return report.damaged_files.empty() && !report.audit_log_left_out && !report.accounts_left_out ? kDone
                                                                                                 : kFailed;
}

}  // namespace

void add_patient_store_commands(CLI::App& patient, Job& job) {
  auto exported = std::make_shared<PatientExportOptions>();
  CLI::App* exporter = add_patient_job(patient, "export", "Write all data of a patient as JSON and CSV",
                                       exported, job, export_known_patient);
  add_code(*exporter, *exported);
  exporter
      ->add_option("--out", exported->out,
                   "a new or empty folder outside the data folder; the files are plain")
      ->required()
      ->type_name("DIR");
  auto rebuilt = std::make_shared<RebuildOptions>();
  CLI::App* rebuild =
      add_patient_job(patient, "rebuild", "Make the database again from the journal and the recordings",
                      rebuilt, job, rebuild_rows);
  rebuild->footer(
      "Exit codes: 0 done, 1 a recording could not be read or differs from its rows, 2 wrong usage.");
  rebuild
      ->add_option("RECORDING", rebuilt->recordings,
                   "recordings, or folders of them [out/recordings, if it is there]")
      ->type_name("");
  auto saved = std::make_shared<BackupOptions>();
  CLI::App* backup = add_patient_job(
      patient, "backup", "Copy the registry, without its keys, into a new folder", saved, job, make_backup);
  backup->add_option("DIR", saved->folder, "the backup, a folder that does not exist yet")
      ->required()
      ->type_name("");
  auto restored = std::make_shared<BackupOptions>();
  CLI::App* restore =
      add_patient_job(patient, "restore", "Bring back what a backup holds; deleted patients stay deleted",
                      restored, job, restore_backup);
  restore->add_option("DIR", restored->folder, "the backup")->required()->type_name("");
}

}  // namespace phalanx
