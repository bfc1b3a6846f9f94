// SPDX-License-Identifier: Apache-2.0
#include "papers/s2_loop_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "phalanx/figures/human_names.h"
#include "phalanx/record/ticks_csv.h"
#include "study/laboratory/study_json.h"
#include "study/laboratory/study_values.h"

namespace phalanx {
namespace {

ChartPanel panel(const LoopRun& run, const std::string& title, const std::string& label, double scale,
                 const std::array<std::vector<double>, kSegments>& values) {
  ChartPanel out{.title = title, .y_label = label, .series = {}, .marks = {}};
  for (const int segment : run.curves.touching) {
    ChartSeries series{
        .name = human_segment_name(segment), .x = run.curves.time_s, .y = {}, .low = {}, .high = {}};
    for (const double value : values[static_cast<std::size_t>(segment)]) series.y.push_back(scale * value);
    out.series.push_back(std::move(series));
  }
  return out;
}

}  // namespace

std::string verdict_text(const LoopRun& run) {
  std::string text = fmt::format(
      "stable in {} of {} seeds; in the window force swings by at most {:.2f} N, position by {:.2f} mm",
      run.stable(), run.trials.size(), run.largest_force_swing(), 1e3 * run.largest_position_swing());
  const auto invalid =
      std::find_if(run.trials.begin(), run.trials.end(), [](const TrialResult& t) { return !t.valid; });
  if (invalid != run.trials.end()) text += fmt::format(" ({} acted)", invalid->why_invalid);
  return text;
}

int seen_oscillating(const LoopRun& run) {
  return static_cast<int>(std::count_if(run.detections.begin(), run.detections.end(),
                                        [](const Detection& d) { return !std::isnan(d.fired_s); }));
}

nlohmann::ordered_json loop_json(const LoopRun& run) {
  nlohmann::ordered_json json;
  json["stiffness_n_per_mm"] = run.stiffness / 1000.0;
  json["stable_seeds"] = run.stable();
  json["unstable_seeds"] = run.unstable();
  json["seen_oscillating_seeds"] = seen_oscillating(run);
  json["seeds"] = run.trials.size();
  json["largest_force_swing_n"] = run.largest_force_swing();
  json["largest_position_swing_m"] = run.largest_position_swing();
  for (int joint = 0; joint < kJoints; ++joint) {
    const double unrendered = run.unrendered[static_cast<std::size_t>(joint)];
    if (unrendered > 1e-9) json["largest_unrendered_nm"][std::string(joint_name(joint))] = unrendered;
  }
  for (std::size_t i = 0; i < run.trials.size(); ++i) {
    const TrialResult& trial = run.trials[i];
    json["trials"].push_back({{"seed", i + 1},
                              {"stable", trial.stable},
                              {"valid", trial.valid},
                              {"why_invalid", trial.why_invalid},
                              {"force_swing_n", trial.force_swing},
                              {"position_swing_m", trial.position_swing},
                              {"peak_depth_m", trial.peak_depth},
                              {"mean_force_n", trial.mean_force},
                              {"ghost_s", trial.ghost_s},
                              {"ghost_energy_j", trial.ghost_energy},
                              {"swung_s", number_or_null(run.detections[i].swung_s)},
                              {"oscillation_seen_s", number_or_null(run.detections[i].fired_s)}});
  }
  return json;
}

ChartPanel force_panel(const LoopRun& run, const std::string& title) {
  return panel(run, title, "force [N]", 1.0, run.curves.force);
}

ChartPanel position_panel(const LoopRun& run, const std::string& title) {
  ChartPanel out = panel(run, title, "into the object [mm]", 1e3, run.curves.position);
  out.legend = false;
  return out;
}

std::vector<ChartWindow> trial_windows(const PatientParameters& patient) {
  const TrialSchedule schedule;
  return {{.from = patient.bump_start, .to = patient.bump_start + patient.bump_duration, .label = "bump"},
          {.from = schedule.window_begin, .to = schedule.window_end, .label = "judged"}};
}

std::string curves_csv(const std::vector<LoopRun>& runs) {
  std::vector<int> segments;
  for (const LoopRun& run : runs)
    for (const int segment : run.curves.touching)
      if (std::find(segments.begin(), segments.end(), segment) == segments.end()) segments.push_back(segment);
  std::sort(segments.begin(), segments.end());
  std::string text = "run,time_s";
  for (const int segment : segments) text += fmt::format(",{0}_force_n,{0}_into_m", segment_column(segment));
  text += "\n";
  for (const LoopRun& run : runs) {
    for (std::size_t i = 0; i < run.curves.time_s.size(); ++i) {
      text += fmt::format("{},{}", csv_text(run.name), run.curves.time_s[i]);
      for (const int segment : segments) {
        const auto s = static_cast<std::size_t>(segment);
        const double into = run.curves.position[s][i];
        text +=
            fmt::format(",{},{}", run.curves.force[s][i], std::isnan(into) ? "" : fmt::format("{}", into));
      }
      text += "\n";
    }
  }
  return text;
}

PaperRow stability_row(const std::string& experiment, const std::string& quantity, const LoopRun& run,
                       bool stable_in_paper) {
  const int all = static_cast<int>(run.trials.size());
  const bool steady = run.stable() == all;
  const bool oscillates = run.unstable() > 0;
  const bool agrees = stable_in_paper ? steady : oscillates;
  return {.experiment = experiment,
          .quantity = quantity,
          .unit = "",
          .paper = stable_in_paper ? "steady" : "oscillates",
          .ours = fmt::format("{} ({} of {} seeds stable, {} not)",
                              steady       ? "steady"
                              : oscillates ? "oscillates"
                                           : "not proven",
                              run.stable(), all, run.unstable()),
          .difference = agrees ? "agrees" : "differs",
          .kind = RowKind::kPredicted,
          .note = fmt::format(
              "follows largely from the fit on S2's two limits; largest swing {:.2f} N, {:.2f} mm",
              run.largest_force_swing(), 1e3 * run.largest_position_swing())};
}

}  // namespace phalanx
