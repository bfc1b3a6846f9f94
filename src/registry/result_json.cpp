// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "phalanx/registry/result.h"
#include "registry/json_fields.h"

namespace phalanx {
namespace {

using nlohmann::json;

json score_object(const Score& score) {
  json out = {{"name", score.name}, {"unit", score.unit}, {"origin", score_origin_name(score.origin)}};
  if (score.valid())
    out["value"] = score.value;
  else
    out["invalid"] = score.invalid;
  return out;
}

Score parse_score(const json& object) {
  registry::JsonFields fields(object, "score");
  Score out;
  std::string origin = "measured";
  fields.read("name", out.name);
  fields.read("unit", out.unit);
  fields.read("origin", origin);
  if (origin != "measured" && origin != "rendered")
    throw std::invalid_argument(fmt::format("score: the origin \"{}\" must be measured or rendered", origin));
  out.origin = origin == "rendered" ? ScoreOrigin::kRendered : ScoreOrigin::kMeasured;
  fields.read("value", out.value);
  fields.read("invalid", out.invalid);
  fields.finish();
  return out;
}

ResultConditions parse_conditions(const json& object) {
  registry::JsonFields fields(object, "conditions");
  ResultConditions out;
  fields.read("device", out.device);
  fields.read("serial", out.serial);
  fields.read("calibration_method", out.calibration_method);
  fields.read("contact_mode", out.contact_mode);
  fields.read("stabiliser", out.stabiliser);
  fields.read("rendering", out.rendering);
  fields.read("protocol", out.protocol);
  fields.finish();
  return out;
}

}  // namespace

std::string result_json(const ResultRow& row) {
  json out = {{"recording", row.recording},
              {"number", row.number},
              {"exercise", row.exercise},
              {"assessment", row.assessment},
              {"date", row.date},
              {"scores", json::array()},
              {"conditions",
               {{"device", row.conditions.device},
                {"serial", row.conditions.serial},
                {"calibration_method", row.conditions.calibration_method},
                {"contact_mode", row.conditions.contact_mode},
                {"stabiliser", row.conditions.stabiliser},
                {"rendering", row.conditions.rendering},
                {"protocol", row.conditions.protocol}}},
              {"interrupted", row.interrupted},
              {"valid", row.valid},
              {"invalid", row.invalid},
              {"seconds", row.seconds},
              {"repetitions", row.repetitions},
              {"successes", row.successes},
              {"difficulty", row.difficulty},
              {"pain", row.pain},
              {"fatigue", row.fatigue},
              {"detail", row.detail}};
  for (const Score& score : row.scores) out["scores"].push_back(score_object(score));
  return registry::json_line(out, "result");
}

ResultRow parse_result_json(std::string_view text) {
  registry::JsonFields fields(text, "result");
  ResultRow out;
  fields.read("recording", out.recording);
  fields.read("number", out.number);
  fields.read("exercise", out.exercise);
  fields.read("assessment", out.assessment);
  fields.read("date", out.date);
  fields.read_with("scores", [&](const json& scores) {
    if (!scores.is_array()) throw std::invalid_argument("result: the scores are no list");
    for (const json& score : scores) out.scores.push_back(parse_score(score));
  });
  fields.read_with("conditions", [&](const json& object) { out.conditions = parse_conditions(object); });
  fields.read("interrupted", out.interrupted);
  fields.read("valid", out.valid);
  fields.read("invalid", out.invalid);
  fields.read("seconds", out.seconds);
  fields.read("repetitions", out.repetitions);
  fields.read("successes", out.successes);
  fields.read("difficulty", out.difficulty);
  fields.read("pain", out.pain);
  fields.read("fatigue", out.fatigue);
  fields.read("detail", out.detail);
  fields.finish();
  return out;
}

std::string test_json(const EnteredTest& test) {
  return registry::json_line({{"kind", test_kind(test.kind).name},
                              {"value", test.value},
                              {"unit", test_kind(test.kind).unit},
                              {"side", test_side_name(test.side)},
                              {"date", test.date},
                              {"rater", test.rater},
                              {"note", test.note}},
                             "test");
}

EnteredTest parse_test_json(std::string_view text) {
  registry::JsonFields fields(text, "test");
  EnteredTest out;
  std::string kind;
  std::string unit;
  std::string side = "more_affected";
  fields.read("kind", kind);
  out.kind = test_kind(std::string_view(kind)).kind;
  fields.read("unit", unit);
  if (!unit.empty() && unit != test_kind(out.kind).unit)
    throw std::invalid_argument(
        fmt::format("test: the unit of {} is {}, not \"{}\"", kind, test_kind(out.kind).unit, unit));
  fields.read("value", out.value);
  fields.read("side", side);
  if (side != "more_affected" && side != "less_affected")
    throw std::invalid_argument(
        fmt::format("test: the side \"{}\" must be more_affected or less_affected", side));
  out.side = side == "less_affected" ? TestSide::kLessAffected : TestSide::kMoreAffected;
  fields.read("date", out.date);
  fields.read("rater", out.rater);
  fields.read("note", out.note);
  fields.finish();
  return out;
}

std::string note_json(const PatientNote& note) {
  return registry::json_line({{"date", note.date}, {"account", note.account}, {"text", note.text}}, "note");
}

PatientNote parse_note_json(std::string_view text) {
  registry::JsonFields fields(text, "note");
  PatientNote out;
  fields.read("date", out.date);
  fields.read("account", out.account);
  fields.read("text", out.text);
  fields.finish();
  return out;
}

}  // namespace phalanx
