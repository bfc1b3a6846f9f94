// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/step_times.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace phalanx {

double nearest_rank(const std::vector<double>& sorted, double percent) {
  assert(!sorted.empty() && percent > 0.0 && percent <= 100.0);
  // percent * n is exact for the percentiles in use, so that rounding does not raise a whole rank.
  const double rank = std::ceil(percent * static_cast<double>(sorted.size()) / 100.0);
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

StepTimes step_times(std::vector<double> step_us) {
  if (step_us.empty()) return {};
  std::sort(step_us.begin(), step_us.end());
  const double sum = std::accumulate(step_us.begin(), step_us.end(), 0.0);
  return {.p50 = nearest_rank(step_us, 50.0),
          .p90 = nearest_rank(step_us, 90.0),
          .p99 = nearest_rank(step_us, 99.0),
          .p999 = nearest_rank(step_us, 99.9),
          .max = step_us.back(),
          .mean = sum / static_cast<double>(step_us.size())};
}

}  // namespace phalanx
