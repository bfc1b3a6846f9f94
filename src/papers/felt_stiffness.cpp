// SPDX-License-Identifier: Apache-2.0
#include "papers/felt_stiffness.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "phalanx/figures/chart.h"
#include "phalanx/force/force_law.h"
#include "record/made_json.h"

namespace phalanx {
namespace {

constexpr double kMilli = 1e-3;

/// @returns the force at depth kFeltDepth if the first step comes `first` after the touch [N].
double force_at_depth(const Approach& a, double first) {
  const double end = kFeltDepth / a.speed;
  StabiliserMemory memory;
  double filtered = 0.0;
  double sent = 0.0;
  for (int n = 0; first + n * a.period <= end; ++n) {
    StabiliserInput input;
    input.depth = a.speed * (first + n * a.period);
    // At the first step of a contact its speed is 0: there is no earlier position of the point.
    input.speed_now = n > 0 ? a.speed : 0.0;
    filtered += lowpass_gain(a.law.velocity_lowpass_hz, a.period) * (input.speed_now - filtered);
    input.speed = filtered;
    input.sent = sent;
    input.pressing = true;
    input.period = a.period;
    input.force = law_force(a.law, input.depth, input.speed);
    sent = stabilised_force(a.stabiliser, input, memory);
  }
  if (a.stabiliser.method != Stabiliser::kLocalWall || first > end) return sent;
  const double ticks = std::floor((end - first) / a.controller_period);
  return law_force(a.law, a.speed * (first + ticks * a.controller_period), 0.0);
}

std::string number(double newtons_per_metre) { return fmt::format("{:.2f}", kMilli * newtons_per_metre); }

}  // namespace

double felt_stiffness(const Approach& approach, int phases) {
  double sum = 0.0;
  for (int i = 0; i < phases; ++i) sum += force_at_depth(approach, (i + 0.5) / phases * approach.period);
  return sum / phases / kFeltDepth;
}

const std::vector<std::pair<std::string, Overrides>>& felt_variants() {
  const auto method = [](const char* name) {
    return std::pair{"stabiliser.method", fmt::format("\"{}\"", name)};
  };
  static const std::vector<std::pair<std::string, Overrides>> kVariants = {
      {"none", {method("none")}},
      {"smoothing 0.1 N a step (S2)", {{"smoothing.min_n", "-0.1"}, {"smoothing.max_n", "0.1"}}},
      {"smoothing 0.05 N a step (S2)", {{"smoothing.min_n", "-0.05"}, {"smoothing.max_n", "0.05"}}},
      {"rise only 0.1 N a step", {method("rise_only"), {"smoothing.max_n", "0.1"}}},
      {"rise only 0.05 N a step", {method("rise_only"), {"smoothing.max_n", "0.05"}}},
      {"direction 90 deg/s", {method("direction"), {"stabiliser.turn_deg_per_s", "90"}}},
      {"low-pass 10 Hz", {method("low_pass"), {"stabiliser.lowpass_hz", "10"}}},
      {"low-pass 3 Hz", {method("low_pass"), {"stabiliser.lowpass_hz", "3"}}},
      {"low-pass 1 Hz", {method("low_pass"), {"stabiliser.lowpass_hz", "1"}}},
      {"Kelvin-Voigt 4 N s/m", {method("kelvin_voigt"), {"stabiliser.damping_ns_per_m", "4"}}},
      {"Kelvin-Voigt 8 N s/m", {method("kelvin_voigt"), {"stabiliser.damping_ns_per_m", "8"}}},
      {"virtual coupling 1 N/mm, 4 N s/m",
       {method("virtual_coupling"),
        {"stabiliser.coupling_stiffness_n_per_mm", "1"},
        {"stabiliser.coupling_damping_ns_per_m", "4"}}},
      {"time-domain passivity, at most 10 N s/m",
       {method("passivity"), {"stabiliser.passivity_damping_max_ns_per_m", "10"}}},
      {"energy bounding, b = 1.6 N s/m",
       {method("energy_bounding"), {"stabiliser.device_damping_ns_per_m", "1.6"}}},
      {"local wall at 1 kHz", {method("local_wall")}},
      {"none, host at 1 kHz", {method("none"), {"rate_hz", "1000"}}},
      {"time-domain passivity, host at 1 kHz",
       {method("passivity"), {"stabiliser.passivity_damping_max_ns_per_m", "10"}, {"rate_hz", "1000"}}},
  };
  return kVariants;
}

const std::vector<double>& felt_speeds() {
  static const std::vector<double> kSpeeds = {0.01, 0.02, 0.05, 0.1, 0.2};
  return kSpeeds;
}

std::vector<FeltRow> run_felt_stiffness() {
  std::vector<FeltRow> rows;
  for (const auto& [name, set] : felt_variants()) {
    const SceneDescription scene = load_scene("stability_press", set);
    Approach approach{.law = scene.parameters.force, .stabiliser = scene.parameters.stabiliser};
    approach.law.stiffness = kFeltWall;
    approach.period = scene.parameters.period();
    FeltRow row{.name = name, .stiffness = {}};
    for (const double speed : felt_speeds()) {
      approach.speed = speed;
      row.stiffness.push_back(felt_stiffness(approach));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

ExperimentReport felt_stiffness_experiment() { return felt_stiffness_report(run_felt_stiffness()); }

ExperimentReport felt_stiffness_report(const std::vector<FeltRow>& rows) {
  ExperimentReport report;
  ReportTable table{.header = {"stabiliser"}, .rows = {}};
  HeatMap map{.title = "Felt stiffness of a wall of 1.6 N/mm, 2 mm deep",
              .quantity = "felt stiffness [N/mm]",
              .x_label = "speed of approach [mm/s]",
              .y_label = "stabiliser",
              .columns = {},
              .rows = {},
              .value = {}};
  nlohmann::ordered_json json;
  json["experiment"] = "felt-stiffness";
  json["wall_n_per_mm"] = kMilli * kFeltWall;
  json["depth_mm"] = kFeltDepth / kMilli;
  report.csv = "stabiliser";
  report.text = fmt::format(
      "Felt stiffness [N/mm] of a wall of {} N/mm at a depth of {} mm, by the speed of approach "
      "[mm/s]\n{:<42}",
      kMilli * kFeltWall, kFeltDepth / kMilli, "");
  for (const double speed : felt_speeds()) {
    const std::string column = fmt::format("{:g}", speed / kMilli);
    map.columns.push_back(column);
    table.header.push_back(column + " mm/s");
    report.csv += fmt::format(",felt_n_per_mm_at_{}_mm_per_s", column);
    report.text += fmt::format("{:>8}", column);
    json["speeds_mm_per_s"].push_back(speed / kMilli);
  }
  report.csv += "\n";
  report.text += "\n";
  for (const FeltRow& row : rows) {
    map.rows.push_back(row.name);
    std::vector<std::string> cells = {row.name};
    report.csv += '"' + row.name + '"';
    report.text += fmt::format("{:<42}", row.name);
    nlohmann::ordered_json felt;
    for (const double stiffness : row.stiffness) {
      map.value.push_back(std::round(0.1 * stiffness) / 100.0);  // in steps of 0.01 N/mm, as in the table
      cells.push_back(number(stiffness));
      report.csv += fmt::format(",{}", kMilli * stiffness);
      report.text += fmt::format("{:>8}", number(stiffness));
      felt.push_back(kMilli * stiffness);
    }
    report.csv += "\n";
    report.text += "\n";
    table.rows.push_back(std::move(cells));
    json["rows"].push_back({{"stabiliser", row.name}, {"felt_n_per_mm", felt}});
  }
  report.svg = heat_map_svg(map);
  json["made"] = made_json(made_here());
  report.json = json.dump(2) + "\n";
  report.sections = {
      {.title = "What stabilising costs in feel",
       .text =
           {"A finger comes to a wall of 1.6 N/mm at constant speed. The force at a depth of 2 mm, over that "
            "depth, is the stiffness that it feels on its way in. Host at 200 Hz unless the row says "
            "otherwise, "
            "mean over the phase of the step; no device: no delay, lag or friction. The papers print nothing "
            "of this."},
       .svg = {report.svg},
       .table = table}};
  return report;
}

}  // namespace phalanx
