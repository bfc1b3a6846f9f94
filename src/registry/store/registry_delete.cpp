// SPDX-License-Identifier: Apache-2.0
// Deletion of a patient: the key first, then all that is left.
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "registry/store/registry_impl.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kDeletedContext = "phalanx deleted record";

bool is_encrypted_name(const std::string& file) { return file.ends_with(".mcap.enc"); }

/// KeyUse by a lock.
class LockedUse final : public KeyUse {
 public:
  explicit LockedUse(const fs::path& file) : lock_(file) {}

 private:
  registry::SharedLock lock_;
};

void remove_if_empty(const fs::path& folder) noexcept {
  std::error_code ignored;
  if (fs::is_directory(folder, ignored) && fs::is_empty(folder, ignored)) fs::remove(folder, ignored);
}

}  // namespace

std::set<std::string> Registry::Impl::deleted_records(const fs::path& file) const {
  std::set<std::string> out;
  std::istringstream lines(registry::read_private_file(file).value_or(""));
  std::string record;
  std::string seal;
  while (lines >> record >> seal) {
    const std::optional<std::string> bytes = registry::from_hex(seal);
    if (bytes && is_record_id(record) && keys.open_sealed(kDeletedContext, *bytes) == record)
      out.insert(record);
  }
  return out;
}

void Registry::Impl::mark_deleted(const std::string& record) {
  const fs::path file = folder / "deleted";
  if (deleted_records(file).contains(record)) return;
  const std::string before = registry::read_private_file(file).value_or("");
  registry::append_private_file(
      file, fmt::format("{}{} {}\n", before.empty() || before.back() == '\n' ? "" : "\n", record,
                        registry::to_hex(keys.seal(kDeletedContext, record))));
}

void Registry::Impl::finish_deletion(const std::string& record) {
  const std::optional<registry::PatientRow> row = db->patient(record);
  const bool has_row = row && !row->sealed.empty();
  const fs::path exports = folder / "exports" / record;
  std::error_code ignored;
  const bool has_journal = registry::stamp_of(journal_file(record)).has_value();
  if (!has_row && !has_journal && !fs::exists(exports, ignored)) return;
  mark_deleted(record);
  fs::remove(use_file(record), ignored);
  registry::erase_private_file(journal_file(record));
  registry::erase_private_file(fs::path(journal_file(record).string() + ".new"));
  seen.erase(record);
  if (fs::is_directory(exports, ignored)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(exports, ignored))
      if (entry.is_regular_file(ignored)) registry::erase_private_file(entry.path());
    remove_if_empty(exports);
  }
  db->transaction([&] { db->remove_patient(record); });
  db->compact();
}

void Registry::Impl::remove_exports(const OpenRecord& open, DeleteReport& report) {
  std::uint64_t ignored = 0;  // damaged rows are counted by the caller
  for (const json& event : entries_of(open, "export", &ignored)) {
    const fs::path file = event.at("path").get<std::string>();
    std::error_code error;
    const fs::path unfinished =
        file.string() + ".new";  // of a program that was killed while it wrote the file
    if (fs::is_regular_file(fs::symlink_status(unfinished, error))) {
      registry::erase_private_file(unfinished);
      report.exports_removed.push_back(unfinished);
      remove_if_empty(unfinished.parent_path());
    }
    const bool is_file = fs::is_regular_file(fs::symlink_status(file, error));
    const std::string text = is_file ? registry::read_private_file(file).value_or("") : std::string();
    const bool is_empty_table = text.starts_with("record,code,") && text.find('\n') + 1 == text.size();
    if (is_empty_table || text.find(open.row.record) != std::string::npos) {
      registry::erase_private_file(file);
      report.exports_removed.push_back(file);
      remove_if_empty(file.parent_path());
    } else if (std::find(report.exports_removed.begin(), report.exports_removed.end(), file) ==
               report.exports_removed.end()) {
      report.exports_missing.push_back(file);
    }
  }
}

void Registry::Impl::delete_named_files(const OpenRecord& open, DeleteReport& report) {
  std::uint64_t damaged = 0;
  static_cast<void>(results_of(open, &damaged));
  static_cast<void>(entries_of(open, "recording", &damaged));
  if (damaged > 0) apply_all(open.row.record, open.key);  // the journal may have what the rows lost
  std::set<std::string> recordings;
  for (const json& event : entries_of(open, "recording", &report.unreadable_rows))
    recordings.insert(event.at("file").get<std::string>());
  for (const ResultRow& row : results_of(open, &report.unreadable_rows)) recordings.insert(row.recording);
  for (const std::string& file : recordings)
    (is_encrypted_name(file) ? report.encrypted_recordings : report.plain_recordings).push_back(file);
  remove_exports(open, report);
}

fs::path Registry::Impl::use_file(const std::string& record) const { return folder / "in_use" / record; }

void Registry::Impl::refuse_in_use(const std::string& record) const {
  const std::optional<std::string> holder = registry::holder_of(use_file(record));
  if (!holder) return;
  throw RegistryError(
      RegistryFault::kConflict,
      fmt::format("{} records with the key of this patient; delete the patient on the page of that station "
                  "after the exercise, or end that program and delete again",
                  *holder));
}

std::shared_ptr<const KeyUse> Registry::use_key(const Actor& actor, const std::string& record) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  static_cast<void>(impl_->open_record(record));
  registry::make_private_folder(impl_->folder / "in_use");
  return std::make_shared<LockedUse>(impl_->use_file(record));
}

DeleteReport Registry::delete_patient(const Actor& actor, const std::string& record) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  const std::optional<registry::PatientRow> row =
      is_record_id(record) ? impl_->db->patient(record) : std::nullopt;
  const bool is_known = is_record_id(record) && ((row && !row->sealed.empty()) ||
                                                 registry::stamp_of(impl_->journal_file(record)).has_value());
  if (!is_known) static_cast<void>(impl_->open_record(record));  // it refuses an unknown record
  impl_->logged_if_it_fails(actor, "delete_failed", [&] { impl_->refuse_in_use(record); });
  impl_->log(actor, "delete", record);
  DeleteReport out{.record = record,
                   .exports_removed = {},
                   .exports_missing = {},
                   .encrypted_recordings = {},
                   .plain_recordings = {}};
  try {
    impl_->delete_named_files(impl_->open_record(record), out);
  } catch (const RegistryError& error) {  // without key, or damaged: the record id is enough to delete it
    if (error.fault() == RegistryFault::kDisk || error.fault() == RegistryFault::kNewer) throw;
    ++out.unreadable_rows;
  }
  impl_->keys.erase(record);  // from here on, open() completes the deletion
  impl_->finish_deletion(record);
  return out;
}

}  // namespace phalanx
