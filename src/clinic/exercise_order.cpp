// SPDX-License-Identifier: Apache-2.0
#include "clinic/exercise_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <exception>
#include <stdexcept>
#include <utility>

#include "phalanx/clinic/exercise_limits.h"
#include "phalanx/clinic/exercise_patient.h"
#include "phalanx/core/error_text.h"
#include "phalanx/exercise/reasons.h"
#include "phalanx/record/recordings.h"

namespace phalanx {
namespace {

/// Refuses a name that would be read as a path: pages name shipped exercises only.
void refuse_path(const std::string& exercise) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (!exercise.empty() && std::all_of(exercise.begin(), exercise.end(), plain)) return;
  throw std::invalid_argument("exercise: it is no name of an exercise; choose one of the list");
}

KnownPatient read_patient(Registry& registry, const Actor& actor, const ExerciseOrder& order,
                          const std::string& today) {
  Patient patient = registry.patient(actor, order.record);
  if (patient.record != order.record)
    throw std::invalid_argument("the patient is not named by the id of their records; reload the page");
  std::string typed = order.confirm;
  std::transform(typed.begin(), typed.end(), typed.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  refuse_other_code(patient, typed);
  std::vector<ResultRow> results = registry.results(actor, patient.record);
  return {.patient = std::move(patient), .results = std::move(results), .today = today};
}

/// @returns the result with its scores, or why it has none
ExerciseResult shown_result(const RecordedExercise& exercise) {
  if (!exercise.invalid.empty()) return without_scores(exercise.result, exercise.invalid);
  if (exercise.other_program) return read_exercise_result(exercise.recorded, exercise.start.exercise);
  if (exercise.difference.empty()) return exercise.result;
  return without_scores(exercise.result, reason_text<Reason::kNotProven>(exercise.difference));
}

/// Does what needs the registry, again as long as another program holds it.
template <class Work>
void until_free(Work work, const std::function<bool(const std::string& why)>& tries_again) {
  for (;;) {
    try {
      return work();
    } catch (const RegistryError& refused) {
      if (refused.fault() != RegistryFault::kBusy || !tries_again || !tries_again(refused.what())) throw;
    }
  }
}

}  // namespace

std::string without_code(const std::string& text, const std::string& code) {
  const auto of_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  std::string out;
  std::size_t from = 0;
  for (std::size_t at = code.empty() ? std::string::npos : text.find(code); at != std::string::npos;
       at = text.find(code, at + 1)) {
    const std::size_t end = at + code.size();
    if ((at > 0 && of_word(text[at - 1])) || (end < text.size() && of_word(text[end])) || at < from) continue;
    out.append(text, from, at - from).append("the patient");
    from = end;
  }
  return out.append(text, from);
}

FindRecordingKey PreparedExercise::keys() const {
  return [key = key](const std::string& id) -> std::optional<RecordingKey> {
    return id == key.id ? std::optional(key.key) : std::nullopt;
  };
}

StationOrder PreparedExercise::station(std::optional<HandSource> source, std::uint64_t recording) const {
  StationOrder order;
  order.scene = plan.start.exercise.scene;
  order.overrides = plan.overrides;
  order.source = source;
  order.calibration = plan.calibration;
  order.range = plan.range;
  order.always = true;
  order.stopped = true;
  order.recording = recording;
  return order;
}

PreparedExercise prepare_exercise(Registry& registry, const Actor& actor, const ExerciseOrder& order,
                                  ExercisePlace place, const ExerciseWords& say,
                                  const std::function<bool()>& ends) {
  refuse_path(order.exercise);
  if (!order.demo.empty() && !is_own_simulation(place.station.device))
    throw std::invalid_argument(
        fmt::format("demo: a simulated participant needs the simulated device, and this station has {}; "
                    "start another station for it",
                    place.station.device));
  PreparedExercise prepared;
  prepared.actor = actor;
  prepared.known = read_patient(registry, actor, order, place.today);
  const auto say_to_all = [&](const std::string& text) {
    say(without_code(text, prepared.known.patient.code));
  };
  take_up_left_recordings({.registry = registry, .actor = actor}, prepared.known, place.recordings,
                          say_to_all, ends);
  try {
    prepared.plan = plan_exercise({.exercise = order.exercise, .demo = order.demo, .seed = order.seed},
                                  place.station, &prepared.known);
    prepared.plan.methods = methods_of_calibration(prepared.plan.calibration);  // not on the owner's thread
  } catch (const ExerciseRefusal& refused) {
    throw std::invalid_argument(refused.on_page());
  }
  prepared.key = registry.recording_key(actor, order.record);
  return prepared;
}

KeptExercise keep_exercise(Registry& registry, const PreparedExercise& prepared,
                           const EndedRecording& recording, const std::optional<UnscoredExercise>& done,
                           const std::function<bool(const std::string& why)>& tries_again) {
  const ActingRegistry acting = {.registry = registry, .actor = prepared.actor};
  const std::string& record = prepared.known.patient.record;
  KeptExercise kept;
  const auto complain = [&kept](const std::string& text) {
    kept.trouble.append(kept.trouble.empty() ? "" : "; ").append(text);
  };
  const auto keep_at_least_dose = [&] {
    if (!done) return;
    try {
      until_free(
          [&] {
            if (keep_dose(acting, record, *done, recording.file, complain))
              complain("its dose is kept, without scores");
          },
          tries_again);
    } catch (const RegistryError& busy) {  // the program ends
      complain(fmt::format("the dose of this exercise is not in the registry: {}", busy.what()));
    }
  };
  const auto complain_of_result = [&](const std::string& why) {
    complain(fmt::format("{}. The recording {} is kept; `phalanx patient rebuild` makes the result again",
                         why, recording.file.filename().string()));
  };
  try {
    const FindRecordingKey keys = prepared.keys();
    if (!recording.whole) static_cast<void>(repair_recording(recording.file, keys));
    const std::vector<RecordedExercise> exercises = recorded_exercises(recording.file, keys);
    if (exercises.empty()) {
      keep_at_least_dose();
      complain("the exercise has not begun; it has no result");
      return kept;
    }
    until_free([&] { keep_results(acting, record, exercises, recording.file, complain); }, tries_again);
    kept.result = shown_result(exercises.back());
  } catch (const RegistryError& error) {
    complain_of_result(error.what());
    // A busy registry does not prevent the scores: the next exercise or `rebuild` adds them. A dose would hide them.
    if (error.fault() != RegistryFault::kBusy) keep_at_least_dose();
  } catch (const std::exception& error) {
    complain_of_result(error_text(error));
    keep_at_least_dose();
  }
  return kept;
}

}  // namespace phalanx
