// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "phalanx/exercise/reasons.h"
#include "phalanx/record/hand_observer.h"
#include "phalanx/record/recorded_exercise.h"
#include "phalanx/record/replay.h"
#include "phalanx/record/replay_visitor.h"
#include "phalanx/recording.pb.h"
#include "record/exercise/exercise_events.h"
#include "record/recording/recording_messages.h"

namespace phalanx {
namespace {

/// An exercise of the file, before and while it is carried out again.
struct Pending {
  ExerciseBeginEvent begin;
  std::vector<ExerciseInputEvent> inputs;
  std::size_t next_input = 0;
  std::string recorded;
  std::optional<ExerciseRun> run;  ///< from its first step on
  HandObserver observer;
  double begin_utc = 0.0;
  bool ended = false;         ///< all its steps have been seen
  std::uint64_t missing = 0;  ///< steps while it ran
  std::uint64_t different = 0;
  std::string first_difference;
};

/// Events of the exercises of a recording, and the time of its steps.
struct ExerciseEvents {
  std::vector<Pending> exercises;
  double begin_utc = 0.0;  ///< of the first message [s since 1970]
};

Pending* find(std::vector<Pending>& exercises, int number) {
  const auto found = std::find_if(exercises.begin(), exercises.end(), [number](const Pending& exercise) {
    return exercise.begin.place.number == number;
  });
  return found == exercises.end() ? nullptr : &*found;
}

/// Adds an event. @throws std::runtime_error for one that is not of an exercise of the file
void add_event(const wire::Event& event, ExerciseEvents& out) {
  const auto known = [&out](int number) -> Pending& {
    Pending* exercise = find(out.exercises, number);
    if (exercise == nullptr)
      throw std::runtime_error(
          fmt::format("it has an event of exercise {}, whose beginning is missing", number));
    return *exercise;
  };
  if (event.code() == kExerciseBegin) {
    Pending exercise;
    exercise.begin = read_begin_event(event.text());
    if (find(out.exercises, exercise.begin.place.number) != nullptr)
      throw std::runtime_error(
          fmt::format("it has two exercises with the number {}", exercise.begin.place.number));
    out.exercises.push_back(std::move(exercise));
  } else if (event.code() == kExerciseInput) {
    const ExerciseInputEvent input = read_input_event(event.text());
    known(input.place.number).inputs.push_back(input);
  } else if (event.code() == kExerciseResult) {
    const ExerciseResultEvent result = read_result_event(event.text());
    known(result.number).recorded = result.text;
  }
}

/// Finds whether a recording has exercises, and reads their events. Steps are not parsed.
ExerciseEvents read_events(const std::filesystem::path& file, const FindRecordingKey& keys) {
  ExerciseEvents out;
  wire::Event event;
  for_each_message_of(
      file, {}, keys, [&](std::string_view schema, const mcap::Message& message, double /*time*/) {
        if (out.begin_utc == 0.0) out.begin_utc = 1e-9 * static_cast<double>(message.time);
        // The recorder writes these codes with an empty `who`; a marker has its sender's address there.
        if (schema != "phalanx.wire.Event" || !parsed(message, event) || !event.who().empty()) return;
        try {
          add_event(event, out);
        } catch (const std::exception& error) {
          throw std::runtime_error(fmt::format("{}: {}; replay it with the version that recorded it",
                                               file.string(), error.what()));
        }
      });
  return out;
}

/// Carries out the exercises of a recording while it is replayed.
class ExercisesAgain final : public ReplayVisitor {
 public:
  explicit ExercisesAgain(ExerciseEvents& events) : events_(events) {}

  void step(const StepRecord& record, std::span<const DeviceSample> /*samples*/, double time) override {
    const EventPlace here{.number = 0, .station = record.station, .tick = record.command.tick};
    for (Pending& exercise : events_.exercises) {
      if (exercise.ended) continue;
      if (!exercise.run && !begins(exercise, here, time)) continue;
      take_inputs(exercise, here);
      exercise.run->step(exercise.observer.observe(record));
      exercise.ended = exercise.run->done();
    }
  }
  void unknown_step(std::uint64_t station, std::uint64_t tick) override { missing(station, tick, tick); }
  void different(std::uint64_t /*station*/, std::uint64_t tick, const std::string& what) override {
    for (Pending& exercise : events_.exercises) {
      if (!exercise.run || exercise.ended) continue;
      if (exercise.different++ == 0) exercise.first_difference = fmt::format("step {}: {}", tick, what);
    }
  }
  void missing(std::uint64_t station, std::uint64_t first, std::uint64_t last) override {
    for (Pending& exercise : events_.exercises) {
      const EventPlace& begin = exercise.begin.place;
      const bool begins_within = begin.station == station && begin.tick >= first && begin.tick <= last;
      if (exercise.ended || (!exercise.run && !begins_within)) continue;
      exercise.missing += last - first + 1;
      exercise.observer.gap();
    }
  }

 private:
  /// Begins an exercise at its first step, or at the first one that is left of it.
  static bool begins_here(const Pending& exercise, const EventPlace& here) noexcept {
    const EventPlace& begin = exercise.begin.place;
    return here.station > begin.station || (here.station == begin.station && here.tick >= begin.tick);
  }

