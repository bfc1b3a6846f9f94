// SPDX-License-Identifier: Apache-2.0
// phalanx experiment NAME: the papers' experiments.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "commands.h"
#include "phalanx/record/output_file.h"
#include "phalanx/study/experiments.h"
#include "usage.h"

namespace phalanx {
namespace {

struct Report {
  std::string text, csv, json;
};

Report s1_fig8() {
  const auto situations = run_s1_fig8();
  return {fig8_text(situations), fig8_csv(situations), fig8_json(situations)};
}
Report of_timing(const TimingResult& result) {
  return {timing_text(result), timing_csv(result), timing_json(result)};
}
Report s1_timing() { return of_timing(run_s1_timing()); }
Report s2_timing() { return of_timing(run_s2_timing()); }

int run_experiment(const std::string& name, Report (*experiment)(), const std::filesystem::path& out) {
  if (!out.empty()) prepare_output_folder(out);
  const Report report = experiment();
  fmt::print("{}", report.text);
  if (out.empty()) return kDone;
  write_text_file(out / (name + ".csv"), report.csv);
  write_text_file(out / "summary.json", report.json);
  return kDone;
}

}  // namespace

void add_experiment_command(CLI::App& app, Job& job) {
  CLI::App* command = app.add_subcommand("experiment", "Repeat an experiment of the papers");
  command->require_subcommand(1);
  const auto add = [&](const std::string& name, const std::string& help, Report (*experiment)()) {
    auto out = std::make_shared<std::string>();
    CLI::App* sub = command->add_subcommand(name, help);
    sub->add_option("--out", *out, "write summary.json and " + name + ".csv into this folder")
        ->type_name("DIR");
    sub->callback([=, &job] {
      refuse_empty_values(*sub);
      job = [=] { return run_experiment(name, experiment, *out); };
    });
  };
  add("s1-fig8", "Seven situations of the index finger and a ball: which joints carry torque", s1_fig8);
  add("s1-timing", "S1's 1,489 triangles: time of a step beside S1's 4.2 ms", s1_timing);
  add("s2-timing", "S2's 2,248 + 992 triangles: time of a step", s2_timing);
}

}  // namespace phalanx
