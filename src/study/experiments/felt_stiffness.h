// SPDX-License-Identifier: Apache-2.0
// What a stabiliser costs in feel: the stiffness that a finger meets while it comes to a wall at constant
// speed.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "phalanx/force/stabiliser.h"
#include "phalanx/scene/scene.h"
#include "phalanx/study/experiment_report.h"

namespace phalanx {

inline constexpr double kFeltDepth = 2e-3;   ///< at which the force is read [m]
inline constexpr double kFeltWall = 1600.0;  ///< stiffness of the wall, S2's largest with smoothing [N/m]

/// One finger on its way into a wall.
struct Approach {
  ForceLawParameters law;
  StabiliserParameters stabiliser;
  SmoothingParameters smoothing;
  double period = 0.005;             ///< of the host's steps [s] > 0
  double controller_period = 0.001;  ///< of the controller, which evaluates a local wall [s] > 0
  double speed = 0.05;               ///< v, constant [m/s] > 0
};

/// F(d) / d at d = kFeltDepth, for a depth v t: the mean over `phases` first steps, at (i + 1/2) / phases of
/// a period after the touch. The force is held from each step to the next; that of a local wall from each of
/// the controller's ticks, which begin with the first step. No device: no delay, lag or friction, and no cap.
/// @returns [N/m]. Not real-time
[[nodiscard]] double felt_stiffness(const Approach& approach, int phases = 50);

/// A stabiliser and its felt stiffness at each speed.
struct FeltRow {
  std::string name;
  std::vector<double> stiffness;  ///< one for each of felt_speeds() [N/m]
};

/// The rows of studies/stabilisers.toml: name, and what it sets in the scene.
[[nodiscard]] const std::vector<std::pair<std::string, Overrides>>& felt_variants();
[[nodiscard]] const std::vector<double>& felt_speeds();  ///< [m/s], rising
[[nodiscard]] std::vector<FeltRow> run_felt_stiffness();

[[nodiscard]] ExperimentReport felt_stiffness_experiment();
[[nodiscard]] ExperimentReport felt_stiffness_report(const std::vector<FeltRow>& rows);

}  // namespace phalanx
