// SPDX-License-Identifier: Apache-2.0
// phalanx experiment NAME: the papers' experiments; `all` puts them on one page.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "phalanx/papers/experiments.h"
#include "phalanx/record/made.h"
#include "phalanx/record/output_file.h"
#include "terminal/error_line.h"
#include "terminal/progress.h"
#include "usage.h"

namespace phalanx {
namespace {

void write_files(const std::string& name, const ExperimentReport& report, const std::filesystem::path& out) {
  write_text_file(out / (name + ".csv"), report.csv);
  if (!report.svg.empty()) write_text_file(out / (name + ".svg"), report.svg);
  write_text_file(out / "summary.json", report.json);
}

constexpr double kWorthSaying = 2.0;  // [s]

/// @returns the expected duration on this machine [s].
double expected(const Experiment& experiment) {
  return experiment.all_cores ? on_all_cores(experiment.processor_seconds)
                              : std::max(1.0, experiment.processor_seconds);
}

int run_one(const Experiment& experiment, const std::filesystem::path& out) {
  if (!out.empty()) prepare_output_folder(out);
  if (expected(experiment) >= kWorthSaying)
    print_aside(fmt::format("{}: about {}\n", experiment.name, duration_text(expected(experiment))));
  const ExperimentReport report = experiment.run();
  fmt::print("{}", report.text);
  if (!out.empty()) write_files(experiment.name, report, out);
  return kDone;
}

int run_all(const std::filesystem::path& out) {
  prepare_output_folder(out);
  std::vector<PaperRow> rows;
  std::vector<ReportSection> sections;
  double all = 0.0;
  for (const Experiment& experiment : experiments()) all += expected(experiment);
  print_aside(fmt::format("all experiments: about {}\n", duration_text(all)));
  double done = 0.0;
  for (const Experiment& experiment : experiments()) {
    fmt::print("{} ... (about {})\n", experiment.name, duration_text(expected(experiment)));
    std::fflush(stdout);
    prepare_output_folder(out / experiment.name);
    ProgressBar bar("experiments", true);  // weighted by expected duration
    bar.show(static_cast<std::uint64_t>(done), static_cast<std::uint64_t>(all));
    const ExperimentReport report = experiment.run();
    done += expected(experiment);
    write_files(experiment.name, report, out / experiment.name);
    rows.insert(rows.end(), report.rows.begin(), report.rows.end());
    sections.insert(sections.end(), report.sections.begin(), report.sections.end());
  }
  write_text_file(out / "report.html",
                  experiments_html(rows, sections, made_here(), "1 to 20; 21 to 40 in one row of s2-limit"));
  fmt::print("wrote    {}\n", (out / "report.html").string());
  return kDone;
}

}  // namespace

void add_experiment_command(CLI::App& app, Job& job) {
  CLI::App* command = app.add_subcommand("experiment", "Repeat an experiment of the papers");
  command->require_subcommand(1);
  for (const Experiment& experiment : experiments()) {
    auto out = std::make_shared<std::string>();
    CLI::App* sub = command->add_subcommand(
        experiment.name, fmt::format("{} (about {})", experiment.help, duration_text(expected(experiment))));
    sub->add_option("--out", *out,
                    "write summary.json, " + experiment.name + ".csv and its figure into this folder")
        ->type_name("DIR");
    sub->callback([&experiment, out, sub, &job] {
      refuse_empty_values(*sub);
      job = [&experiment, out] { return run_one(experiment, *out); };
    });
  }
  auto out = std::make_shared<std::string>("out/experiments");
  CLI::App* all = command->add_subcommand("all", "All of them, on one page: paper, ours, difference");
  all->add_option("--out", *out, "the folder of the page and of every experiment's files")
      ->type_name("DIR")
      ->capture_default_str();
  all->callback([out, all, &job] {
    refuse_empty_values(*all);
    job = [out] { return run_all(*out); };
  });
}

}  // namespace phalanx
