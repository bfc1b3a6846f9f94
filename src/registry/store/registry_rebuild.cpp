// SPDX-License-Identifier: Apache-2.0
// The rows again, from journal and recordings.
#include <fmt/format.h>

#include <algorithm>

#include "registry/store/registry_impl.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

bool is_recording_name(const std::string& name) {
  return name.ends_with(".mcap") || name.ends_with(".mcap.enc");
}

/// @returns the recordings of files and folders, each once, sorted
std::vector<fs::path> expanded(const std::vector<fs::path>& given) {
  std::set<fs::path> out;
  for (const fs::path& each : given) {
    std::error_code error;
    if (!fs::is_directory(each, error)) {
      if (!fs::exists(each, error))
        throw std::invalid_argument(fmt::format("there is no recording or folder {}", each.string()));
      out.insert(fs::absolute(each).lexically_normal());
      continue;
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(each))
      if (entry.is_regular_file(error) && is_recording_name(entry.path().filename().string()))
        out.insert(fs::absolute(entry.path()).lexically_normal());
  }
  return {out.begin(), out.end()};
}

/// @returns a result without its recording's name: equal for copies of a recording
std::string without_recording(const ResultRow& row) {
  ResultRow out = row;
  out.recording = "-";
  return result_json(out);
}

/// A living patient during a rebuild.
struct RebuiltRecord {
  OpenRecord open;
  std::map<std::string, ResultRow> rows = {};            ///< by result_place()
  std::map<std::string, std::string> recording_of = {};  ///< recording by without_recording(), to find copies
};

/// Content of one recording, read before the registry is locked: a recording takes seconds.
struct ReadRecording {
  std::string name = {};
  std::set<std::string> asked = {};  ///< record ids that it states
  std::vector<ResultRow> rows = {};
  std::optional<std::string> error = {};
};

ReadRecording read_recording(const fs::path& file, const RecordedResultsOf& reader, const KeyStore& keys) {
  ReadRecording out{.name = file.filename().string()};
  try {
    out.rows = reader(file, [&](const std::string& id) -> std::optional<RecordingKey> {
      out.asked.insert(id);
      return keys.find(id);
    });
  } catch (const std::exception& error) {
    out.error = error.what();
  }
  return out;
}

/// Adds the results of recordings to the patients that own them.
class RecordingReader {
 public:
  RecordingReader(std::map<std::string, RebuiltRecord>& records, const KeyStore& keys, RebuildReport& report,
                  std::function<std::string(const registry::Key&, const ResultRow&)> place,
                  std::function<void(OpenRecord&, const std::string&)> add_event)
      : records_(records),
        keys_(keys),
        report_(report),
        place_(std::move(place)),
        add_event_(std::move(add_event)) {}

  /// States that a plain recording belongs to a patient.
  void know(const std::string& file, const std::string& record) { owners_[file].insert(record); }

  /// Adds the results of one recording.
  void take(ReadRecording&& read) {
    const std::string& name = read.name;
    seen_.insert(name);
    const std::string reason = refusal(name, read.asked);
    if (read.error) {
      if (!read.asked.empty() && !reason.empty()) return report_.not_assigned.push_back(reason);
      report_.unreadable.push_back(fmt::format("{}: {}", name, *read.error));
      return;
    }
    if (read.rows.empty()) return;
    if (!reason.empty()) return report_.not_assigned.push_back(reason);
    const std::string record = read.asked.empty() ? *owners_.at(name).begin() : *read.asked.begin();
    for (ResultRow& row : read.rows) {
      row.recording = name;
      add(records_.at(record), row, !read.asked.empty());
    }
  }

  [[nodiscard]] const std::set<std::string>& seen() const noexcept { return seen_; }

 private:
  /// @returns why no patient owns a recording; empty: one does
  std::string refusal(const std::string& name, const std::set<std::string>& asked) const {
    if (asked.size() > 1) return fmt::format("{}: it names more than one record", name);
    if (!asked.empty()) {
      const std::string& id = *asked.begin();
      if (records_.contains(id)) return {};
      return is_record_id(id) && keys_.erased(id)
                 ? fmt::format("{}: its patient was deleted", name)
                 : fmt::format("{}: no patient here has its record id", name);
    }
    const auto found = owners_.find(name);
    if (found == owners_.end())
      return fmt::format("{}: it is not encrypted, and no patient's data names it", name);
    return found->second.size() == 1
               ? std::string()
               : fmt::format("{}: it is not encrypted, and {} patients name it", name, found->second.size());
  }

