// SPDX-License-Identifier: Apache-2.0
// Backup and restore. A backup holds no keys.
#include <fmt/format.h>

#include <algorithm>

#include "record/synchronise_folder.h"
#include "registry/field_checks.h"
#include "registry/store/registry_impl.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kBackupFormat = 1;
constexpr const char* kPlainFiles[] = {"accounts", "audit.jsonl", "deleted", "id"};  ///< that may be missing

/// A backup with the files whose hashes are right.
struct CheckedBackup {
  fs::path folder;
  std::vector<std::string> damaged = {};          ///< names of the others
  std::map<std::string, std::string> files = {};  ///< name -> content, without the database
};

[[noreturn]] void fail_backup(RegistryFault fault, const fs::path& folder, const std::string& what) {
  throw RegistryError(fault, fmt::format("the backup {}: {}", folder.string(), what));
}

bool is_safe_name(const std::string& name) {
  if (name == "registry.sqlite") return true;
  for (const char* each : kPlainFiles)
    if (name == each) return true;
  return name.starts_with("journal/") && is_record_id(name.substr(8));
}

CheckedBackup read_backup(const fs::path& folder) {
  const std::optional<std::string> text = registry::read_private_file(folder / "manifest.json");
  if (!text)
    fail_backup(RegistryFault::kUnknown, folder, "it has no manifest.json; name the folder of a backup");
  CheckedBackup out{.folder = folder};
  try {
    const json manifest = json::parse(*text);
    const int format = manifest.at("format").get<int>();
    const int schema = manifest.at("schema").get<int>();
    if (format > kBackupFormat || schema > kRegistrySchema)
      fail_backup(RegistryFault::kNewer, folder,
                  fmt::format("format {} and schema {}; this program knows {} and {}: install a newer one",
                              format, schema, kBackupFormat, kRegistrySchema));
    for (const auto& [name, hash] : manifest.at("files").get<std::map<std::string, std::string>>()) {
      if (!is_safe_name(name))
        fail_backup(RegistryFault::kDamaged, folder, fmt::format("it names a foreign file {}", name));
      std::optional<std::string> content = registry::read_private_file(folder / name);
      if (!content || registry::sha256(*content) != hash)
        out.damaged.push_back(name);
      else if (name != "registry.sqlite")
        out.files[name] = std::move(*content);
      else if (const int stated = registry::Database::schema_of(folder / name); stated > kRegistrySchema)
        fail_backup(RegistryFault::kNewer, folder,
                    fmt::format("its database has schema {}; install a newer program", stated));
    }
  } catch (const json::exception& error) {
    fail_backup(RegistryFault::kDamaged, folder, fmt::format("its manifest is damaged ({})", error.what()));
  }
  return out;
}

/// @returns the identity of a journal's event among those of the same patient; empty: the patient's state
std::string event_identity(const std::string& event) {
  const json whole = json::parse(event);
  const std::string kind = whole.at("event").get<std::string>();
  if (kind == "patient") return {};
  if (kind == "result")
    return fmt::format("result|{}|{}", whole.at("result").at("recording").get<std::string>(),
                       whole.at("result").at("number").get<int>());
  return event;
}

/// Puts the events of a backup before those of a damaged journal. @returns the events that it lacked
std::size_t joined(registry::Journal journal, std::vector<std::string> events) {
  const std::size_t of_backup = events.size();
  std::set<std::string> known;
  for (const std::string& event : events) known.insert(event_identity(event));
  for (std::string& event : journal.read().events)
    if (known.insert(event_identity(event)).second) events.push_back(std::move(event));
  static_cast<void>(journal.replace(events));
  return of_backup;
}

}  // namespace

BackupReport Registry::backup(const Actor& actor, const fs::path& folder) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  const fs::path to = fs::absolute(folder).lexically_normal();
  if (fs::exists(to))
    throw RegistryError(RegistryFault::kConflict,
                        fmt::format("{} exists already; choose a new folder", to.string()));
  const fs::path inside = fs::weakly_canonical(to).lexically_relative(fs::weakly_canonical(impl_->folder));
  if (!inside.empty() && *inside.begin() != "..")
    throw std::invalid_argument(
        fmt::format("the backup {} would lie in the data folder; choose another place", to.string()));
  impl_->log(actor, "backup", "*");

  const fs::path made = to.string() + ".partial";
  std::error_code ignored;
  if (registry::stamp_of(made / "partial-backup"))
    fs::remove_all(made, ignored);  // of a program that was killed
  registry::make_private_folder(made);
  registry::replace_private_file(made / "partial-backup", "");
  registry::make_private_folder(made / "journal");
  json files = json::object();
  BackupReport report{.folder = to};
  const auto add = [&](const std::string& name, const std::string& content) {
    files[name] = registry::sha256(content);
    report.bytes += content.size();
  };
  impl_->db->copy_to(made / "registry.sqlite");
  add("registry.sqlite", registry::read_private_file(made / "registry.sqlite").value_or(""));
  std::vector<std::string> names(std::begin(kPlainFiles), std::end(kPlainFiles));
  for (const std::string& record : impl_->journal_records())
    names.push_back(fmt::format("journal/{}", record));
  for (const std::string& name : names) {
    const std::optional<std::string> content = registry::read_private_file(impl_->folder / name);
    if (!content) continue;
    registry::replace_private_file(made / name, *content);
    add(name, *content);
  }
  for (const registry::PatientRow& row : impl_->db->patients())
    if (!row.sealed.empty()) ++report.patients;
  const json manifest = {{"format", kBackupFormat},
                         {"schema", kRegistrySchema},
                         {"day", registry::utc_text(impl_->utc()).substr(0, 10)},
                         {"files", files}};
  registry::replace_private_file(made / "manifest.json", fmt::format("{}\n", manifest.dump(1)));
  registry::erase_private_file(made / "partial-backup");
  fs::rename(made, to, ignored);
  if (ignored)
    throw RegistryError(RegistryFault::kDisk, fmt::format("{} cannot be renamed to {}: {}", made.string(),
                                                          to.string(), ignored.message()));
  synchronise_folder(to.parent_path());
  return report;
}

