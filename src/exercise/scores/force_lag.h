// SPDX-License-Identifier: Apache-2.0
// Lag of a force behind its target, by cross-correlation.
#pragma once

#include <string>
#include <vector>

namespace phalanx {

/// Lag of one signal behind another, or why there is none.
struct ForceLag {
  double seconds = 0.0;      ///< positive: the force comes later
  double correlation = 0.0;  ///< Pearson's, at the whole step of the lag [-]
  std::string why = {};      ///< for people; empty: there is a lag
};

/// Finds the lag with the largest correlation. Both signals have kScoreRate. docs/exercises.md ("Force
/// tracking") has the rule.
/// @param longest_lag  [s]
[[nodiscard]] ForceLag find_lag(const std::vector<double>& force, const std::vector<double>& target,
                                double longest_lag);

}  // namespace phalanx
