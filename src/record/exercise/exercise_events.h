// SPDX-License-Identifier: Apache-2.0
// The events of an exercise in a recording, as JSON.
#pragma once

#include <cstdint>
#include <string>

#include "phalanx/exercise/exercise_run.h"
#include "phalanx/record/recorded_exercise.h"

namespace phalanx {

inline constexpr const char* kExerciseBegin = "exercise_begin";
inline constexpr const char* kExerciseInput = "exercise_input";
inline constexpr const char* kExerciseResult = "exercise_result";

/// Step before which something took effect.
struct EventPlace {
  int number = 0;  ///< of the exercise in its recording
  std::uint64_t station = 0;
  std::uint64_t tick = 0;
  [[nodiscard]] bool operator==(const EventPlace&) const = default;
};

/// Event "exercise_begin": `place` is the first step that the exercise gets.
struct ExerciseBeginEvent {
  EventPlace place;
  ExerciseStart start;
};
/// Event "exercise_input". After the last step of a recording its tick is one more than that of the last step.
struct ExerciseInputEvent {
  EventPlace place;
  ExerciseInput input;
};
/// Event "exercise_result": exercise_result_text(), unchanged.
struct ExerciseResultEvent {
  int number = 0;
  std::string text;
};

[[nodiscard]] std::string begin_event_text(const ExerciseBeginEvent& event);
[[nodiscard]] std::string input_event_text(const ExerciseInputEvent& event);
[[nodiscard]] std::string result_event_text(const ExerciseResultEvent& event);

/// Reads an event's text. @throws std::runtime_error naming what cannot be read
[[nodiscard]] ExerciseBeginEvent read_begin_event(const std::string& text);
[[nodiscard]] ExerciseInputEvent read_input_event(const std::string& text);
[[nodiscard]] ExerciseResultEvent read_result_event(const std::string& text);

}  // namespace phalanx
