// SPDX-License-Identifier: Apache-2.0
#include "serve/people_exercise.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "phalanx/core/index.h"
#include "record/plain_text.h"
#include "serve/people_json.h"

namespace phalanx::people {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestWord = 64;  // of a field [bytes]
constexpr double kMostRating = 10.0;

WebResponse no_host() {
  return words_response(
      404,
      "this station carries out no exercises; start it with --data FOLDER and recordings, and "
      "without --record off");
}
WebResponse other_method() { return words_response(405, "this address does not allow this method"); }

const char* stage_name(ExerciseStatus::Stage stage) noexcept {
  switch (stage) {
    case ExerciseStatus::Stage::kOpening:
      return "opening";
    case ExerciseStatus::Stage::kRunning:
      return "running";
    case ExerciseStatus::Stage::kClosing:
      return "closing";
    case ExerciseStatus::Stage::kEnded:
      return "ended";
    case ExerciseStatus::Stage::kNone:
      break;
  }
  return "none";
}

const char* target_name(ExerciseTarget::Kind kind) noexcept {
  using Kind = ExerciseTarget::Kind;
  switch (kind) {
    case Kind::kForce:
      return "force";
    case Kind::kAngle:
      return "angle";
    case Kind::kOpen:
      return "open";
    case Kind::kClose:
      return "close";
    case Kind::kSqueeze:
      return "squeeze";
    case Kind::kTouch:
      return "touch";
    case Kind::kExplore:
      return "explore";
    case Kind::kChoose:
      return "choose";
    case Kind::kNone:
      break;
  }
  return "none";
}

/// @returns the number, or null: JSON has no NaN
json finite(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json target_json(const ExerciseTarget& target) {
  json digits = json::array();
  for (int d = 0; d < kDigits; ++d)
    if (target.digits[idx(d)]) digits.push_back(digit_name(d));
  json out = {{"kind", target_name(target.kind)}, {"digits", digits}};
  if (target.kind == ExerciseTarget::Kind::kForce) {
    out["low"] = finite(target.low);
    out["high"] = finite(target.high);
  }
  return out;
}

json result_json(const ExerciseResult& result) {
  json scores = json::array();
  for (const Score& score : result.scores)
    scores.push_back({{"name", score.name},
                      {"unit", score.unit},
                      {"value", score.valid() ? finite(score.value) : json(nullptr)},
                      {"origin", score_origin_name(score.origin)},
                      {"invalid", as_utf8(score.invalid)}});
  return {{"scores", scores},
          {"names", score_names_json(result.scores)},
          {"ended", as_utf8(result.ended)},
          {"interrupted", result.interrupted},
          {"repetitions", result.repetitions},
          {"successes", result.successes},
          {"counted", result.counted},
          {"seconds", finite(result.seconds)},
          {"verdict", result.entry ? as_utf8(result.entry->text) : std::string()}};
}

json forces_json(const ExerciseStatus& status) {
  json forces = json::array();
  if (!status.newest || status.view.hides_scene) return forces;
  for (const double force : status.newest->force) forces.push_back(finite(force));
  return forces;
}

const char* asked_rating(const ExerciseView& view) noexcept {
  if (!view.asks) return "";
  return *view.asks == ExerciseInput::Kind::kPain ? "pain" : "fatigue";
}

/// @returns whole number of a field, or none if it is missing
/// @throws std::invalid_argument naming the field
std::optional<std::uint64_t> whole_number(const json& object, const char* field) {
  const auto found = object.find(field);
  if (found == object.end() || found->is_null()) return std::nullopt;
  if (!found->is_number_unsigned())
    throw std::invalid_argument(fmt::format("{}: write a whole number from 0 on", field));
  return found->get<std::uint64_t>();
}

ExerciseOrder order_of(const json& object, const std::string& record) {
  ExerciseOrder order;
  order.record = record;
  order.exercise = text_of(object, "exercise", kLongestWord);
  order.confirm = text_of(object, "confirm", kLongestWord);
  order.demo = text_of(object, "demo", kLongestWord);
  order.seed = whole_number(object, "seed");
  return order;
}

/// Runs what a host may refuse because of its state. @returns 409 with the words then
template <class Work>
WebResponse with_conflicts(Work work) {
  try {
    return work();
  } catch (const RegistryError&) {
    throw;
  } catch (const std::system_error&) {  // the disk
    throw;
  } catch (const std::runtime_error& refused) {
    return words_response(409, refused.what());
  }
}

/// @returns whole number of a field
/// @throws std::invalid_argument if it is missing
std::uint64_t needed_number(const json& object, const char* field) {
  if (const auto number = whole_number(object, field)) return *number;
  throw std::invalid_argument(fmt::format("{}: is missing; reload the page", field));
}

WebResponse take_input(ExerciseHost& host, const Actor& actor, const json& object) {
  const bool reset = text_of(object, "kind", kLongestWord) == "reset";
  const ExerciseInput input = reset ? ExerciseInput{} : exercise_input_of(object);
  InputOrigin origin = {.account = actor.account};
  if (!reset && input.kind == ExerciseInput::Kind::kResume) origin.stops = needed_number(object, "stops");
  if (needed_number(object, "number") != host.status().number)
    return words_response(409, "another exercise has begun since; look at it, then repeat the input");
  if (reset) {
    host.reset();
  } else {
    host.input(input, origin);
  }
  return json_response(json::object());
}

/// @returns name, meaning and remedy of the station's fault; null without one
json fault_json(Fault fault) {
  if (fault == Fault::kNone) return nullptr;
  return {{"name", fault_name(fault)}, {"meaning", fault_meaning(fault)}, {"remedy", fault_remedy(fault)}};
}

}  // namespace

json exercise_json(const ExerciseStatus& status) {
  const ExerciseView& view = status.view;
  json choices = json::array();
  for (const std::string& choice : view.choices) choices.push_back(as_utf8(choice));
  const ExerciseDescription& exercise = status.exercise;
  const bool known = status.number != 0;
  return {{"number", status.number},
          {"stage", stage_name(status.stage)},
          {"record", status.record},
          {"code", as_utf8(status.code)},
          {"symbol", status.symbol},
          {"side", status.side},
          {"name", as_utf8(exercise.name)},
          {"title", as_utf8(exercise.title)},
          {"title_de", as_utf8(exercise.title_de)},
          {"measure", known ? std::string(exercise_measure_name(exercise.measure)) : std::string()},
          {"kind", known ? std::string(exercise_kind_name(exercise.kind)) : std::string()},
          {"simulated", status.simulated},
          {"phase", exercise_phase_name(view.phase)},
          {"instruction", as_utf8(view.instruction)},
          {"note", as_utf8(view.note)},
          {"trial", view.trial},
          {"trials", view.trials},
          {"progress", finite(view.progress)},
          {"remaining_s", finite(view.remaining_s)},
          {"target", target_json(view.target)},
          {"value", view.value ? finite(*view.value) : json(nullptr)},
          {"value_unit", view.value_unit},
          {"choices", choices},
          {"asks", asked_rating(view)},
          {"successes", view.successes},
          {"counted", view.counted},
          {"last_success", status.last_success},
          {"force", forces_json(status)},
          {"forces_off", status.forces_off},
          {"fault", fault_json(status.fault)},
          {"stops", status.stops},
          {"trouble", as_utf8(status.trouble)},
          {"recording", status.recording},
          {"result", status.result ? result_json(*status.result) : json(nullptr)}};
}

json watched_exercise_json(const ExerciseStatus& status) {
  json out = exercise_json(status);
  for (const char* of_patient : {"record", "code", "symbol", "side", "recording", "result"})
    out.erase(of_patient);
  out["trouble"] = as_utf8(status.trouble_without_code);
  return out;
}

ExerciseInput exercise_input_of(const json& object) {
  std::string text = text_of(object, "kind", kLongestWord);
  const auto value = object.find("value");
  if (value != object.end() && !value->is_null()) {
    if (!value->is_number()) throw std::invalid_argument("value: write a number");
    text.append(fmt::format(" {}", value->get<double>()));
  }
  const ExerciseInput input = parse_exercise_input(text);
  const bool rating = input.kind == ExerciseInput::Kind::kPain || input.kind == ExerciseInput::Kind::kFatigue;
  // As it was written: above 10 a rating stops forces, and the exercise then refuses it.
  if (rating && (input.value < 0.0 || std::floor(input.value) != input.value))
    throw std::invalid_argument(fmt::format("value: {} is a whole number from 0 to {}",
                                            exercise_input_name(input.kind), kMostRating));
  return input;
}

void stop_at_once(ExerciseHost& host, const WebRequest& request) noexcept {
  if (request.path != kExercise && request.path != kWatchedExercise) return;
  if (request.method != "POST") return;
  try {
    const ExerciseInput input = exercise_input_of(read_object(request.body));
    const ExerciseStatus status = host.status();
    const RatingLimits& limits = status.exercise.ratings;
    const bool ends = input.kind == ExerciseInput::Kind::kAbort ||
                      (input.kind == ExerciseInput::Kind::kPain && input.value >= limits.pain) ||
                      (input.kind == ExerciseInput::Kind::kFatigue && input.value >= limits.fatigue);
    // While a rating is asked for there is no torque, and a pause would only have to be resumed.
    const bool stops =
        input.kind == ExerciseInput::Kind::kPause || (ends && status.view.phase != ExercisePhase::kRating);
    if (stops) host.input({.kind = ExerciseInput::Kind::kPause});
  } catch (const std::exception&) {  // the request's own answer states it
  }
}

WebResponse exercise_response(const RouteContext& context, const Actor& actor, const WebRequest& request) {
  if (context.host == nullptr) return no_host();
  if (request.method != "POST") return json_response(exercise_json(context.host->status()));
  return with_conflicts([&] { return take_input(*context.host, actor, read_object(request.body)); });
}

WebResponse watched_exercise_response(ExerciseHost* host, const Actor& actor, const WebRequest& request) {
  if (host == nullptr) return no_host();
  if (request.method != "POST") return json_response(watched_exercise_json(host->status()));
  const json object = read_object(request.body);
  const std::string kind = text_of(object, "kind", kLongestWord);
  if (kind != "pause" && kind != "pain" && kind != "fatigue")
    return words_response(401, "this page is locked: unlock it first; a pause and ratings work without that");
  return with_conflicts([&] { return take_input(*host, actor, object); });
}

std::optional<WebResponse> exercise_part(const RouteContext& context, const Actor& actor,
                                         const WebRequest& request, const std::string& record,
                                         std::string_view part) {
  if (part != "exercise") return std::nullopt;
  if (request.method != "POST") return other_method();
  if (context.host == nullptr) return no_host();
  return with_conflicts([&] {
    const ExerciseOrder order = order_of(read_object(request.body), record);
    return json_response({{"number", context.host->begin(actor, order)}});
  });
}

}  // namespace phalanx::people