  void add(RebuiltRecord& to, const ResultRow& row, bool encrypted) {
    try {
      check_result(row);
    } catch (const std::invalid_argument& error) {
      report_.unreadable.push_back(fmt::format("{} {}: {}", row.recording, row.number, error.what()));
      return;
    }
    const std::string place = place_(to.open.key, row);
    const std::string text = result_json(row);
    const auto known = to.rows.find(place);
    if (known != to.rows.end() && result_json(known->second) == text) return;
    if (known != to.rows.end() && !encrypted) {
      report_.differ.push_back(fmt::format("{} {}", row.recording, row.number));
      return;
    }
    if (known == to.rows.end()) {
      const auto same = to.recording_of.find(without_recording(row));
      if (same != to.recording_of.end()) {
        report_.not_assigned.push_back(
            fmt::format("{} {}: it is a copy of {}", row.recording, row.number, same->second));
        return;
      }
    }
    add_event_(to.open, json{{"event", "result"}, {"result", json::parse(text)}}.dump());
    (known == to.rows.end() ? report_.added : report_.changed) += 1;
    if (known != to.rows.end()) to.recording_of.erase(without_recording(known->second));
    to.rows[place] = row;
    to.recording_of[without_recording(row)] = row.recording;
  }

  std::map<std::string, RebuiltRecord>& records_;
  const KeyStore& keys_;
  RebuildReport& report_;
  std::function<std::string(const registry::Key&, const ResultRow&)> place_;
  std::function<void(OpenRecord&, const std::string&)> add_event_;
  std::map<std::string, std::set<std::string>> owners_;  ///< plain recording -> records that name it
  std::set<std::string> seen_;
};

}  // namespace

RebuildReport Registry::rebuild(const Actor& actor, const std::vector<fs::path>& recordings,
                                const RecordedResultsOf& reader) {
  const std::vector<fs::path> files = expanded(recordings);
  {
    const Impl::Operation operation(*impl_);
    impl_->require(actor, Impl::Permission::kPatients);
    impl_->log(actor, "rebuild", "*");
  }
  std::vector<ReadRecording> read;
  read.reserve(files.size());
  for (const fs::path& file : files) read.push_back(read_recording(file, reader, impl_->keys));

  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);

  std::set<std::string> all;
  for (const registry::PatientRow& row : impl_->db->patients())
    if (!row.sealed.empty()) all.insert(row.record);
  for (const std::string& record : impl_->journal_records()) all.insert(record);

  RebuildReport report;
  std::map<std::string, RebuiltRecord> records;
  RecordingReader recorded(
      records, impl_->keys, report,
      [&](const registry::Key& key, const ResultRow& row) { return impl_->result_place(key, row); },
      [&](OpenRecord& open, const std::string& event) { impl_->add_event(open, event); });
  for (const std::string& record : all) {
    const std::optional<registry::Key> key = impl_->row_key(record);
    if (!key) {
      report.without_key.push_back(record);
      continue;
    }
    report.damaged_events += impl_->apply_all(record, *key);
    const std::optional<registry::PatientRow> row = impl_->db->patient(record);
    if (!row || row->sealed.empty()) continue;
    std::optional<OpenRecord> open;
    try {
      open = impl_->open_record(record);
    } catch (const RegistryError& error) {  // it stays as it is: damaged_patients() names it
      if (error.fault() != RegistryFault::kDamaged) throw;
      continue;
    }
    RebuiltRecord rebuilt{.open = std::move(*open)};
    for (const ResultRow& each : impl_->results_of(rebuilt.open)) {
      recorded.know(each.recording, record);
      rebuilt.rows[impl_->result_place(*key, each)] = each;
      rebuilt.recording_of[without_recording(each)] = each.recording;
    }
    for (const json& event : impl_->entries_of(rebuilt.open, "recording"))
      recorded.know(event.at("file").get<std::string>(), record);
    records.emplace(record, std::move(rebuilt));
  }
  for (ReadRecording& each : read) recorded.take(std::move(each));

  for (auto& [record, rebuilt] : records) {
    ++report.patients;
    report.results += rebuilt.rows.size();
    report.tests += impl_->entries_of(rebuilt.open, "test").size();
    report.notes += impl_->entries_of(rebuilt.open, "note").size();
    for (const auto& [place, row] : rebuilt.rows)
      if (!recorded.seen().contains(row.recording))
        report.kept_without_file.push_back(fmt::format("{} {}", row.recording, row.number));
  }
  std::sort(report.kept_without_file.begin(), report.kept_without_file.end());
  impl_->db->compact();
  return report;
}

}  // namespace phalanx
