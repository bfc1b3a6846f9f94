// SPDX-License-Identifier: Apache-2.0
// phalanx study: sweeps over any parameter of a scene, a device or a patient.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "phalanx/record/made.h"
#include "phalanx/record/output_file.h"
#include "phalanx/study/laboratory/outputs.h"
#include "phalanx/study/laboratory/report.h"
#include "phalanx/study/laboratory/run_study.h"
#include "phalanx/study/laboratory/scene_inputs.h"
#include "phalanx/study/laboratory/study_file.h"
#include "phalanx/study/trial_function.h"
#include "study_progress.h"
#include "terminal/error_line.h"
#include "terminal/progress.h"
#include "usage.h"

namespace phalanx {
namespace {

struct RunChoices {
  std::string file;
  std::string out;
  std::string shard;
  int jobs = 0;
  bool restart = false;
  bool quiet = false;
};

struct MergeChoices {
  std::vector<std::string> folders;
  std::string out;
};

void write_all(const std::filesystem::path& out, const Study& study,
               const std::vector<PointResult>& results) {
  const Made made = made_here();
  write_text_file(out / "report.html", study_report_html(study, results, made));
  write_study_outputs(out, study, results, made);  // summary.json is last: a folder with it is complete
}

std::string limit_text(const PointResult& result) {
  if (std::isnan(result.k_lim)) return result.stable ? "stable" : "not stable";
  if (result.k_lim == 0.0 && result.ends_in_invalid)
    return fmt::format("nothing is known: {} at the smallest stiffness", result.why_invalid);
  if (result.k_lim == 0.0) return "not stable at any stiffness of the grid";
  return fmt::format(
      "k_lim {}{:.6g} N/mm{}{}", result.at_least ? "at least " : "", result.k_lim / 1000.0,
      result.non_monotone ? ", not monotone" : "",
      result.ends_in_invalid ? fmt::format(", ends in an invalid run ({})", result.why_invalid) : "");
}

void print_results(const std::string& out, const Study& study, const std::vector<PointResult>& results) {
  constexpr std::size_t kMostLines = 60;
  for (std::size_t i = 0; i < std::min(results.size(), kMostLines); ++i)
    fmt::print("{}: {}\n", point_text(study, study_point(study, results[i].index)), limit_text(results[i]));
  if (results.size() > kMostLines) fmt::print("and {} more\n", results.size() - kMostLines);
  fmt::print("wrote    {}/study.csv, summary.json, report.html ({} points)\n", out, results.size());
}

/// Reports the expected amount of work, before it starts, without subtracting finished points of a journal.
void announce(const Study& study, const StudyOptions& options) {
  constexpr double kTrialSeconds = 0.05;  // time of one core: 5.3 s at 100 times real time
  const double trials = static_cast<double>(most_trials(study).all) / options.shard.count;
  const double busy = trials * kTrialSeconds;
  const double seconds = options.jobs > 0 ? std::max(1.0, busy / options.jobs) : on_all_cores(busy);
  print_aside(fmt::format("study: {} points, at most {:.0f} trials, at most about {}\n", point_count(study),
                          trials, duration_text(seconds)));
}

int run(const RunChoices& choices) {
  const Study study = load_study(choices.file);
  StudyOptions options{.jobs = choices.jobs,
                       .shard = choices.shard.empty() ? Shard{} : parse_shard(choices.shard),
                       .restart = choices.restart,
                       .commit = program_version(),
                       .progress = {}};
  std::vector<PointResult> results;
  {
    StudyProgressLine line(!choices.quiet);
    bool announced = choices.quiet;
    options.progress = [&](const StudyProgress& progress) {
      if (!std::exchange(announced, true)) announce(study, options);
      line.show(progress);
    };
    // The only place where the laboratory uses the closed loop.
    const TrialFunction trial = make_trial_function(scene_of(study));
    results = run_study(study, scene_check(study), trial, choices.out, options);
  }
  if (options.shard.count > 1) {
    if (!choices.quiet)
      fmt::print(
          "wrote    shard {} ({} points) into {}; when all are there: phalanx study merge DIR... --out DIR\n",
          choices.shard, results.size(), choices.out);
    return kDone;
  }
  write_all(choices.out, study, results);
  if (!choices.quiet) print_results(choices.out, study, results);
  return kDone;
}

int merge(const MergeChoices& choices) {
  const MergedStudy merged = merge_studies({choices.folders.begin(), choices.folders.end()}, choices.out);
  write_all(choices.out, merged.study, merged.results);
  print_results(choices.out, merged.study, merged.results);
  return kDone;
}

int check(const std::string& file) {
  const Study study = load_study(file);
  static_cast<void>(check_study(study, scene_check(study)));
  for (int index = 0; index < point_count(study); ++index)
    fmt::print("{:5}  {}\n", index, point_text(study, study_point(study, index)));
  const TrialEstimate estimate = most_trials(study);
  fmt::print(
      "{}: {} points of {} seeds; at most {} trials a point and {} in all, more only where stability is not "
      "monotone\n",
      study.name, point_count(study), study.seeds, estimate.per_point, estimate.all);
  return kDone;
}

void add_merge(CLI::App& study, Job& job) {
  auto choices = std::make_shared<MergeChoices>();
  CLI::App* command = study.add_subcommand("merge", "Put the shards of a study together");
  command->add_option("DIR", choices->folders, "the --out folders of the shards")->required()->type_name("");
  command->add_option("--out", choices->out, "where the whole goes")->required()->type_name("DIR");
  command->callback([choices, command, &job] {
    refuse_empty_values(*command);
    job = [choices] { return merge(*choices); };
  });
}

void add_check(CLI::App& study, Job& job) {
  auto file = std::make_shared<std::string>();
  CLI::App* command = study.add_subcommand("check", "Read a study, check its points and say how much it is");
  command->add_option("FILE", *file, "the study file")->required()->type_name("");
  command->callback([file, command, &job] {
    refuse_empty_values(*command);
    job = [file] { return check(*file); };
  });
}

}  // namespace

void add_study_command(CLI::App& app, Job& job) {
  auto choices = std::make_shared<RunChoices>();
  CLI::App* command =
      app.add_subcommand("study", "Which stabiliser, at which setting, on my device? Sweeps in closed loop");
  command->footer(
      "The same command takes a study up where it was stopped, by whatever means. The file's form: "
      "docs/cli.md.\n"
      "Exit codes: 0 done, 1 failed, 2 wrong usage or input.");
  command->require_subcommand(0, 1);
  command->add_option("FILE", choices->file, "the study file (.toml)")->type_name("");
  command->add_option("--out", choices->out, "the folder of its journal and results")->type_name("DIR");
  command->add_option("--jobs", choices->jobs, "threads [as many as there are cores]")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  command->add_option("--shard", choices->shard, "measure only every n-th point, from the i-th on")
      ->type_name("i/n");
  command->add_flag("--restart", choices->restart, "throw away what the journal in --out holds");
  command->add_flag("--quiet", choices->quiet, "print nothing but errors");
  add_merge(*command, job);
  add_check(*command, job);
  command->callback([choices, command, &job] {
    if (!command->get_subcommands().empty()) return;
    refuse_empty_values(*command);
    if (choices->file.empty())
      throw std::invalid_argument("study: name a study file, or see phalanx study --help");
    if (choices->out.empty())
      throw std::invalid_argument("study: name the folder for journal and results: --out DIR");
    job = [choices] { return run(*choices); };
  });
}

}  // namespace phalanx