RestoreReport Registry::restore(const Actor& actor, const fs::path& backup) {
  const CheckedBackup from = read_backup(fs::absolute(backup).lexically_normal());
  const Impl::Operation operation(*impl_);
  // Lost accounts come back by this very function, so that their loss does not prevent it.
  const bool are_accounts_lost = impl_->accounts_are_lost();
  if (!are_accounts_lost) impl_->require(actor, Impl::Permission::kAdministration);
  RestoreReport report;
  report.damaged_files = from.damaged;

  const auto content = [&](const std::string& name) {
    const auto found = from.files.find(name);
    return found == from.files.end() ? std::string() : found->second;
  };
  if (impl_->audit->lines() == 0 &&
      from.files.contains("id")) {  // an empty folder becomes that registry again
    const std::string id = content("id").substr(0, RecordingEncryption::kIdLength);
    if (is_record_id(id)) {
      registry::replace_private_file(impl_->folder / "id", fmt::format("{}\n", id));
      impl_->audit->set_id(id);
    }
  }
  report.audit_log_left_out =
      !impl_->audit->take_over(content("audit.jsonl")) && !impl_->audit->begins_with(content("audit.jsonl"));
  const std::optional<registry::AuditHead> head = impl_->audit->head();
  const std::uint64_t lines = impl_->audit->lines();
  if (head && head->lines > lines) report.audit_lines_missing = head->lines - lines;
  impl_->log(actor, "restore", "*",
             report.audit_lines_missing == 0
                 ? std::string()
                 : fmt::format("lines {} to {} of the audit log are missing", lines + 1, head->lines));

  const bool needs_accounts = are_accounts_lost || impl_->accounts().empty();
  report.accounts_left_out = needs_accounts && !impl_->opens_accounts(content("accounts")) &&
                             (are_accounts_lost || from.files.contains("accounts"));
  if (needs_accounts && impl_->opens_accounts(content("accounts"))) {
    registry::replace_private_file(impl_->folder / "accounts", content("accounts"));
    impl_->audit->set_accounts(impl_->accounts().size());
  }

  std::set<std::string> deleted = impl_->deleted_records(from.folder / "deleted");
  deleted.merge(impl_->deleted_records(impl_->folder / "deleted"));
  for (const std::string& record : deleted) impl_->mark_deleted(record);
  for (const auto& [name, journal] : from.files) {
    if (!name.starts_with("journal/")) continue;
    const std::string record = name.substr(8);
    if (deleted.contains(record) || impl_->keys.erased(record)) {
      ++report.deleted_stay_deleted;
      continue;
    }
    const fs::path file = impl_->journal_file(record);
    const std::optional<registry::Key> key = impl_->row_key(record);
    if (!key) {
      report.without_key.push_back(record);
      if (!registry::stamp_of(file)) registry::replace_private_file(file, journal);
      continue;
    }
    const registry::Journal of_backup(from.folder / name, record, *key);
    const std::vector<std::string> events = of_backup.read().events;
    const std::optional<registry::PatientRow> row = impl_->db->patient(record);
    if (!registry::stamp_of(file) && (!row || row->sealed.empty())) {
      registry::replace_private_file(file, journal);
      impl_->catch_up(record);
      report.events_added += events.size();
      continue;
    }
    impl_->catch_up(record);
    const std::optional<registry::PatientRow> living = impl_->db->patient(record);
    if (!living || living->sealed.empty()) {  // the journal here is damaged, and has no patient
      report.events_added += joined(impl_->journal_of(record, *key), events);
      impl_->catch_up(record);
      continue;
    }
    OpenRecord open = impl_->open_record(record);
    std::set<std::string> known;
    for (const std::string& event : open.journal.read().events) known.insert(event_identity(event));
    for (const std::string& event : events)
      if (known.insert(event_identity(event)).second) {  // the patient's state here is the newer one
        impl_->add_event(open, event);
        ++report.events_added;
      }
  }
  for (const registry::PatientRow& row : impl_->db->patients())
    if (!row.sealed.empty()) ++report.patients;
  std::sort(report.without_key.begin(), report.without_key.end());
  return report;
}

}  // namespace phalanx
