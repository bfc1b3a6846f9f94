// SPDX-License-Identifier: Apache-2.0
// Studies and trials whose answers are known: nothing is simulated.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "phalanx/study/laboratory/run_study.h"
#include "phalanx/study/laboratory/study_file.h"
#include "record/temporary_folder.h"  // for GoogleTest's namespace in this one

namespace phalanx::testing {

/// 3 variants x 4 frictions, 5 seeds, stiffness 0.1 to 4 N/mm.
inline constexpr const char* kTwelvePoints = R"(
scene = "press_teapot"
description = "twelve points"
seeds = 5
[stiffness]
min_n_per_mm = 0.1
max_n_per_mm = 4.0
step_n_per_mm = 0.1
[[variant]]
name = "none"
[[variant]]
name = "smoothing"
set = { "synthetic.gain" = 2.0 }
[[variant]]
name = "wall, \"local\""
set = { "synthetic.gain" = 3.0 }
[[axis]]
key = "synthetic.friction"
label = "friction"
values = [0, 0.1, 0.2, 0.3]
)";

inline Study study_of(const std::string& text) { return parse_study(text, "synthetic.toml", "."); }

/// The last value that the overrides give a key.
inline double number_of(const Overrides& overrides, std::string_view key, double fallback) {
  double value = fallback;
  for (const auto& [name, text] : overrides) {
    if (name == key) value = std::stod(text);
  }
  return value;
}

/// The limit of seed `seed` [N/m]: gain x (500 + 4000 x friction), a little less for every seed: seed 5
/// decides.
inline double synthetic_limit(double gain, double friction, std::uint64_t seed) {
  return gain * (500.0 + 4000.0 * friction) - static_cast<double>(seed);
}

/// Stable up to that limit; a wall that is felt at 0.8 of its stiffness; swings, depth and ghost that can be
/// computed by hand.
inline TrialResult synthetic_trial(const Overrides& overrides, double stiffness, double press,
                                   std::uint64_t seed) {
  const double k = std::isnan(stiffness) ? 300.0 : stiffness;
  TrialResult result;
  result.stable = k <= synthetic_limit(number_of(overrides, "synthetic.gain", 1.0),
                                       number_of(overrides, "synthetic.friction", 0.0), seed);
  const double force = std::isnan(press) ? 3.0 : press;
  result.force_swing = result.stable ? 0.01 * static_cast<double>(seed) : 2.0;
  result.position_swing = result.force_swing / k;
  result.mean_force = force;
  result.mean_depth = force / (0.8 * k);
  result.peak_depth = 1.5 * result.mean_depth;
  result.ghost_s = 0.1 * static_cast<double>(seed);
  result.ghost_energy = 0.001 * static_cast<double>(seed);
  return result;
}

inline StudyInputs no_inputs(const Overrides& /*overrides*/) { return {}; }

inline StudyOptions options_for(int jobs) {
  StudyOptions options;
  options.jobs = jobs;
  options.commit = "test";
  return options;
}

}  // namespace phalanx::testing
