// SPDX-License-Identifier: Apache-2.0
// S2's claim: the largest stable stiffness rises from 0.7 to 1.6 N/mm. Also the parameters that
// change these two.
#include <fmt/format.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "papers/s2_experiments.h"
#include "papers/s2_loop_figures.h"
#include "phalanx/scene/scene.h"
#include "phalanx/study/trial_function.h"
#include "record/made_json.h"
#include "study/laboratory/measure_point.h"

namespace phalanx {
namespace {

constexpr double kPaperNone = 0.7;       // [N/mm]
constexpr double kPaperSmoothing = 1.6;  // [N/mm]

Study limit_study(const Overrides& set, int seeds, std::uint64_t first_seed) {
  Study study;
  study.name = "s2-limit";
  study.scene = "stability_press";
  study.seeds = seeds;
  study.first_seed = first_seed;
  study.stiffness = StiffnessGrid{.min_n_per_mm = 0.1, .max_n_per_mm = 4.0, .step_n_per_mm = 0.1};
  study.set = set;
  study.variants = {{.name = "none", .set = {{"stabiliser.method", "\"none\""}}},
                    {.name = "smoothing", .set = {{"smoothing.min_n", "-0.1"}, {"smoothing.max_n", "0.1"}}}};
  return study;
}

std::string limit_text(const PointResult& point) {
  if (point.k_lim == 0.0) return "< 0.1";
  return fmt::format("{}{:.1f}", point.at_least ? ">= " : "", point.k_lim / 1000.0);
}

nlohmann::ordered_json point_json(const PointResult& point) {
  nlohmann::ordered_json json;
  json["k_lim_n_per_mm"] = point.k_lim / 1000.0;
  json["at_least"] = point.at_least;
  json["non_monotone"] = point.non_monotone;
  for (const StiffnessVerdict& checked : point.checked)
    json["checked"].push_back({{"n_per_mm", checked.n_per_mm}, {"verdict", verdict_name(checked.verdict)}});
  return json;
}

nlohmann::ordered_json rows_json(const std::vector<LimitRow>& rows) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const LimitRow& row : rows)
    json.push_back(
        {{"change", row.change}, {"none", point_json(row.none)}, {"smoothing", point_json(row.smoothing)}});
  return json;
}

ReportTable table_of(const std::vector<LimitRow>& rows) {
  ReportTable table{
      .header = {"device and patient", "k_lim without [N/mm]", "k_lim with +-0.1 N a step [N/mm]"},
      .rows = {}};
  for (const LimitRow& row : rows)
    table.rows.push_back({row.change, limit_text(row.none), limit_text(row.smoothing)});
  return table;
}

std::string csv_of(const std::vector<LimitRow>& rows) {
  std::string csv = "change,none_n_per_mm,smoothing_n_per_mm\n";
  for (const LimitRow& row : rows)
    csv += fmt::format("{},{},{}\n", row.change, row.none.k_lim / 1000.0, row.smoothing.k_lim / 1000.0);
  return csv;
}

std::string text_of(const std::vector<LimitRow>& rows) {
  std::string text = fmt::format("{:<44}{:>16}{:>22}\n", "", "without [N/mm]", "+-0.1 N a step [N/mm]");
  for (const LimitRow& row : rows)
    text += fmt::format("{:<44}{:>16}{:>22}\n", row.change, limit_text(row.none), limit_text(row.smoothing));
  return text;
}

PaperRow limit_row(const std::string& quantity, double paper, const PointResult& ours) {
  return {.experiment = "s2-limit",
          .quantity = quantity,
          .unit = "N/mm",
          .paper = fmt::format("{:.1f}", paper),
          .ours = limit_text(ours),
          .difference = fmt::format("{:+.1f}", ours.k_lim / 1000.0 - paper),
          .kind = RowKind::kFitted,
          .note = "grid 0.1 N/mm, 20 seeds; fitted on the reduced model, found on the scene"};
}

struct Change {
  std::string name;
  Overrides set;
};

std::vector<LimitRow> find_all(const std::vector<Change>& changes) {
  std::vector<LimitRow> rows(changes.size());
  tbb::parallel_for(std::size_t{0}, changes.size(), [&](std::size_t i) {
    rows[i] = find_limits(changes[i].name, changes[i].set, kLoopSeeds);
  });
  return rows;
}

}  // namespace

