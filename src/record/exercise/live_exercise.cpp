// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/live_exercise.h"

#include <fmt/format.h>

#include <utility>

#include "record/exercise/exercise_events.h"

namespace phalanx {

LiveExercise::LiveExercise(ExerciseStart start, int number, Write write)
    : start_(std::move(start)),
      number_(number),
      write_(std::move(write)),
      run_(start_.exercise, start_.person, start_.seed),
      view_(run_.view()),
      demand_(run_.demand()),
      done_(run_.done()) {}

void LiveExercise::step(const StepRecord& record) {
  const std::lock_guard working(run_mutex_);
  const bool first = tick_ == 0;
  station_ = record.station;
  tick_ = record.command.tick;
  if (first)
    write_(kExerciseBegin, begin_event_text({.place = {.number = number_, .station = station_, .tick = tick_},
                                             .start = start_}));
  take_inputs(station_, tick_);
  const Observation observation = observer_.observe(record);
  run_.step(observation);
  publish(observation);
  ++steps_;
  if (run_.done()) write_result();
}

/// Copies what other threads read. Only the exchange of the copies holds their lock.
void LiveExercise::publish(const std::optional<Observation>& observation) {
  ExerciseView view = run_.view();
  const ExerciseDemand demand = run_.demand();
  const std::lock_guard lock(mutex_);
  std::swap(view_, view);
  demand_ = demand;
  if (observation) newest_ = observation;
  done_ = run_.done();
}

/// Inputs take effect before the step, in their order. Refused ones are recorded, too: a replay refuses them again.
void LiveExercise::take_inputs(std::uint64_t station, std::uint64_t tick) {
  for (std::optional<ExerciseInput> next = next_input(); next; next = next_input()) {
    if (run_.done()) {
      refuse(fmt::format("{}: the exercise has ended", exercise_input_name(next->kind)));
      continue;
    }
    write_(kExerciseInput, input_event_text({.place = {.number = number_, .station = station, .tick = tick},
                                             .input = *next}));
    if (std::string refusal = run_.input(*next); !refusal.empty()) refuse(std::move(refusal));
  }
}

std::optional<ExerciseInput> LiveExercise::next_input() {
  const std::lock_guard lock(mutex_);
  if (inputs_.empty()) return std::nullopt;
  const ExerciseInput next = inputs_.front();
  inputs_.pop_front();
  return next;
}

void LiveExercise::refuse(std::string refusal) {
  const std::lock_guard lock(mutex_);
  refusals_.push_back(std::move(refusal));
}

void LiveExercise::write_result() {
  if (std::exchange(written_, true)) return;
  write_(kExerciseResult,
         result_event_text({.number = number_, .text = exercise_result_text(run_.result())}));
}

void LiveExercise::finish() {
  const std::lock_guard working(run_mutex_);
  if (tick_ == 0) return;  // it never began
  if (!run_.done()) input({.kind = ExerciseInput::Kind::kAbort});
  take_inputs(station_, tick_ + 1);
  publish(std::nullopt);
  write_result();
}

void LiveExercise::input(const ExerciseInput& input) {
  const std::lock_guard lock(mutex_);
  inputs_.push_back(input);
}

std::vector<std::string> LiveExercise::take_refusals() {
  const std::lock_guard lock(mutex_);
  return std::exchange(refusals_, {});
}

ExerciseView LiveExercise::view() const {
  const std::lock_guard lock(mutex_);
  return view_;
}

ExerciseDemand LiveExercise::demand() const {
  const std::lock_guard lock(mutex_);
  return demand_;
}

ExerciseResult LiveExercise::result() const {
  const std::lock_guard working(run_mutex_);
  return run_.result();
}

std::optional<Observation> LiveExercise::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

}  // namespace phalanx
