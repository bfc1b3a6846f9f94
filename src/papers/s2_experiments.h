// SPDX-License-Identifier: Apache-2.0
// The closed-loop experiments of S2.
#pragma once

#include <vector>

#include "papers/loop_run.h"
#include "phalanx/papers/experiments.h"
#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// Runs the press without smoothing, and with +-0.05 N a step.
[[nodiscard]] std::vector<LoopRun> run_s2_fig4(int seeds);
/// Runs the power grasp at 1.4 N/mm with +-0.1 N a step.
[[nodiscard]] LoopRun run_s2_fig5(int seeds);
/// Runs the power grasp on the device `five_digits`, which also drives the fingers that otherwise copy
/// the index finger.
/// @param set  further overrides
[[nodiscard]] LoopRun run_s2_fig5_driven(const Overrides& set, int seeds);

/// One row of a limit table: the change of the device, and the two limits.
struct LimitRow {
  std::string change;  ///< "sheath friction x 0"
  PointResult none;
  PointResult smoothing;  ///< +-0.1 N a step
};
/// The two limits of the reduced model at one size of the bump.
struct FitRow {
  double bump = 0.0;       ///< [N]
  double none = 0.0;       ///< [N/m]
  double smoothing = 0.0;  ///< +-0.1 N a step [N/m]
};
/// Finds the limits of the press on the scene.
/// @param set  overrides of scene, device and patient, for both limits
[[nodiscard]] LimitRow find_limits(const std::string& change, const Overrides& set, int seeds,
                                   std::uint64_t first_seed = 1);

[[nodiscard]] ExperimentReport s2_fig4();
[[nodiscard]] ExperimentReport s2_fig5();
[[nodiscard]] ExperimentReport s2_limit();
/// Makes the report. @param rows  at least one; the first is compared with the paper
[[nodiscard]] ExperimentReport s2_limit_report(const std::vector<LimitRow>& rows);
[[nodiscard]] ExperimentReport s2_sensitivity();
[[nodiscard]] ExperimentReport s2_sensitivity_report(const std::vector<LimitRow>& rows);
[[nodiscard]] ExperimentReport s2_fit();
/// Makes the report. @param rows  at least one, by increasing bump
[[nodiscard]] ExperimentReport s2_fit_report(const std::vector<FitRow>& rows);

}  // namespace phalanx
