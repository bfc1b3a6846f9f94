// SPDX-License-Identifier: Apache-2.0
// The recorded result of an exercise, read back from its text.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "phalanx/core/constants.h"
#include "phalanx/exercise/reasons.h"
#include "phalanx/record/recorded_exercise.h"

namespace phalanx {
namespace {

using RecordedJson = nlohmann::json;

std::string text_of(const RecordedJson& row, const char* key) { return row.value(key, std::string()); }

std::optional<double> number_of(const RecordedJson& row, const char* key) {
  if (!row.contains(key) || !row.at(key).is_number()) return std::nullopt;
  return row.at(key).get<double>();
}

std::vector<Score> scores_of(const RecordedJson& list) {
  std::vector<Score> scores;
  for (const RecordedJson& row : list) {
    Score& score = scores.emplace_back();
    score.name = row.at("name").get<std::string>();
    score.unit = row.at("unit").get<std::string>();
    score.value = number_of(row, "value").value_or(0.0);
    score.origin = row.at("origin").get<std::string>() == score_origin_name(ScoreOrigin::kMeasured)
                       ? ScoreOrigin::kMeasured
                       : ScoreOrigin::kRendered;
    score.invalid = text_of(row, "invalid");
    if (score.invalid.empty() && !row.contains("value"))
      score.invalid = reason_text<Reason::kNoRecordedValue>();
  }
  return scores;
}

ExerciseTrial trial_of(const RecordedJson& row) {
  ExerciseTrial trial;
  trial.number = row.at("number").get<int>();
  trial.begin = number_of(row, "begin_s").value_or(0.0);
  trial.end = number_of(row, "end_s").value_or(0.0);
  trial.difficulty = number_of(row, "difficulty");
  trial.condition = text_of(row, "condition");
  trial.target = number_of(row, "target");
  trial.tolerance = number_of(row, "tolerance");
  trial.rate_hz = number_of(row, "rate_hz");
  trial.scores = scores_of(row.at("scores"));
  trial.invalid = text_of(row, "invalid");
  if (row.contains("success")) trial.success = row.at("success").get<bool>();
  return trial;
}

}  // namespace

ExerciseResult read_exercise_result(const std::string& text, const ExerciseDescription& exercise) {
  try {
    const RecordedJson json = RecordedJson::parse(text);
    ExerciseResult result;
    result.name = json.at("name").get<std::string>();
    result.kind = exercise.kind;
    result.measure = exercise.measure;
    result.interrupted = json.at("interrupted").get<bool>();
    result.ended = json.at("ended").get<std::string>();
    result.seconds = json.at("seconds").get<double>();
    result.repetitions = json.at("repetitions").get<int>();
    result.successes = json.value("successes", 0);
    result.counted = json.value("counted", 0);
    result.difficulty = number_of(json, "difficulty");
    result.scores = scores_of(json.at("scores"));
    if (json.contains("entry")) {
      const RecordedJson& entry = json.at("entry");
      result.entry.emplace();
      result.entry->suitable = entry.at("suitable").get<bool>();
      result.entry->flexion = entry.at("flexion_deg").get<double>() * kDeg;
      result.entry->release = entry.at("release_deg").get<double>() * kDeg;
      result.entry->text = entry.at("text").get<std::string>();
    }
    for (const RecordedJson& row : json.at("ratings"))
      result.ratings.push_back(
          {.time = row.at("time_s").get<double>(),
           .kind = row.at("kind").get<std::string>() == exercise_input_name(ExerciseInput::Kind::kPain)
                       ? ExerciseInput::Kind::kPain
                       : ExerciseInput::Kind::kFatigue,
           .value = row.at("value").get<int>()});
    for (const RecordedJson& row : json.at("trials")) result.trials.push_back(trial_of(row));
    return result;
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("the recorded result cannot be read: {}", error.what()));
  }
}

}  // namespace phalanx
