// SPDX-License-Identifier: Apache-2.0
// The stiffness that a finger feels with a stabiliser, while it comes to a wall at constant speed.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "phalanx/force/stabiliser.h"
#include "phalanx/papers/experiments.h"
#include "phalanx/scene/scene.h"

namespace phalanx {

inline constexpr double kFeltDepth = 2e-3;   ///< depth at which the force is read [m]
inline constexpr double kFeltWall = 1600.0;  ///< stiffness of the wall, S2's largest with smoothing [N/m]

/// Parameters of one finger on its way into a wall.
struct Approach {
  ForceLawParameters law;
  StabiliserParameters stabiliser;
  double period = 0.005;             ///< period of the host's steps [s] > 0
  double controller_period = 0.001;  ///< period of the controller, which evaluates a local wall [s] > 0
  double speed = 0.05;               ///< v, constant [m/s] > 0
};

/// @returns F(d) / d at d = kFeltDepth, for a depth v t [N/m]. It is the mean over `phases` first steps, at
/// (i + 1/2) / phases of a period after the touch. The force is held from each step to the next; that of a
/// local wall is held from each of the controller's ticks, which begin with the first step. There is no
/// device: no delay, lag or friction, and no cap. Not real-time.
[[nodiscard]] double felt_stiffness(const Approach& approach, int phases = 50);

/// A stabiliser and its felt stiffness at each speed.
struct FeltRow {
  std::string name;
  std::vector<double> stiffness;  ///< one for each of felt_speeds() [N/m]
};

/// @returns the rows of studies/stabilisers.toml: name and overrides of the scene.
[[nodiscard]] const std::vector<std::pair<std::string, Overrides>>& felt_variants();
[[nodiscard]] const std::vector<double>& felt_speeds();  ///< [m/s], rising
[[nodiscard]] std::vector<FeltRow> run_felt_stiffness();

[[nodiscard]] ExperimentReport felt_stiffness_experiment();
[[nodiscard]] ExperimentReport felt_stiffness_report(const std::vector<FeltRow>& rows);

}  // namespace phalanx
