// SPDX-License-Identifier: Apache-2.0
// From the journal to the rows of the database.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "registry/store/registry_impl.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using registry::Key;

std::string patient_context(const std::string& record) { return fmt::format("patient|{}", record); }
std::string result_context(const std::string& record, const std::string& place) {
  return fmt::format("result|{}|{}", record, place);
}
std::string entry_context(const std::string& record, const std::string& number) {
  return fmt::format("entry|{}|{}", record, number);
}

std::string sealed_hex(const Key& key, const std::string& context, const std::string& text) {
  return registry::to_hex(registry::seal(key, context, text));
}

/// Patient events of a journal, compared with the database's row.
struct PatientStates {
  bool any = false;
  bool after_row = false;    ///< one follows the place up to which the row was made
  bool state_known = false;  ///< one equals the row's state
  json last = {};
};

/// @returns whether the row's state must follow the journal's events: they have none, or lost the one that
/// made the row
bool is_row_newer(const PatientStates& states, const json& of_row, bool same_file) {
  if (!states.any) return true;
  if (of_row == states.last) return false;
  return same_file ? !states.after_row : !states.state_known;
}

/// What the rows of one record say.
struct RowTexts {
  std::string patient = {};
  std::map<std::string, std::string> results = {};  ///< place -> JSON
  std::vector<std::string> entries = {};            ///< whole events
};

}  // namespace

fs::path Registry::Impl::journal_file(const std::string& record) const { return folder / "journal" / record; }

registry::Journal Registry::Impl::journal_of(const std::string& record, const Key& key) const {
  return {journal_file(record), record, key};
}

std::optional<Key> Registry::Impl::row_key(const std::string& record) const {
  std::optional<RecordingKey> key = keys.find(record);
  if (!key) return std::nullopt;
  const Key out = registry::derived_key(*key, "phalanx registry rows");
  registry::wipe(*key);
  return out;
}

std::vector<std::string> Registry::Impl::journal_records() const {
  std::vector<std::string> out;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "journal", error))
    if (const std::string name = entry.path().filename().string(); is_record_id(name)) out.push_back(name);
  std::sort(out.begin(), out.end());
  return out;
}

std::string Registry::Impl::result_place(const Key& key, const ResultRow& row) const {
  return registry::keyed_hash(key, fmt::format("{}\n{}", row.recording, row.number));
}

std::optional<std::string> Registry::Impl::open_row(const Key& key, const std::string& context,
                                                    const std::string& sealed) const {
  const std::optional<std::string> bytes = registry::from_hex(sealed);
  if (!bytes) return std::nullopt;
  return registry::open_sealed(key, context, *bytes);
}

void Registry::Impl::apply_event(const std::string& record, const Key& key, std::uint64_t number,
                                 const std::string& event, registry::PatientRow& row) {
  const json whole = json::parse(event);
  const std::string kind = whole.at("event").get<std::string>();
  if (kind == "patient") {
    row.sealed = sealed_hex(key, patient_context(record), whole.at("patient").dump());
  } else if (kind == "result") {
    const json& result = whole.at("result");
    const std::string place = result_place(key, {.recording = result.at("recording").get<std::string>(),
                                                 .number = result.at("number").get<int>(),
                                                 .exercise = {},
                                                 .scores = {},
                                                 .conditions = {},
                                                 .invalid = {},
                                                 .detail = {}});
    db->put_result(record,
                   {.place = place, .sealed = sealed_hex(key, result_context(record, place), result.dump())});
  } else {
    db->put_entry(record, number, sealed_hex(key, entry_context(record, fmt::format("{}", number)), event));
  }
}

