// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace phalanx {

/// Percentiles of the wall time of step() [us]; all are zero if there were no steps.
struct StepTimes {
  double p50 = 0.0;
  double p90 = 0.0;
  double p99 = 0.0;
  double p999 = 0.0;
  double max = 0.0;
  double mean = 0.0;  ///< only for comparison with the papers, which print an average
};

/// @returns the nearest-rank percentile: the smallest value such that at least `percent` of all values do
/// not exceed it.
/// @param sorted   not empty, in increasing order
/// @param percent  in (0, 100]
[[nodiscard]] double nearest_rank(const std::vector<double>& sorted, double percent);

/// Computes the percentiles of step times.
/// @param step_us  one time a step [us], in any order
[[nodiscard]] StepTimes step_times(std::vector<double> step_us);

}  // namespace phalanx
