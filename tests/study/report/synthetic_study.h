// SPDX-License-Identifier: Apache-2.0
// Studies with made-up results: formulas that give curves something to show. No measurement.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "phalanx/record/made.h"
#include "phalanx/study/laboratory/study.h"

namespace phalanx {

inline const Made kMadeUp = {.commit = "v0.0-synthetic",
                             .cpu = "made-up CPU",
                             .compiler = "made-up compiler 1.0",
                             .build_type = "Nothing",
                             .date = "2000-01-01T00:00:00Z"};

inline StudyAxis numbers(const std::string& key, const std::string& label,
                         const std::vector<double>& values) {
  StudyAxis axis{.key = key, .label = label, .values = {}};
  for (const double value : values)
    axis.values.push_back({fmt::format("{:.6g}", value), fmt::format("{:.6g}", value), value});
  return axis;
}

inline StudyAxis words(const std::string& key, const std::vector<std::string>& values) {
  StudyAxis axis{.key = key, .label = key, .values = {}};
  for (const std::string& value : values) axis.values.push_back({'"' + value + '"', value});
  return axis;
}

inline Study synthetic_study(std::vector<std::string> variants, std::vector<StudyAxis> axes) {
  Study study;
  study.name = "synthetic";
  study.title = "Made-up numbers that show what the page looks like";
  study.scene = "press_teapot";
  study.stiffness = StiffnessGrid{};
  study.set = {{"step.rate", "200"}};
  if (variants.empty()) variants = {""};
  for (const std::string& name : variants)
    study.variants.push_back({name, {{"force.stabiliser", '"' + name + '"'}}});
  study.axes = std::move(axes);
  return study;
}

/// A result whose limit is grid point `limit`, with the verdicts of a search around it.
inline PointResult synthetic_result(const Study& study, int index, int limit) {
  PointResult result;
  result.index = index;
  const StiffnessGrid& grid = *study.stiffness;
  limit = std::min(limit, grid.size() - 1);
  result.k_lim = limit < 0 ? 0.0 : grid.at(limit);
  result.at_least = limit == grid.size() - 1;
  for (int i = 0; i < grid.size(); ++i) {
    if (i % 4 != 0 && std::abs(i - limit) > 2) continue;
    result.checked.push_back({.n_per_mm = grid.n_per_mm(i),
                              .verdict = i <= limit ? Verdict::kStable : Verdict::kUnstable,
                              .seeds_run = i <= limit ? study.seeds : 1});
  }
  result.trials = 100 + index;
  if (limit < 0) return result;
  const double k = 1e-3 * result.k_lim;
  result.stable = true;
  result.measured_at = result.k_lim;
  result.k_eff = 900.0 * k;
  result.k_eff_seeds = study.seeds;
  result.peak_depth = 3e-3 / k;
  result.force_swing = 0.1 + 0.05 * (index % 7);
  result.position_swing = 1e-4 + 2e-5 * (index % 5);
  result.ghost_s = {.mean = 0.05 * k, .largest = 0.07 * k};
  result.ghost_energy = {.mean = 0.01 * k, .largest = 0.012 * k};
  return result;
}

/// One for each point; the limit grows with the variant and with every axis.
inline std::vector<PointResult> synthetic_results(const Study& study) {
  std::vector<PointResult> results;
  for (int i = 0; i < point_count(study); ++i) {
    const StudyPoint point = study_point(study, i);
    double limit = 4.0 + 5.0 * point.variant;
    for (std::size_t axis = 0; axis < point.value.size(); ++axis)
      limit += 14.0 * point.value[axis] / static_cast<double>(study.axes[axis].values.size()) /
               (1.0 + point.variant * 0.4);
    results.push_back(synthetic_result(study, i, static_cast<int>(limit)));
  }
  return results;
}

}  // namespace phalanx
