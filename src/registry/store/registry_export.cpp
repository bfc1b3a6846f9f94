// SPDX-License-Identifier: Apache-2.0
// Export of a patient: one JSON file and two tables.
#include <fmt/format.h>

#include "registry/store/registry_impl.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// @returns a field of a table in RFC 4180's form
std::string csv(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char each : text) {
    if (each == '"') out.push_back('"');
    out.push_back(each);
  }
  out.push_back('"');
  return out;
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string out;
  for (const std::string& field : fields) out += fmt::format("{}{}", out.empty() ? "" : ",", csv(field));
  out.push_back('\n');
  return out;
}

std::string results_table(const Patient& patient, const std::vector<ResultRow>& rows) {
  std::string out =
      "record,code,recording,number,exercise,assessment,date,interrupted,valid,invalid,score,value,"
      "unit,origin,score_invalid,seconds,repetitions,successes,difficulty,pain,fatigue,device,serial,"
      "calibration_method,contact_mode,stabiliser,rendering,protocol\n";
  for (const ResultRow& row : rows)
    for (const Score& score : row.scores)
      out += csv_line({patient.record,
                       patient.code,
                       row.recording,
                       fmt::format("{}", row.number),
                       row.exercise,
                       row.assessment ? "1" : "0",
                       fmt::format("{}", row.date),
                       row.interrupted ? "1" : "0",
                       row.valid ? "1" : "0",
                       row.invalid,
                       score.name,
                       score.valid() ? fmt::format("{}", score.value) : "",
                       score.unit,
                       std::string(score_origin_name(score.origin)),
                       score.invalid,
                       fmt::format("{}", row.seconds),
                       fmt::format("{}", row.repetitions),
                       fmt::format("{}", row.successes),
                       fmt::format("{}", row.difficulty),
                       fmt::format("{}", row.pain),
                       fmt::format("{}", row.fatigue),
                       row.conditions.device,
                       row.conditions.serial,
                       row.conditions.calibration_method,
                       row.conditions.contact_mode,
                       row.conditions.stabiliser,
                       row.conditions.rendering,
                       row.conditions.protocol});
  return out;
}

std::string tests_table(const Patient& patient, const std::vector<EnteredTest>& tests) {
  std::string out = "record,code,test,value,unit,side,date,rater,note\n";
  for (const EnteredTest& test : tests)
    out += csv_line({patient.record, patient.code, std::string(test_kind(test.kind).name),
                     fmt::format("{}", test.value), std::string(test_kind(test.kind).unit),
                     std::string(test_side_name(test.side)), test.date, test.rater, test.note});
  return out;
}

/// What an export holds.
struct ExportedData {
  std::vector<ResultRow> results = {};
  std::vector<EnteredTest> tests = {};
  json whole = {};  ///< of patient.json
};

/// @param tests, notes  as the registry keeps them
ExportedData exported_data(const Patient& patient, std::vector<ResultRow> results,
                           const std::vector<json>& tests, const std::vector<json>& notes) {
  ExportedData data;
  data.results = std::move(results);
  data.whole = {{"record", patient.record},
                {"patient", json::parse(patient_json(patient))},
                {"results", json::array()},
                {"tests", json::array()},
                {"notes", json::array()}};
  for (const ResultRow& row : data.results) data.whole["results"].push_back(json::parse(result_json(row)));
  for (const json& event : tests) {
    data.tests.push_back(parse_test_json(event.at("test").dump()));
    data.whole["tests"].push_back(event.at("test"));
  }
  for (const json& event : notes) data.whole["notes"].push_back(event.at("note"));
  return data;
}

std::vector<ExportText> texts_of(const Patient& patient, const ExportedData& data) {
  return {{.name = "patient.json",
           .type = "application/json",
           .text = fmt::format("{}\n", data.whole.dump(1, ' ', false, json::error_handler_t::replace))},
          {.name = "results.csv", .type = "text/csv", .text = results_table(patient, data.results)},
          {.name = "tests.csv", .type = "text/csv", .text = tests_table(patient, data.tests)}};
}

void require_empty(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !(fs::is_directory(folder, error) && fs::is_empty(folder, error)))
    throw RegistryError(
        RegistryFault::kConflict,
        fmt::format("{} exists and is not an empty folder; choose another one", folder.string()));
}

}  // namespace

ExportReport Registry::export_patient(const Actor& actor, const std::string& record, const fs::path& folder) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  if (folder.empty()) throw std::invalid_argument("the export needs a folder; name it with --out");
  OpenRecord open = impl_->open_record(record);
  const fs::path to = fs::absolute(folder).lexically_normal();
  const fs::path inside = fs::weakly_canonical(to).lexically_relative(fs::weakly_canonical(impl_->folder));
  if (!inside.empty() && *inside.begin() != "..")
    throw std::invalid_argument(fmt::format(
        "the export {} would lie in the data folder, where all else is sealed; choose another place",
        to.string()));
  require_empty(to);
  impl_->log(actor, "export", record);

  const ExportedData data = exported_data(open.patient, impl_->results_of(open),
                                          impl_->entries_of(open, "test"), impl_->entries_of(open, "note"));
  const std::vector<ExportText> files = texts_of(open.patient, data);
  std::set<std::string> known;
  for (const json& event : impl_->entries_of(open, "export"))
    known.insert(event.at("path").get<std::string>());
  for (const ExportText& file : files) {  // before the files exist: delete_patient() finds them in any case
    const std::string path = (to / file.name).string();
    if (!known.contains(path)) impl_->add_event(open, json{{"event", "export"}, {"path", path}}.dump());
  }
  ExportReport out;
  registry::make_private_folder(to);
  for (const ExportText& file : files) {
    registry::replace_private_file(to / file.name, file.text, true);
    out.files.push_back(to / file.name);
  }
  return out;
}

std::vector<ExportText> Registry::export_texts(const Actor& actor, const std::string& record) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  const OpenRecord open = impl_->open_record(record);
  impl_->log(actor, "export", record);
  return texts_of(open.patient,
                  exported_data(open.patient, impl_->results_of(open), impl_->entries_of(open, "test"),
                                impl_->entries_of(open, "note")));
}

}  // namespace phalanx
