// SPDX-License-Identifier: Apache-2.0
// The result of a run as canonical JSON, and what a person's limits take from it.
#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/exercise/exercise_run.h"

namespace phalanx {
namespace {

using ResultJson = nlohmann::ordered_json;

ResultJson json_of(const std::vector<Score>& scores) {
  ResultJson list = ResultJson::array();
  for (const Score& score : scores) {
    ResultJson row;
    row["name"] = score.name;
    row["unit"] = score.unit;
    if (score.valid()) row["value"] = score.value;
    row["origin"] = score_origin_name(score.origin);
    if (!score.valid()) row["invalid"] = score.invalid;
    list.push_back(std::move(row));
  }
  return list;
}

void add_number(ResultJson& row, const char* key, const std::optional<double>& value) {
  if (value) row[key] = *value;
}

ResultJson json_of(const ExerciseTrial& trial) {
  ResultJson row;
  row["number"] = trial.number;
  row["begin_s"] = trial.begin;
  row["end_s"] = trial.end;
  add_number(row, "difficulty", trial.difficulty);
  if (!trial.condition.empty()) row["condition"] = trial.condition;
  add_number(row, "target", trial.target);
  add_number(row, "tolerance", trial.tolerance);
  add_number(row, "rate_hz", trial.rate_hz);
  row["scores"] = json_of(trial.scores);
  if (!trial.invalid.empty()) row["invalid"] = trial.invalid;
  if (trial.success) row["success"] = *trial.success;
  return row;
}

const Score* valid_score(const ExerciseResult& result, const std::string& name) {
  const auto found = std::find_if(result.scores.begin(), result.scores.end(),
                                  [&](const Score& score) { return score.valid() && score.name == name; });
  return found == result.scores.end() ? nullptr : &*found;
}

}  // namespace

std::string exercise_result_text(const ExerciseResult& result) {
  ResultJson json;
  json["name"] = result.name;
  json["kind"] = exercise_kind_name(result.kind);
  json["measure"] = exercise_measure_name(result.measure);
  json["interrupted"] = result.interrupted;
  json["ended"] = result.ended;
  json["seconds"] = result.seconds;
  json["repetitions"] = result.repetitions;
  if (result.kind == ExerciseKind::kTraining) {
    json["successes"] = result.successes;
    json["counted"] = result.counted;
    add_number(json, "difficulty", result.difficulty);
  }
  json["scores"] = json_of(result.scores);
  if (result.entry) {
    ResultJson entry;
    entry["suitable"] = result.entry->suitable;
    entry["flexion_deg"] = result.entry->flexion * kRadToDeg;
    entry["release_deg"] = result.entry->release * kRadToDeg;
    entry["text"] = result.entry->text;
    json["entry"] = std::move(entry);
  }
  json["ratings"] = ResultJson::array();
  for (const ExerciseRating& rating : result.ratings) {
    ResultJson row;
    row["time_s"] = rating.time;
    row["kind"] = exercise_input_name(rating.kind);
    row["value"] = rating.value;
    json["ratings"].push_back(std::move(row));
  }
  json["trials"] = ResultJson::array();
  for (const ExerciseTrial& trial : result.trials) json["trials"].push_back(json_of(trial));
  return json.dump(-1, ' ', false, ResultJson::error_handler_t::replace);
}

PersonLimits with_measured(PersonLimits person, const ExerciseResult& result) {
  if (result.measure == ExerciseMeasure::kOwnForce) {
    for (int digit = 0; digit < kDigits; ++digit)
      if (const Score* score = valid_score(result, fmt::format("{}_peak_force_n", digit_name(digit))))
        person.own_force[idx(digit)] = score->value;
  } else if (result.measure == ExerciseMeasure::kRangeOfMotion) {
    for (int joint = 0; joint < kJoints; ++joint) {
      const Score* least = valid_score(result, fmt::format("min_{}_deg", joint_name(joint)));
      const Score* most = valid_score(result, fmt::format("max_{}_deg", joint_name(joint)));
      if (least != nullptr && most != nullptr && least->value <= most->value)
        person.own_range[idx(joint)] = OwnRange{.min = least->value * kDeg, .max = most->value * kDeg};
    }
  }
  return person;
}

}  // namespace phalanx
