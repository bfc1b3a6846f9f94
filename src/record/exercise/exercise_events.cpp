// SPDX-License-Identifier: Apache-2.0
#include "record/exercise/exercise_events.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "phalanx/scene/exercise_file.h"

namespace phalanx {
namespace {

using Json = nlohmann::ordered_json;

Json place_json(const EventPlace& place) {
  return {{"exercise", place.number}, {"station", place.station}, {"tick", place.tick}};
}

EventPlace read_place(const Json& json) {
  return {.number = json.at("exercise").get<int>(),
          .station = json.at("station").get<std::uint64_t>(),
          .tick = json.at("tick").get<std::uint64_t>()};
}

/// Runs what reads an event. @throws std::runtime_error naming the event
template <class Read>
auto read_event(const char* code, const std::string& text, const Read& read) {
  try {
    return read(Json::parse(text));
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("the event {} cannot be read: {}", code, error.what()));
  }
}

}  // namespace

std::string begin_event_text(const ExerciseBeginEvent& event) {
  Json json = place_json(event.place);
  json["file"] = exercise_text(event.start.exercise);
  json["name"] = event.start.exercise.name;
  json["person"] = person_limits_text(event.start.person);
  json["seed"] = std::to_string(event.start.seed);  // readers of JSON may round integers beyond 2^53
  json["record"] = event.start.record;
  json["participant"] = event.start.simulated ? "simulated" : "person";
  json["conditions"] = Json::object();
  for (const auto& [key, value] : event.start.conditions) json["conditions"][key] = value;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string input_event_text(const ExerciseInputEvent& event) {
  Json json = place_json(event.place);
  json["input"] = exercise_input_text(event.input);
  return json.dump();
}

std::string result_event_text(const ExerciseResultEvent& event) {
  // The result stands as it is: its bytes are compared.
  return fmt::format("{{\"exercise\":{},\"result\":{}}}", event.number, event.text);
}

ExerciseBeginEvent read_begin_event(const std::string& text) {
  return read_event(kExerciseBegin, text, [](const Json& json) {
    ExerciseBeginEvent event;
    event.place = read_place(json);
    event.start.exercise = parse_exercise(json.at("file").get<std::string>(), "the recording's exercise");
    event.start.exercise.name = json.at("name").get<std::string>();
    event.start.person = parse_person_limits(json.at("person").get<std::string>(), "the recording's limits");
    event.start.seed = std::stoull(json.at("seed").get<std::string>());
    event.start.record = json.at("record").get<std::string>();
    event.start.simulated = json.at("participant").get<std::string>() != "person";
    for (const auto& [key, value] : json.at("conditions").items())
      event.start.conditions[key] = value.get<std::string>();
    return event;
  });
}

ExerciseInputEvent read_input_event(const std::string& text) {
  return read_event(kExerciseInput, text, [](const Json& json) {
    return ExerciseInputEvent{.place = read_place(json),
                              .input = parse_exercise_input(json.at("input").get<std::string>())};
  });
}

ExerciseResultEvent read_result_event(const std::string& text) {
  return read_event(kExerciseResult, text, [&text](const Json& json) {
    const int number = json.at("exercise").get<int>();
    const std::string before = result_event_text({.number = number, .text = {}});
    const std::size_t head = before.size() - 1;  // all but the last brace
    if (!json.contains("result") || text.size() <= before.size() ||
        text.compare(0, head, before, 0, head) != 0)
      throw std::runtime_error("it holds no result");
    return ExerciseResultEvent{.number = number, .text = text.substr(head, text.size() - before.size())};
  });
}

}  // namespace phalanx
