// SPDX-License-Identifier: Apache-2.0
// Shared by the closed-loop figures of S2: words, numbers and pictures of loop runs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "phalanx/study/report/chart.h"
#include "phalanx/study/report/experiments_report.h"
#include "study/experiments/loop_run.h"

namespace phalanx {

inline constexpr int kLoopSeeds = 20;

/// "stable in 20 of 20 seeds; force swings by at most 0.06 N, position by 0.07 mm"
[[nodiscard]] std::string verdict_text(const LoopRun& run);
/// In how many seeds the on-line observer fired.
[[nodiscard]] int seen_oscillating(const LoopRun& run);
/// Stiffness, verdict, swings and, seed by seed, all numbers of the trials.
[[nodiscard]] nlohmann::ordered_json loop_json(const LoopRun& run);
/// Force of every touching segment, or position into the object [mm], over time.
[[nodiscard]] ChartPanel force_panel(const LoopRun& run, const std::string& title);
[[nodiscard]] ChartPanel position_panel(const LoopRun& run, const std::string& title);
/// The bump and the window of the criterion.
[[nodiscard]] std::vector<ChartWindow> trial_windows(const PatientParameters& patient);
/// run,time_s,<segment>_force_n,<segment>_into_m... of the runs' first seeds
[[nodiscard]] std::string curves_csv(const std::vector<LoopRun>& runs);
/// One row of the page: whether a run is as the paper prints.
[[nodiscard]] PaperRow stability_row(const std::string& experiment, const std::string& quantity,
                                     const LoopRun& run, bool stable_in_paper);

}  // namespace phalanx
