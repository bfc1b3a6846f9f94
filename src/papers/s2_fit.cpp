// SPDX-License-Identifier: Apache-2.0
// The one free parameter, the size of the bump, fitted to S2's two limits with the reduced model.
#include <fmt/format.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "papers/s2_experiments.h"
#include "papers/s2_loop_figures.h"
#include "phalanx/simulation/closed_loop/reduced_model.h"
#include "phalanx/study/laboratory/limit_search.h"
#include "record/made_json.h"

namespace phalanx {
namespace {

constexpr double kStep = 100.0;  // step of the stiffness grid [N/m]

/// @returns the sum of the squared deviations from S2's printed limits, in steps of the grid.
int deviation(const FitRow& row) {
  const auto steps = [](double ours, double paper) {
    return static_cast<int>(std::lround((ours - paper) / kStep));
  };
  const int a = steps(row.none, 700.0);
  const int b = steps(row.smoothing, 1600.0);
  return a * a + b * b;
}

double limit_at(const ReducedModel& model, const StabiliserParameters& stabiliser) {
  const auto stable = [&](int index) {
    for (std::uint64_t seed = 1; seed <= kLoopSeeds; ++seed)
      if (!run_reduced_trial(model, stabiliser, kStep * (index + 1), seed).stable) return false;
    return true;
  };
  return kStep * (search_limit(30, stable).limit + 1);
}

FitRow fit_row(double bump) {
  ReducedModel model = make_reduced_model();
  model.patient.bump = bump;
  const StabiliserParameters none{.method = Stabiliser::kNone};
  const StabiliserParameters smoothing{
      .method = Stabiliser::kSmoothing, .min_rate = -0.1 * model.rate_hz, .max_rate = 0.1 * model.rate_hz};
  return {.bump = bump, .none = limit_at(model, none), .smoothing = limit_at(model, smoothing)};
}

}  // namespace

ExperimentReport s2_fit() {
  std::vector<FitRow> rows(13);
  tbb::parallel_for(std::size_t{0}, rows.size(),
                    [&](std::size_t i) { rows[i] = fit_row(0.5 * static_cast<double>(i)); });
  return s2_fit_report(rows);
}

ExperimentReport s2_fit_report(const std::vector<FitRow>& rows) {
  assert(!rows.empty());
  const FitRow* best = &rows.front();
  for (const FitRow& row : rows)
    if (deviation(row) <= deviation(*best)) best = &row;
  const double fitted = best->bump;

  ExperimentReport report;
  nlohmann::ordered_json json;
  json["experiment"] = "s2-fit";
  json["paper"] = "S2's two limits, 0.7 and 1.6 N/mm";
  json["model"] = "one degree of freedom, the numbers of docs/stability.md";
  json["fitted_bump_n"] = fitted;
  report.csv = "bump_n,none_n_per_mm,smoothing_n_per_mm,deviation\n";
  report.text =
      "The size of the bump, fitted on S2's 0.7 and 1.6 N/mm with one degree of freedom: the least sum of "
      "squared\n"
      "deviations in steps of the grid (0.1 N/mm); of several the hardest.\n";
  ReportTable table{.header = {"bump [N]", "k_lim without [N/mm]", "k_lim with +-0.1 N a step [N/mm]",
                               "squared deviation [steps]"},
                    .rows = {}};
  for (const FitRow& row : rows) {
    report.csv +=
        fmt::format("{},{},{},{}\n", row.bump, row.none / 1000.0, row.smoothing / 1000.0, deviation(row));
    report.text += fmt::format("bump {:4.1f} N: {:.1f} and {:.1f} N/mm{}\n", row.bump, row.none / 1000.0,
                               row.smoothing / 1000.0, row.bump == fitted ? "  fitted" : "");
    table.rows.push_back({fmt::format("{:.1f}", row.bump), fmt::format("{:.1f}", row.none / 1000.0),
                          fmt::format("{:.1f}", row.smoothing / 1000.0), fmt::format("{}", deviation(row))});
    json["rows"].push_back({{"bump_n", row.bump},
                            {"none_n_per_mm", row.none / 1000.0},
                            {"smoothing_n_per_mm", row.smoothing / 1000.0},
                            {"deviation", deviation(row)}});
  }
  report.text += fmt::format("fitted: {} N\n", fitted);
  json["made"] = made_json(made_here());
  report.json = json.dump(2) + "\n";
  report.sections = {
      {.title = "The fit",
       .text =
           {"Device and finger have the numbers of docs/stability.md. One parameter is free: how hard the "
            "finger is bumped. "
            "It is fitted on S2's two limits alone, on a model of one degree of freedom, by the least sum of "
            "squared "
            "deviations in steps of the grid (of several bumps the hardest), and frozen. The device's "
            "numbers "
            "were chosen on the same two limits, so that what else this page says of S2's figures follows "
            "largely from these two fits.",
            fmt::format("Fitted: {} N.", fitted)},
       .svg = {},
       .table = table}};
  return report;
}

}  // namespace phalanx
