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

  const std::vector<ResultRow> results = impl_->results_of(open);
  std::vector<EnteredTest> tests;
  json whole = {{"record", record},
                {"patient", json::parse(patient_json(open.patient))},
                {"results", json::array()},
                {"tests", json::array()},
                {"notes", json::array()}};
  for (const ResultRow& row : results) whole["results"].push_back(json::parse(result_json(row)));
  for (const json& event : impl_->entries_of(open, "test")) {
    tests.push_back(parse_test_json(event.at("test").dump()));
    whole["tests"].push_back(event.at("test"));
  }
  for (const json& event : impl_->entries_of(open, "note")) whole["notes"].push_back(event.at("note"));

  const std::vector<std::pair<fs::path, std::string>> files = {
      {to / "patient.json", fmt::format("{}\n", whole.dump(1))},
      {to / "results.csv", results_table(open.patient, results)},
      {to / "tests.csv", tests_table(open.patient, tests)}};
  std::set<std::string> known;
  for (const json& event : impl_->entries_of(open, "export"))
    known.insert(event.at("path").get<std::string>());
  for (const auto& [file, text] : files)  // before the files exist: delete_patient() finds them in any case
    if (!known.contains(file.string()))
      impl_->add_event(open, json{{"event", "export"}, {"path", file.string()}}.dump());
  ExportReport out;
  registry::make_private_folder(to);
  for (const auto& [file, text] : files) {
    registry::replace_private_file(file, text, true);
    out.files.push_back(file);
  }
  return out;
}

}  // namespace phalanx
