// SPDX-License-Identifier: Apache-2.0
#include "serve/people_json.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "phalanx/exercise/score.h"
#include "record/plain_text.h"
#include "report/score_names.h"

namespace phalanx::people {
namespace {

using nlohmann::json;

json parsed_again(const std::string& text) { return json::parse(text); }

json scores_json(std::span<const Score> scores) {
  json all = json::array();
  for (const Score& score : scores) {
    json one = {{"name", as_utf8(score.name)},
                {"unit", as_utf8(score.unit)},
                {"origin", score_origin_name(score.origin)},
                {"invalid", as_utf8(score.invalid)}};
    if (score.valid()) one["value"] = score.value;
    all.push_back(std::move(one));
  }
  return all;
}

json result_row_json(const ResultRow& row) {
  return {{"date", row.date},
          {"exercise", as_utf8(row.exercise)},
          {"assessment", row.assessment},
          {"recording", as_utf8(row.recording)},
          {"scores", scores_json(row.scores)},
          {"interrupted", row.interrupted},
          {"invalid", row.valid ? "" : as_utf8(row.invalid.empty() ? "not valid" : row.invalid)},
          {"seconds", row.seconds},
          {"repetitions", row.repetitions},
          {"successes", row.successes},
          {"pain", row.pain},
          {"fatigue", row.fatigue}};
}

/// Adds the names of scores for people, in the page's languages.
void add_names(json& names, std::span<const Score> scores) {
  for (const Score& score : scores) {
    const std::string name = as_utf8(score.name);
    if (names.contains(name)) continue;
    names[name] = {{"en", report::score_label(name, ReportLanguage::kEnglish)},
                   {"de", report::score_label(name, ReportLanguage::kGerman)}};
  }
}

json trend_json(const Trend& trend) {
  json points = json::array();
  for (const TrendPoint& point : trend.points)
    points.push_back({{"date", point.date}, {"value", point.value}});
  json one = {{"name", as_utf8(trend.name)},
              {"title", as_utf8(trend.title)},
              {"unit", as_utf8(trend.unit)},
              {"points", std::move(points)},
              {"proven", trend.proven},
              {"verdict", as_utf8(trend.verdict)},
              {"device", trend.conditions.device},
              {"entered", !trend.origin.has_value()}};
  if (trend.smallest_real_difference) one["smallest_real_difference"] = *trend.smallest_real_difference;
  return one;
}

json texts(const std::vector<std::filesystem::path>& paths) {
  json all = json::array();
  for (const auto& path : paths) all.push_back(as_utf8(path.string()));
  return all;
}

json texts(const std::vector<std::string>& names) {
  json all = json::array();
  for (const auto& name : names) all.push_back(as_utf8(name));
  return all;
}

}  // namespace

std::vector<std::string> obstacles(const Patient& patient, const std::string& today) {
  std::vector<std::string> found;
  if (!patient.entry) {
    found.emplace_back("unchecked");
  } else if (!patient.entry->suitable) {
    found.emplace_back("unsuitable");
  }
  if (!patient.consent) found.emplace_back("no_consent");
  // Dates of this form are in the order of their characters. The last day of validity is valid.
  if (!patient.calibration_expires.empty() && patient.calibration_expires < today)
    found.emplace_back("expired");
  if (!patient.contraindications.empty()) found.emplace_back("contraindication");
  return found;
}

json status_json(bool accounts) {
  json symbols = json::array();
  for (const std::string_view symbol : patient_symbols()) symbols.push_back(symbol);
  json tests = json::array();
  for (const TestKindInfo& kind : test_kinds())
    tests.push_back(
        {{"kind", kind.name}, {"unit", kind.unit}, {"least", kind.least}, {"most", kind.largest}});
  return {{"accounts", accounts}, {"symbols", std::move(symbols)}, {"tests", std::move(tests)}};
}

json list_json(std::span<const Patient> patients, const std::string& today) {
  json all = json::array();
  for (const Patient& patient : patients)
    all.push_back({{"record", patient.record},
                   {"code", patient.code},
                   {"side", side_name(patient.side)},
                   {"symbol", patient.symbol},
                   {"obstacles", obstacles(patient, today)}});
  return {{"patients", std::move(all)}};
}

json one_json(const Patient& patient, const std::string& today) {
  json one = parsed_again(patient_json(patient));
  one["obstacles"] = obstacles(patient, today);
  one["revision"] = patient_revision(patient);
  return one;
}

json course_json(std::span<const ResultRow> results, std::span<const EnteredTest> tests,
                 std::span<const PatientNote> notes, std::span<const Trend> trends) {
  json course = {{"results", json::array()},
                 {"tests", json::array()},
                 {"notes", json::array()},
                 {"trends", json::array()},
                 {"names", json::object()}};
  for (const ResultRow& row : results) {
    course["results"].push_back(result_row_json(row));
    add_names(course["names"], row.scores);
  }
  for (const EnteredTest& test : tests) {
    const TestKindInfo& kind = test_kind(test.kind);
    course["tests"].push_back({{"kind", kind.name},
                               {"unit", kind.unit},
                               {"value", test.value},
                               {"side", test_side_name(test.side)},
                               {"date", test.date},
                               {"rater", as_utf8(test.rater)},
                               {"note", as_utf8(test.note)}});
  }
  for (const PatientNote& note : notes)
    course["notes"].push_back(
        {{"date", note.date}, {"account", as_utf8(note.account)}, {"text", as_utf8(note.text)}});
  for (const Trend& trend : trends) course["trends"].push_back(trend_json(trend));
  return course;
}

json score_names_json(std::span<const Score> scores) {
  json names = json::object();
  add_names(names, scores);
  return names;
}

json exercises_json(std::span<const ListedExercise> exercises) {
  json all = json::array();
  for (const ListedExercise& exercise : exercises)
    all.push_back({{"name", as_utf8(exercise.name)},
                   {"title", as_utf8(exercise.title)},
                   {"title_de", as_utf8(exercise.title_de)},
                   {"kind", exercise.kind},
                   {"measure", exercise.measure}});
  return {{"exercises", std::move(all)}};
}

json deleted_json(const DeleteReport& report) {
  return {{"record", report.record},
          {"exports_missing", texts(report.exports_missing)},
          {"plain_recordings", texts(report.plain_recordings)},
          {"encrypted_recordings", report.encrypted_recordings.size()},
          {"exports_removed", report.exports_removed.size()},
          {"unreadable_rows", report.unreadable_rows}};
}

json read_object(std::string_view body) {
  const json::parser_callback_t shallow = [](int depth, json::parse_event_t, json&) {
    if (depth > static_cast<int>(kDeepestJson))
      throw std::invalid_argument("this request is nested too deeply; reload the page");
    return true;
  };
  json object;
  try {
    object = json::parse(body.begin(), body.end(), shallow);
  } catch (const json::exception&) {
    throw std::invalid_argument("this request is no JSON; reload the page");
  }
  if (!object.is_object()) throw std::invalid_argument("this request is no object of JSON; reload the page");
  return object;
}

std::string text_of(const json& object, const char* field, std::size_t longest) {
  const auto found = object.find(field);
  if (found == object.end() || found->is_null()) return {};
  if (!found->is_string()) throw std::invalid_argument(fmt::format("{}: is no text; reload the page", field));
  std::string text = found->get<std::string>();
  if (text.size() > longest)
    throw std::invalid_argument(fmt::format("{}: has {} bytes; use at most {}", field, text.size(), longest));
  return text;
}

Patient with_fields(const Patient& patient, const json& fields) {
  json all = parsed_again(patient_json(patient));
  all.merge_patch(fields);
  for (const char* computed : {"obstacles", "revision"}) all.erase(computed);
  all["record"] = patient.record;
  return parse_patient_json(all.dump(-1, ' ', false, json::error_handler_t::replace));
}

EnteredTest test_of(const json& object) {
  return parse_test_json(object.dump(-1, ' ', false, json::error_handler_t::replace));
}

}  // namespace phalanx::people
