// SPDX-License-Identifier: Apache-2.0
// Text, numbers and charts of loop runs, shared by the closed-loop figures of S2.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "papers/loop_run.h"
#include "phalanx/figures/chart.h"
#include "phalanx/papers/experiments.h"

namespace phalanx {

inline constexpr int kLoopSeeds = 20;

/// Describes a run: "stable in 20 of 20 seeds; force swings by at most 0.06 N, position by 0.07 mm".
[[nodiscard]] std::string verdict_text(const LoopRun& run);
/// @returns the number of seeds in which the on-line observer fired.
[[nodiscard]] int seen_oscillating(const LoopRun& run);
/// Writes stiffness, verdict, swings, and all numbers of the trials, seed by seed.
[[nodiscard]] nlohmann::ordered_json loop_json(const LoopRun& run);
/// Draws the force of every touching segment over time.
[[nodiscard]] ChartPanel force_panel(const LoopRun& run, const std::string& title);
/// Draws the position of every touching segment into the object over time [mm].
[[nodiscard]] ChartPanel position_panel(const LoopRun& run, const std::string& title);
/// @returns the bump and the criterion's window.
[[nodiscard]] std::vector<ChartWindow> trial_windows(const PatientParameters& patient);
/// Writes run,time_s,<segment>_force_n,<segment>_into_m... of each run's first seed.
[[nodiscard]] std::string curves_csv(const std::vector<LoopRun>& runs);
/// Makes one row of the page: whether a run agrees with the paper.
[[nodiscard]] PaperRow stability_row(const std::string& experiment, const std::string& quantity,
                                     const LoopRun& run, bool stable_in_paper);

}  // namespace phalanx
