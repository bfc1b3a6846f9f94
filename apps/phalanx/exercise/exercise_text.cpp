// SPDX-License-Identifier: Apache-2.0
#include "exercise/exercise_run_command.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <vector>

namespace phalanx {
namespace {

/// Formats the target beside what is reached: "1.2 of 2.0 N".
std::string target_text(const ExerciseView& view) {
  std::string text;
  if (view.value) text = fmt::format("{:.1f} {}", *view.value, view.value_unit);
  if (view.target.kind != ExerciseTarget::Kind::kForce) return text;
  return fmt::format("{}target {:.1f} to {:.1f} N", text.empty() ? "" : text + ", ", view.target.low,
                     view.target.high);
}

std::string score_line(const Score& score, const char* indent) {
  if (!score.valid()) return fmt::format("{}{:<34} {}\n", indent, score.name, score.invalid);
  return fmt::format("{}{:<34} {:>10.4g} {:<8} {}\n", indent, score.name, score.value, score.unit,
                     score_origin_name(score.origin));
}

std::string trial_lines(const ExerciseTrial& trial) {
  std::string text = fmt::format("    trial {}{}{}, {:.1f} to {:.1f} s{}\n", trial.number,
                                 trial.condition.empty() ? "" : ", ", trial.condition, trial.begin, trial.end,
                                 trial.success ? (*trial.success ? ", successful" : ", not successful") : "");
  if (!trial.invalid.empty()) text += fmt::format("      does not count: {}\n", trial.invalid);
  for (const Score& score : trial.scores) text += score_line(score, "      ");
  return text;
}

std::string begin_text(double utc) {
  return utc <= 0.0 ? std::string("unknown begin")
                    : fmt::format("{:%Y-%m-%d %H:%M:%S}Z", fmt::gmtime(static_cast<std::time_t>(utc)));
}

}  // namespace

std::string exercise_status(const ExerciseView& view, std::size_t width) {
  std::vector<std::string> parts;
  if (view.trial > 0) parts.push_back(fmt::format("trial {}/{}", view.trial, view.trials));
  parts.emplace_back(exercise_phase_name(view.phase));
  if (const std::string target = target_text(view); !target.empty()) parts.push_back(target);
  if (view.remaining_s > 0.0) parts.push_back(fmt::format("{:.0f} s", std::ceil(view.remaining_s)));
  if (view.counted > 0) parts.push_back(fmt::format("{} of {} successful", view.successes, view.counted));
  std::string line;
  for (const std::string& part : parts) {
    const std::size_t added = part.size() + (line.empty() ? 0 : 2);
    if (line.size() + added > width) break;
    line.append(line.empty() ? "" : "  ").append(part);
  }
  return line;
}

std::string exercise_report(const RecordedExercise& exercise, bool with_trials) {
  const ExerciseDescription& description = exercise.start.exercise;
  const ExerciseResult& result = exercise.result;
  std::string text = fmt::format(
      "{} ({}), {}{}\n  {}{}, {} trials, {:.0f} s\n", description.name, exercise_kind_name(description.kind),
      begin_text(exercise.begin_utc), exercise.start.simulated ? ", by a simulated participant" : "",
      result.interrupted ? "interrupted: " : "", result.ended, result.repetitions, result.seconds);
  if (!exercise.invalid.empty()) text += fmt::format("  {}\n", exercise.invalid);
  if (result.kind == ExerciseKind::kTraining)
    text += fmt::format("  {} of {} counted trials successful, difficulty {:.2f}\n", result.successes,
                        result.counted, result.difficulty.value_or(0.0));
  const bool proven = exercise.difference.empty() || exercise.other_program;
  if (exercise.invalid.empty() && !proven) text += "  not proven: it has no scores\n";
  if (exercise.invalid.empty() && proven) {
    for (const Score& score : result.scores) text += score_line(score, "  ");
    if (result.entry) text += fmt::format("  {}\n", result.entry->text);
    if (with_trials)
      for (const ExerciseTrial& trial : result.trials) text += trial_lines(trial);
  }
  if (!exercise.difference.empty())
    text += fmt::format("  the replay differs from the recorded result: {}\n", exercise.difference);
  else if (!exercise.recorded.empty())
    text += "  the replay gives the recorded result, byte for byte\n";
  return text;
}

}  // namespace phalanx
