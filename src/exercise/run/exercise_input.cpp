// SPDX-License-Identifier: Apache-2.0
// Inputs of a run as text.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "phalanx/core/nearest_name.h"
#include "phalanx/exercise/exercise_run.h"

namespace phalanx {
namespace {

using InputKind = ExerciseInput::Kind;

constexpr std::array<std::string_view, 9> kInputNames = {"begin",   "pause",  "resume", "skip",      "pain",
                                                         "fatigue", "answer", "abort",  "difficulty"};

bool has_number(InputKind kind) {
  return kind == InputKind::kPain || kind == InputKind::kFatigue || kind == InputKind::kAnswer ||
         kind == InputKind::kDifficulty;
}

}  // namespace

std::string_view exercise_phase_name(ExercisePhase phase) noexcept {
  switch (phase) {
    case ExercisePhase::kReady:
      return "ready";
    case ExercisePhase::kWarmUp:
      return "warm_up";
    case ExercisePhase::kRating:
      return "rating";
    case ExercisePhase::kRest:
      return "rest";
    case ExercisePhase::kTrial:
      return "trial";
    case ExercisePhase::kAnswer:
      return "answer";
    case ExercisePhase::kPaused:
      return "paused";
    case ExercisePhase::kDone:
      return "done";
  }
  return "done";
}

std::string_view exercise_input_name(ExerciseInput::Kind kind) noexcept {
  return kInputNames[static_cast<std::size_t>(kind)];
}

ExerciseInput parse_exercise_input(std::string_view text) {
  const std::string shown(text.substr(0, 60));
  const std::size_t blank = text.find(' ');
  const std::string_view name = text.substr(0, blank);
  std::size_t found = 0;
  while (found < kInputNames.size() && kInputNames[found] != name) ++found;
  if (found == kInputNames.size())
    throw ExerciseError(fmt::format("\"{}\": {}known are {}", shown, did_you_mean(name, kInputNames),
                                    fmt::join(kInputNames, ", ")));
  ExerciseInput input;
  input.kind = static_cast<InputKind>(found);
  if (!has_number(input.kind)) {
    if (blank != std::string_view::npos)
      throw ExerciseError(fmt::format("\"{}\": {} has no number; write it alone", shown, name));
    return input;
  }
  const std::string_view number = blank == std::string_view::npos ? "" : text.substr(blank + 1);
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), input.value);
  if (error != std::errc() || end != number.data() + number.size() || !std::isfinite(input.value))
    throw ExerciseError(fmt::format("\"{}\": write a number behind {}, as in \"{} 3\"", shown, name, name));
  return input;
}

std::string exercise_input_text(const ExerciseInput& input) {
  std::string text(exercise_input_name(input.kind));
  if (has_number(input.kind)) text.append(" ").append(shortest_text(input.value));
  return text;
}

}  // namespace phalanx