std::uint64_t Registry::Impl::apply_all(const std::string& record, const Key& key) {
  RowTexts old;
  const std::optional<registry::PatientRow> old_row = db->patient(record);
  if (old_row && !old_row->sealed.empty()) {
    old.patient = open_row(key, patient_context(record), old_row->sealed).value_or("");
    for (const registry::SealedRow& each : db->results(record))
      if (std::optional<std::string> text = open_row(key, result_context(record, each.place), each.sealed))
        old.results[each.place] = std::move(*text);
    for (const registry::SealedRow& each : db->entries(record))
      if (std::optional<std::string> text = open_row(key, entry_context(record, each.place), each.sealed))
        old.entries.push_back(std::move(*text));
  }

  registry::Journal journal = journal_of(record, key);
  registry::JournalContent content = journal.read();
  const bool same_file = old_row && !content.generation.empty() && old_row->generation == content.generation;
  const json of_row = old.patient.empty() ? json() : json::parse(old.patient);
  PatientStates states;
  std::set<std::string> places;
  std::multiset<std::string> entries;
  for (std::size_t i = 0; i < content.events.size(); ++i) {
    const std::string& event = content.events[i];
    const json whole = json::parse(event);
    const std::string kind = whole.at("event").get<std::string>();
    if (kind == "patient") {
      states.any = true;
      states.last = whole.at("patient");
      states.after_row = states.after_row || (same_file && content.ends[i] > old_row->bytes);
      states.state_known = states.state_known || states.last == of_row;
    }
    if (kind == "result")
      places.insert(registry::keyed_hash(
          key, fmt::format("{}\n{}", whole.at("result").at("recording").get<std::string>(),
                           whole.at("result").at("number").get<int>())));
    else if (kind != "patient")
      entries.insert(event);
  }
  if (!states.any && old.patient.empty())  // the file stays as it is: restore() joins it with a backup
    return std::max<std::uint64_t>(1, content.damaged);
  std::vector<std::string> events = content.events;
  if (!old.patient.empty() && is_row_newer(states, of_row, same_file))
    events.insert(states.any ? events.end() : events.begin(),
                  json{{"event", "patient"}, {"patient", of_row}}.dump());
  for (const auto& [place, text] : old.results)
    if (!places.contains(place))
      events.push_back(json{{"event", "result"}, {"result", json::parse(text)}}.dump());
  for (const std::string& entry : old.entries) {
    const auto found = entries.find(entry);
    if (found == entries.end())
      events.push_back(entry);
    else
      entries.erase(found);
  }
  // Events that the row was made from, and that the file's end no longer has, are damaged, too.
  const std::uint64_t lost =
      same_file && old_row->events > content.place.events ? old_row->events - content.place.events : 0;
  const std::uint64_t damaged = content.damaged + lost;
  if (events.size() != content.events.size() || damaged > 0)
    content = journal.replace(events);
  else if (content.torn)
    journal.cut(content.place);

  registry::PatientRow row{.record = record,
                           .generation = content.generation,
                           .events = content.place.events,
                           .bytes = content.place.bytes};
  db->transaction([&] {
    db->remove_rows(record);
    std::uint64_t number = 0;
    for (const std::string& event : content.events) apply_event(record, key, number++, event, row);
    db->put_patient(row);
  });
  return damaged;
}

void Registry::Impl::catch_up(const std::string& record) {
  const std::optional<Key> key = row_key(record);
  if (!key) return;
  registry::Journal journal = journal_of(record, *key);
  const std::optional<registry::PatientRow> row = db->patient(record);
  const std::uint64_t bytes = journal.bytes();
  if (!row || row->sealed.empty() || bytes < row->bytes || journal.generation() != row->generation) {
    apply_all(record, *key);
  } else if (bytes > row->bytes) {
    const registry::JournalContent more = journal.read({.events = row->events, .bytes = row->bytes});
    if (more.damaged > 0) {
      apply_all(record, *key);
    } else {
      if (more.torn) journal.cut(more.place);
      registry::PatientRow next = *row;
      db->transaction([&] {
        for (const std::string& event : more.events) apply_event(record, *key, next.events++, event, next);
        next.bytes = more.place.bytes;
        db->put_patient(next);
      });
    }
  }
  if (const std::optional<registry::FileStamp> stamp = registry::stamp_of(journal_file(record)))
    seen[record] = *stamp;
}

void Registry::Impl::catch_up() {
  for (const std::string& record : journal_records()) {
    const std::optional<registry::FileStamp> stamp = registry::stamp_of(journal_file(record));
    const auto found = seen.find(record);
    if (stamp && found != seen.end() && found->second == *stamp) continue;
    if (keys.erased(record))
      finish_deletion(record);
    else
      catch_up(record);
  }
}

std::vector<ResultRow> Registry::Impl::results_of(const OpenRecord& open, std::uint64_t* damaged) {
  std::vector<ResultRow> out;
  for (const registry::SealedRow& each : db->results(open.row.record)) {
    const std::optional<std::string> text =
        open_row(open.key, result_context(open.row.record, each.place), each.sealed);
    if (!text && damaged != nullptr) {
      ++*damaged;
      continue;
    }
    if (!text)
      throw RegistryError(RegistryFault::kDamaged,
                          "a result in the database is damaged; `phalanx patient rebuild` makes it again");
    out.push_back(parse_result_json(*text));
  }
  std::sort(out.begin(), out.end(), [](const ResultRow& a, const ResultRow& b) {
    return std::tie(a.date, a.recording, a.number) < std::tie(b.date, b.recording, b.number);
  });
  return out;
}

std::vector<json> Registry::Impl::entries_of(const OpenRecord& open, const std::string& kind,
                                             std::uint64_t* damaged) {
  std::vector<json> out;
  for (const registry::SealedRow& each : db->entries(open.row.record)) {
    const std::optional<std::string> text =
        open_row(open.key, entry_context(open.row.record, each.place), each.sealed);
    if (!text && damaged != nullptr) {
      ++*damaged;
      continue;
    }
    if (!text)
      throw RegistryError(RegistryFault::kDamaged,
                          "an entry in the database is damaged; `phalanx patient rebuild` makes it again");
    json event = json::parse(*text);
    if (event.at("event").get<std::string>() == kind) out.push_back(std::move(event));
  }
  return out;
}

}  // namespace phalanx