  bool begins(Pending& exercise, const EventPlace& here, double time) {
    if (!begins_here(exercise, here)) return false;
    const ExerciseStart& start = exercise.begin.start;
    exercise.run.emplace(start.exercise, start.person, start.seed);
    exercise.begin_utc = events_.begin_utc + time;
    return true;
  }

  static void take_inputs(Pending& exercise, const EventPlace& here) {
    for (; exercise.next_input < exercise.inputs.size(); ++exercise.next_input) {
      const ExerciseInputEvent& next = exercise.inputs[exercise.next_input];
      if (next.place.station > here.station ||
          (next.place.station == here.station && next.place.tick > here.tick))
        return;
      static_cast<void>(exercise.run->input(next.input));
    }
  }

  ExerciseEvents& events_;
};

/// Ends an exercise whose steps are over: inputs after the last step, and the abort of one that was not finished.
void end(Pending& exercise) {
  if (!exercise.run)
    exercise.run.emplace(exercise.begin.start.exercise, exercise.begin.start.person,
                         exercise.begin.start.seed);
  for (; exercise.next_input < exercise.inputs.size() && !exercise.run->done(); ++exercise.next_input)
    static_cast<void>(exercise.run->input(exercise.inputs[exercise.next_input].input));
  if (!exercise.run->done()) static_cast<void>(exercise.run->input({.kind = ExerciseInput::Kind::kAbort}));
}

std::string why_invalid(const Pending& exercise) {
  if (exercise.missing == 1) return reason_text<Reason::kOneStepMissingInRecording>();
  if (exercise.missing > 1) return reason_text<Reason::kStepsMissingInRecording>(exercise.missing);
  if (exercise.recorded.empty()) return reason_text<Reason::kRecordingEndsBefore>();
  return {};
}

std::string difference_of(const Pending& exercise, const std::string& text, const ReplayResult& replayed) {
  if (exercise.recorded.empty() || exercise.recorded == text) return {};
  const auto first =
      std::mismatch(exercise.recorded.begin(), exercise.recorded.end(), text.begin(), text.end());
  const auto at = static_cast<std::size_t>(first.first - exercise.recorded.begin());
  constexpr std::size_t kShown = 40;
  const std::size_t from = at > kShown / 2 ? at - kShown / 2 : 0;
  const std::string recorded = exercise.recorded.substr(from, kShown);
  const std::string now = from < text.size() ? text.substr(from, kShown) : std::string();
  if (exercise.missing == 1) return reason_text<Reason::kOtherResultOneMissing>(at, recorded, now);
  if (exercise.missing > 1)
    return reason_text<Reason::kOtherResultMissing>(exercise.missing, at, recorded, now);
  if (exercise.different > 0)
    return reason_text<Reason::kOtherResultBits>(exercise.different, exercise.first_difference, at, recorded,
                                                 now);
  if (replayed.other_version)
    return reason_text<Reason::kOtherResultVersion>(replayed.recorded_by, at, recorded, now);
  if (replayed.other_machine)
    return reason_text<Reason::kOtherResultMachine>(replayed.recorded_on, at, recorded, now);
  return reason_text<Reason::kOtherResult>(at, recorded, now);
}

}  // namespace

std::vector<RecordedExercise> recorded_exercises(const std::filesystem::path& file,
                                                 const FindRecordingKey& keys,
                                                 const std::function<void(double)>& on_progress) {
  ExerciseEvents events = read_events(file, keys);
  if (events.exercises.empty()) return {};
  ExercisesAgain again(events);
  const ReplayResult replayed = replay(file, on_progress, &again, keys);
  std::vector<RecordedExercise> out;
  for (Pending& exercise : events.exercises) {
    end(exercise);
    RecordedExercise& recorded = out.emplace_back();
    recorded.number = exercise.begin.place.number;
    recorded.start = std::move(exercise.begin.start);
    recorded.begin_utc = exercise.begin_utc;
    recorded.result = exercise.run->result();
    recorded.text = exercise_result_text(recorded.result);
    recorded.recorded = std::move(exercise.recorded);
    exercise.recorded = recorded.recorded;
    recorded.recorded_by = replayed.recorded_by;
    recorded.invalid = why_invalid(exercise);
    recorded.difference = difference_of(exercise, recorded.text, replayed);
    recorded.other_program = !recorded.difference.empty() && recorded.invalid.empty() &&
                             (replayed.other_version || replayed.other_machine) && exercise.missing == 0 &&
                             (replayed.other_version || exercise.different == 0);
  }
  return out;
}

ExerciseResult without_scores(ExerciseResult result, const std::string& why) {
  const auto invalidate = [&why](std::vector<Score>& scores) {
    for (Score& score : scores)
      if (score.invalid.empty()) score.invalid = why;
  };
  invalidate(result.scores);
  for (ExerciseTrial& trial : result.trials) {
    invalidate(trial.scores);
    if (trial.invalid.empty()) trial.invalid = why;
    trial.success.reset();
  }
  result.successes = 0;
  result.counted = 0;
  result.entry.reset();
  return result;
}

}  // namespace phalanx
