// SPDX-License-Identifier: Apache-2.0
// Results, entered tests, notes, recordings and trends of a patient.
#include <fmt/format.h>

#include "registry/field_checks.h"
#include "registry/store/registry_impl.h"

namespace phalanx {

using nlohmann::json;

void Registry::add_recording(const Actor& actor, const std::string& record, const std::string& file_name) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  OpenRecord open = impl_->open_record(record);
  registry::check_text("recording", file_name, 255);
  if (file_name.empty() || file_name.find('/') != std::string::npos)
    throw std::invalid_argument(
        fmt::format("the recording \"{}\" must be a file name without a folder", file_name));
  impl_->log(actor, "add_recording", record);
  for (const json& known : impl_->entries_of(open, "recording"))
    if (known.at("file").get<std::string>() == file_name) return;
  impl_->add_event(open, json{{"event", "recording"}, {"file", file_name}}.dump());
}

std::vector<std::string> Registry::recordings_without_result(const Actor& actor, const std::string& record) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  const OpenRecord open = impl_->open_record(record);
  impl_->log(actor, "recordings", record);
  std::set<std::string> names;
  for (const json& known : impl_->entries_of(open, "recording"))
    names.insert(known.at("file").get<std::string>());
  for (const ResultRow& row : impl_->results_of(open)) names.erase(row.recording);
  return {names.begin(), names.end()};
}

bool Registry::add_result(const Actor& actor, const std::string& record, const ResultRow& row) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  OpenRecord open = impl_->open_record(record);
  check_result(row);
  if (impl_->db->has_result(record, impl_->result_place(open.key, row))) return false;
  impl_->log(actor, "add_result", record);
  impl_->add_event(open, json{{"event", "result"}, {"result", json::parse(result_json(row))}}.dump());
  return true;
}

std::vector<ResultRow> Registry::results(const Actor& actor, const std::string& record) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  const OpenRecord open = impl_->open_record(record);
  impl_->log(actor, "results", record);
  return impl_->results_of(open);
}

void Registry::add_test(const Actor& actor, const std::string& record, const EnteredTest& test) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  OpenRecord open = impl_->open_record(record);
  check_test(test);
  impl_->log(actor, "add_test", record);
  impl_->add_event(open, json{{"event", "test"},
                              {"id", registry::random_record_id()},
                              {"account", actor.account},
                              {"test", json::parse(test_json(test))}}
                             .dump());
}

std::vector<EnteredTest> Registry::tests(const Actor& actor, const std::string& record) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  const OpenRecord open = impl_->open_record(record);
  impl_->log(actor, "tests", record);
  std::vector<EnteredTest> out;
  for (const json& event : impl_->entries_of(open, "test"))
    out.push_back(parse_test_json(event.at("test").dump()));
  return out;
}

void Registry::add_note(const Actor& actor, const std::string& record, const std::string& text) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  OpenRecord open = impl_->open_record(record);
  if (text.empty()) throw std::invalid_argument("the note is empty");
  registry::check_anonymous("note", text, 4000);
  impl_->log(actor, "add_note", record);
  const PatientNote note{.date = impl_->utc(), .account = actor.account, .text = text};
  impl_->add_event(
      open,
      json{{"event", "note"}, {"id", registry::random_record_id()}, {"note", json::parse(note_json(note))}}
          .dump());
}

std::vector<PatientNote> Registry::notes(const Actor& actor, const std::string& record) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  const OpenRecord open = impl_->open_record(record);
  impl_->log(actor, "notes", record);
  std::vector<PatientNote> out;
  for (const json& event : impl_->entries_of(open, "note"))
    out.push_back(parse_note_json(event.at("note").dump()));
  return out;
}

std::vector<Trend> Registry::trends(const Actor& actor, const std::string& record) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  const OpenRecord open = impl_->open_record(record);
  impl_->log(actor, "trend", record);
  std::vector<EnteredTest> tests;
  for (const json& event : impl_->entries_of(open, "test"))
    tests.push_back(parse_test_json(event.at("test").dump()));
  return make_trends(impl_->results_of(open), tests);
}

RecordingEncryption Registry::recording_key(const Actor& actor, const std::string& record) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  const OpenRecord open = impl_->open_record(record);
  impl_->log(actor, "record", record);
  const std::optional<RecordingKey> key = impl_->keys.find(record);
  if (!key)
    throw RegistryError(RegistryFault::kNoKey, fmt::format("the key of record {} is not here", record));
  return {.id = record, .key = *key};
}

FindRecordingKey Registry::recording_keys(const Actor& actor) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  impl_->log(actor, "keys", "*");
  return impl_->keys.finder();
}

bool update_patient(Registry& registry, const Actor& actor, const std::string& record,
                    const std::function<bool(Patient&)>& change) {
  const auto tried = [&] {
    Patient patient = registry.patient(actor, record);
    const std::string base = patient_revision(patient);
    if (!change(patient)) return false;
    registry.edit_patient(actor, patient, base);
    return true;
  };
  try {
    return tried();
  } catch (const RegistryError& error) {
    if (error.fault() != RegistryFault::kConflict) throw;
  }
  return tried();
}

}  // namespace phalanx
