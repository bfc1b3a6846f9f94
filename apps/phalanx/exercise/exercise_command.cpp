// SPDX-License-Identifier: Apache-2.0
// phalanx exercise: list, check, keys, run, results.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "commands.h"
#include "exercise/exercise_run_command.h"
#include "patient/registry_options.h"
#include "phalanx/exercise/reasons.h"
#include "phalanx/record/recorded_exercise.h"
#include "phalanx/scene/exercise_file.h"
#include "terminal/error_line.h"
#include "terminal/progress.h"
#include "usage.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

/// Options of the commands, beside those of `run`.
struct ExerciseCommandOptions {
  bool markdown = false;
  bool trials = false;
  bool json = false;
  bool quiet = false;
  std::vector<std::string> files;
  RegistryOptions registry;
};

int list_exercise_files(const ExerciseCommandOptions& o) {
  if (o.markdown) fmt::print("| exercise | kind | measures | scene | title |\n|---|---|---|---|---|\n");
  bool whole = true;
  for (const ExerciseInfo& info : list_exercises()) {
    if (!info.readable) {
      whole = false;
      print_error_line(fmt::format("phalanx exercise list: {}", info.title));
      continue;
    }
    const ExerciseDescription& exercise = info.exercise;
    if (o.markdown)
      fmt::print("| `{}` | {} | `{}` | `{}` | {} |\n", info.name, exercise_kind_name(exercise.kind),
                 exercise_measure_name(exercise.measure), exercise.scene, info.title);
    else
      fmt::print("{:<22} {:<11} {:<16} {}\n", info.name, exercise_kind_name(exercise.kind), exercise.scene,
                 info.title);
  }
  return whole ? kDone : kWrongInput;
}

int check_exercise_files(const ExerciseCommandOptions& o) {
  bool sound = true;
  for (const std::string& file : o.files) {
    const std::vector<std::string> problems = problems_of_exercise(file);
    sound = sound && problems.empty();
    if (problems.empty()) fmt::print("{}: sound\n", file);
    for (const std::string& problem : problems) print_error_line(problem);
  }
  return sound ? kDone : kWrongInput;
}

int print_exercise_keys(const ExerciseCommandOptions& o) {
  if (o.markdown) {
    fmt::print("{}", exercise_keys_markdown());
    return kDone;
  }
  for (const ExerciseKey& key : exercise_keys())
    fmt::print("{:<26} {:<10} {:<8} {:<22} {:<14} {}\n", key.path, key.type, key.unit, key.range,
               key.default_value, key.meaning);
  return kDone;
}

/// Prints what the recordings say of their exercises. @returns false if a result is not that of its recording
bool print_recording_results(const fs::path& file, const ExerciseCommandOptions& o,
                             const FindRecordingKey& find) {
  std::vector<RecordedExercise> exercises;
  {
    ProgressBar bar("replaying", !o.quiet && !o.json);
    exercises = recorded_exercises(
        file, find, [&](double part) { bar.show(static_cast<std::uint64_t>(1000.0 * part), 1000); });
  }
  bool same = true;
  for (const RecordedExercise& exercise : exercises) {
    same = same && exercise.difference.empty();
    const std::string why =
        !exercise.invalid.empty() ? exercise.invalid : reason_text<Reason::kNotProven>(exercise.difference);
    if (o.json)
      fmt::print("{}\n", exercise.proven() || exercise.other_program
                             ? exercise.text
                             : exercise_result_text(without_scores(exercise.result, why)));
    else
      fmt::print("{}", exercise_report(exercise, o.trials));
  }
  if (exercises.empty() && !o.json) fmt::print("{}: no exercise\n", file.string());
  return same;
}

int print_all_results(const ExerciseCommandOptions& o) {
  const FindRecordingKey find = recording_keys_of(o.registry);
  bool same = true;
  for (const std::string& file : o.files) {
    if (!fs::is_regular_file(file))
      throw std::invalid_argument(
          fmt::format("there is no recording {}; `phalanx session list` shows them", file));
    same = print_recording_results(file, o, find) && same;
  }
  return same ? kDone : kFailed;
}

}  // namespace

void add_exercise_command(CLI::App& app, Job& job) {
  CLI::App* exercise =
      app.add_subcommand("exercise", "Exercises and assessments: list, check, keys, run, results");
  exercise->require_subcommand(1);
  auto options = std::make_shared<ExerciseCommandOptions>();
  const auto add = [&](const char* name, const char* help, int (*work)(const ExerciseCommandOptions&)) {
    CLI::App* command = exercise->add_subcommand(name, help);
    command->callback([options, command, work, &job] {
      refuse_empty_values(*command);
      job = [options, work] { return with_registry_errors([&] { return work(*options); }); };
    });
    return command;
  };
  add("list", "List the exercises", list_exercise_files)
      ->add_flag("--markdown", options->markdown, "as a Markdown table");
  add("check", "Check exercise files, and that their scenes can be read", check_exercise_files)
      ->add_option("EXERCISE", options->files, "exercises: names or files")
      ->required();
  add("keys", "Explain the keys of an exercise file", print_exercise_keys)
      ->add_flag("--markdown", options->markdown, "as the Markdown table of docs/exercises.md");
  add_exercise_run(*exercise, job);
  CLI::App* shown =
      add("results", "Make the results of recordings again, and compare them with the recorded ones",
          print_all_results);
  shown->footer("Exit codes: 0 all results are the recorded ones, 1 some differ, 2 wrong usage or input.");
  shown->add_option("FILE", options->files, "recordings")->required();
  shown->add_flag("--trials", options->trials, "also each trial's scores");
  shown->add_flag("--json", options->json, "one JSON object a line");
  shown->add_flag("--quiet", options->quiet, "no progress bar");
  add_registry_options(*shown, options->registry);
}

}  // namespace phalanx
