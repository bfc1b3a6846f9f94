// SPDX-License-Identifier: Apache-2.0
// phalanx study: sweeps over any parameter of a scene, a device or a patient.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
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
#include "phalanx/study/queue.h"
#include "phalanx/study/trial_function.h"
#include "study_progress.h"
#include "terminal/end_signals.h"
#include "terminal/error_line.h"
#include "terminal/progress.h"
#include "usage.h"

namespace phalanx {
namespace {

struct RunChoices {
  std::string file;
  std::string out;
  std::string shard;
  std::string queue;
  double lease_s = QueueRunOptions{}.lease_s;
  int jobs = 0;
  bool restart = false;
  bool retry = false;
  bool quiet = false;
};

struct WorkChoices {
  std::string file;
  std::string queue;
  double limit_s = QueueWorkOptions{}.limit_s;
  int jobs = 0;
  bool quiet = false;
};

struct MergeChoices {
  std::vector<std::string> folders;
  std::string out;
};

/// @param processors  those that measured; empty: this machine's
Made made_on(const std::string& processors) {
  Made made = made_here();
  if (!processors.empty()) made.cpu = processors;
  return made;
}

void write_all(const std::filesystem::path& out, const Study& study, const std::vector<PointResult>& results,
               const Made& made = made_here()) {
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

/// Begins a line of its own where a terminal shows progress in place.
void print_line(const std::string& sentence) {
  print_aside(fmt::format("{}phalanx study: {}\n", ::isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "", sentence));
}

/// The check of a large study takes minutes.
StudyCheck check_until_asked_to_end(const Study& study) {
  return [check = scene_check(study)](const Overrides& overrides) {
    if (asked_to_end != 0)
      throw std::runtime_error("stopped while the points were checked; nothing was begun");
    return check(overrides);
  };
}

QueueServer server_of(const std::string& url) {
  return {.url = url, .stopped = [] { return asked_to_end != 0; }, .tell = print_line};
}

std::filesystem::path log_of_point(const std::string& out, int index) {
  return std::filesystem::path(out) / fmt::format("point-{}.log", index);
}

/// Writes the logs of quarantined points to point-INDEX.log, and names the first few.
void report_quarantined(const std::string& out, const Study& study, const QueuedResults& queued) {
  constexpr std::size_t kMostLines = 10;
  for (std::size_t i = 0; i < queued.quarantined.size(); ++i) {
    const auto& [index, log] = queued.quarantined[i];
    write_text_file(log_of_point(out, index), log + "\n");
    if (i < kMostLines)
      print_line(fmt::format("point {} ({}) failed {} times, first {}; see {}", index,
                             point_text(study, study_point(study, index)), kFailuresToQuarantine,
                             log.substr(0, log.find('\n')), log_of_point(out, index).string()));
  }
  if (queued.quarantined_points > static_cast<int>(kMostLines))
    print_line(fmt::format("and {} more", queued.quarantined_points - static_cast<int>(kMostLines)));
}

void remove_logs_of_points(const std::string& out, const std::vector<PointResult>& finished) {
  for (const PointResult& result : finished) std::filesystem::remove(log_of_point(out, result.index));
}

int run_in_queue(const RunChoices& choices) {
  if (choices.jobs != 0 || !choices.shard.empty())
    throw std::invalid_argument(
        "study run: --jobs and --shard do not go together with --queue, whose points phalanx study work "
        "measures");
  const Study study = load_study(choices.file);
  end_on_interrupt(true);
  QueuedResults queued;
  {
    StudyProgressLine line(!choices.quiet);
    QueueRunOptions options{
        .commit = program_version(),
        .lease_s = choices.lease_s,
        .restart = choices.restart,
        .retry = choices.retry,
        .progress = [&](const StudyProgress& progress) { line.show(progress); },
        .page =
            [&](const std::vector<PointResult>& results, const StudyProgress& progress) {
              write_text_file(std::filesystem::path(choices.out) / "report.html",
                              study_report_html(study, results, made_here(), study_progress_text(progress)));
            }};
    queued =
        run_on_queue(study, check_until_asked_to_end(study), choices.out, server_of(choices.queue), options);
  }
  remove_logs_of_points(choices.out, queued.results);
  if (queued.whole) {
    write_all(choices.out, study, queued.results, made_on(queued.processors));
    if (!choices.quiet) print_results(choices.out, study, queued.results);
    return kDone;
  }
  write_text_file(std::filesystem::path(choices.out) / "report.html",
                  study_report_html(study, queued.results, made_on(queued.processors)));
  report_quarantined(choices.out, study, queued);
  if (static_cast<int>(queued.results.size()) + queued.quarantined_points == point_count(study))
    throw std::runtime_error(fmt::format(
        "{} of {} points are quarantined; the others are in {}. When the cause is mended: the same "
        "command {} --retry",
        queued.quarantined_points, point_count(study), choices.out,
        choices.restart ? "without --restart and with" : "with"));
  throw std::runtime_error(  // --restart would begin it once more
      fmt::format("stopped with {} of {} points; workers go on, and the same command{} goes on collecting",
                  queued.results.size(), point_count(study), choices.restart ? " without --restart" : ""));
}

/// Shows number and pace of the points that this worker has measured: in place on a terminal, otherwise in a line each
/// minute.
class FinishedLine {
 public:
  void show(int done, double points_per_s) {
    constexpr auto kPause = std::chrono::minutes(1);
    const auto now = std::chrono::steady_clock::now();
    const bool terminal = ::isatty(STDERR_FILENO) == 1;
    if (!terminal && now < next_) return;
    next_ = now + kPause;
    const std::string pace = std::isnan(points_per_s) ? "" : fmt::format(", {:.3g} points/s", points_per_s);
    print_aside(fmt::format("{}points measured: {}{}{}", terminal ? "\r\033[K" : "", done, pace,
                            terminal ? "" : "\n"));
  }

 private:
  std::chrono::steady_clock::time_point next_;
};

int work(const WorkChoices& choices) {
  const Study study = load_study(choices.file);
  end_on_interrupt(true);
  QueueWorkOptions options{.commit = program_version(), .jobs = choices.jobs, .limit_s = choices.limit_s};
  FinishedLine line;
  if (!choices.quiet)
    options.finished = [&](int done, double points_per_s) { line.show(done, points_per_s); };
  const QueueServer server = server_of(choices.queue);
  const QueueWork work = work_on_queue(study, check_until_asked_to_end(study),
                                       make_trial_function(scene_of(study)), server, options);
  if (!choices.quiet) {
    if (::isatty(STDERR_FILENO) == 1) print_aside("\r\033[K");
    fmt::print("{} points measured, {} failures; {}\n", work.finished, work.failed,
               work.whole ? "no point is left"
               : work.given_back
                   ? "stopped, what was not measured is given back"
                   : "stopped while the server is away: what was not measured is free when its lease ends");
  }
  return kDone;
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

void add_run_options(CLI::App& command, RunChoices& choices) {
  command.add_option("--out", choices.out, "the folder of its journal and results")->type_name("DIR");
  command.add_option("--jobs", choices.jobs, "threads [as many as there are cores]")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  command.add_option("--shard", choices.shard, "measure only every n-th point, from the i-th on")
      ->type_name("i/n");
  command.add_flag("--restart", choices.restart, "throw away what the journal in --out holds");
  command.add_flag("--quiet", choices.quiet, "print nothing but errors");
}

void refuse_missing_out(const RunChoices& choices) {
  if (choices.out.empty())
    throw std::invalid_argument("study: name the folder for journal and results: --out DIR");
}

void add_run(CLI::App& study, Job& job) {
  auto choices = std::make_shared<RunChoices>();
  CLI::App* command = study.add_subcommand("run", "Measure a study, here or by workers on a queue");
  command->add_option("FILE", choices->file, "the study file (.toml)")->required()->type_name("");
  command
      ->add_option("--queue", choices->queue,
                   "put the points into a database of PostgreSQL; no password in it")
      ->type_name("URL");
  command
      ->add_option("--lease", choices->lease_s,
                   "seconds for which a taken point is its worker's unless that renews it")
      ->check(CLI::Range(1.0, 86400.0))
      ->capture_default_str()
      ->type_name("S");
  command->add_flag("--retry", choices->retry, "try quarantined points again");
  add_run_options(*command, *choices);
  command->callback([choices, command, &job] {
    refuse_empty_values(*command);
    refuse_missing_out(*choices);
    if (choices->queue.empty() && (choices->retry || command->count("--lease") > 0))
      throw std::invalid_argument("study run: --lease and --retry are of a queue; name it: --queue URL");
    job = [choices] { return choices->queue.empty() ? run(*choices) : run_in_queue(*choices); };
  });
}

void add_work(CLI::App& study, Job& job) {
  auto choices = std::make_shared<WorkChoices>();
  CLI::App* command = study.add_subcommand("work", "Measure points of a study that is in a queue");
  command->add_option("FILE", choices->file, "the study file (.toml), as it was given to study run")
      ->required()
      ->type_name("");
  command->add_option("--queue", choices->queue, "the database of PostgreSQL; no password in it")
      ->required()
      ->type_name("URL");
  command->add_option("--jobs", choices->jobs, "processes [as many as there are cores]")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  command
      ->add_option("--limit", choices->limit_s,
                   "longest time of a point in seconds; then it fails [3600, or more if its trials need it]")
      ->check(CLI::Range(1.0, 1e7))
      ->type_name("S");
  command->add_flag("--quiet", choices->quiet, "print nothing but errors and failed points");
  command->callback([choices, command, &job] {
    refuse_empty_values(*command);
    job = [choices] { return work(*choices); };
  });
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
  add_run_options(*command, *choices);
  add_run(*command, job);
  add_work(*command, job);
  add_merge(*command, job);
  add_check(*command, job);
  command->callback([choices, command, &job] {
    if (!command->get_subcommands().empty()) return;
    refuse_empty_values(*command);
    if (choices->file.empty())
      throw std::invalid_argument("study: name a study file, or see phalanx study --help");
    refuse_missing_out(*choices);
    job = [choices] { return run(*choices); };
  });
}

}  // namespace phalanx
