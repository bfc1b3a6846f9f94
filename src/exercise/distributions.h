// SPDX-License-Identifier: Apache-2.0
// Cumulative distributions that psychophysics needs.
#pragma once

#include <cmath>
#include <numbers>

namespace phalanx {

/// Returns Phi(x), the probability that a normal number with mean 0 and standard deviation 1 is at most x.
[[nodiscard]] inline double normal_probability(double x) noexcept {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

/// Returns P(X >= successes) of a binomial X with `trials` trials of probability p, as a sum of its terms.
/// @pre 0 <= p <= 1, trials >= 0
[[nodiscard]] inline double binomial_at_least(int successes, int trials, double p) noexcept {
  if (successes <= 0) return 1.0;
  if (successes > trials || p <= 0.0) return 0.0;
  if (p >= 1.0) return 1.0;
  double sum = 0.0;
  for (int k = successes; k <= trials; ++k) {
    const double log_ways = std::lgamma(trials + 1.0) - std::lgamma(k + 1.0) - std::lgamma(trials - k + 1.0);
    sum += std::exp(log_ways + k * std::log(p) + (trials - k) * std::log1p(-p));
  }
  return sum < 1.0 ? sum : 1.0;
}

}  // namespace phalanx