LimitRow find_limits(const std::string& change, const Overrides& set, int seeds, std::uint64_t first_seed) {
  const Study study = limit_study(set, seeds, first_seed);
  const TrialFunction trial = make_trial_function(study.scene);
  LimitRow row{.change = change, .none = {}, .smoothing = {}};
  tbb::parallel_for(0, 2,
                    [&](int i) { (i == 0 ? row.none : row.smoothing) = measure_point(study, i, trial); });
  return row;
}

ExperimentReport s2_limit() {
  return s2_limit_report(
      {find_limits("as it is, seeds 1 to 20", {}, kLoopSeeds, 1),
       find_limits("as it is, seeds 21 to 40", {}, kLoopSeeds, 21),
       find_limits("no friction in the sheaths", {{"device.scale.sheath_friction", "0"}}, kLoopSeeds)});
}

ExperimentReport s2_limit_report(const std::vector<LimitRow>& rows) {
  assert(!rows.empty());
  ExperimentReport report;
  nlohmann::ordered_json json;
  json["experiment"] = "s2-limit";
  json["paper"] =
      "S2: largest stable stiffness 0.7 N/mm without smoothing, 1.6 N/mm with it (bounds not printed)";
  json["k_lim_n_per_mm"] = {{"none", rows[0].none.k_lim / 1000.0},
                            {"smoothing", rows[0].smoothing.k_lim / 1000.0}};
  json["paper_n_per_mm"] = {{"none", kPaperNone}, {"smoothing", kPaperSmoothing}};
  json["rows"] = rows_json(rows);
  json["made"] = made_json(made_here());
  report.json = json.dump(2) + "\n";
  report.csv = csv_of(rows);
  report.rows = {limit_row("largest stable stiffness without smoothing", kPaperNone, rows[0].none),
                 limit_row("largest stable stiffness with smoothing (ours at +-0.1 N a step)",
                           kPaperSmoothing, rows[0].smoothing)};
  report.text =
      "S2: the largest stable stiffness, index finger on the teapot, in closed loop. S2 prints 0.7 and 1.6 "
      "N/mm.\n" +
      text_of(rows);
  report.sections = {
      {.title = "S2: the largest stable stiffness",
       .text =
           {"The largest stiffness of a grid of 0.1 N/mm at which all 20 seeds are stable. S2 prints 0.7 "
            "without smoothing and 1.6 with it, and does not say at which bounds; ours are 0.1 N a step."},
       .svg = {},
       .table = table_of(rows)}};
  return report;
}

ExperimentReport s2_sensitivity() {
  const std::vector<Change> changes = {
      {"as it is", {}},
      {"sheath friction x 0", {{"device.scale.sheath_friction", "0"}}},
      {"sheath friction x 0.5", {{"device.scale.sheath_friction", "0.5"}}},
      {"sheath friction x 1.25", {{"device.scale.sheath_friction", "1.25"}}},
      {"compute and return delay x 0",
       {{"device.scale.compute_delay", "0"}, {"device.scale.return_delay", "0"}}},
      {"compute and return delay x 0.5",
       {{"device.scale.compute_delay", "0.5"}, {"device.scale.return_delay", "0.5"}}},
      {"compute and return delay x 2",
       {{"device.scale.compute_delay", "2"}, {"device.scale.return_delay", "2"}}},
      {"patient's stiffness x 0.5", {{"patient.scale.stiffness", "0.5"}}},
      {"patient's stiffness x 2", {{"patient.scale.stiffness", "2"}}},
      {"bump 0 N", {{"patient.bump_n", "0"}}},
      {"bump 2 N", {{"patient.bump_n", "2"}}},
      {"bump 6 N", {{"patient.bump_n", "6"}}},
  };
  return s2_sensitivity_report(find_all(changes));
}

ExperimentReport s2_sensitivity_report(const std::vector<LimitRow>& rows) {
  ExperimentReport report;
  nlohmann::ordered_json json;
  json["experiment"] = "s2-sensitivity";
  json["paper"] = "not in the papers";
  json["rows"] = rows_json(rows);
  json["made"] = made_json(made_here());
  report.json = json.dump(2) + "\n";
  report.csv = csv_of(rows);
  report.text = "What moves the two limits of s2-limit (each with 20 seeds).\n" + text_of(rows);
  report.sections = {
      {.title = "What moves these limits",
       .text =
           {"The same search with one thing changed. The limits hold for this device, this patient and this "
            "disturbance, not for stiffness as such."},
       .svg = {},
       .table = table_of(rows)}};
  return report;
}

}  // namespace phalanx
