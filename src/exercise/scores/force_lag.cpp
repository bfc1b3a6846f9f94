// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "exercise/scores/trial_values.h"
#include "phalanx/exercise/reasons.h"

namespace phalanx {
namespace {

constexpr double kLeastChange = 1e-6;     ///< a signal that changes less is constant [N]
constexpr double kLeastProduct = 1e-24;   ///< of both sums of squares; below it r is 0 [N^4]
constexpr double kEqual = 1e-9;           ///< correlations that differ less are equal [-]
constexpr double kLeastCurvature = 1e-6;  ///< of r between neighbours, to refine the lag [-]

/// Returns Pearson's correlation of the pairs, 0 if one of both is constant.
double correlation(std::span<const double> a, std::span<const double> b) {
  const auto n = static_cast<double>(a.size());
  double mean_a = 0.0;
  double mean_b = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean_a += a[i] / n;
    mean_b += b[i] / n;
  }
  double aa = 0.0;
  double bb = 0.0;
  double ab = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
    ab += (a[i] - mean_a) * (b[i] - mean_b);
  }
  return aa * bb <= kLeastProduct ? 0.0 : ab / std::sqrt(aa * bb);
}

double change(const std::vector<double>& signal) {
  const auto [low, high] = std::minmax_element(signal.begin(), signal.end());
  return *high - *low;
}

}  // namespace

ForceLag find_lag(const std::vector<double>& force, const std::vector<double>& target, double longest_lag) {
  const auto most = static_cast<int>(longest_lag * kScoreRate + 1e-9);
  const auto points = static_cast<int>(force.size());
  if (most < 1) return {.why = reason_text<Reason::kLagBelowStep>()};
  if (points - 1 < 2 * most) return {.why = reason_text<Reason::kShorterThanLag>(longest_lag)};
  if (change(target) < kLeastChange) return {.why = reason_text<Reason::kTargetDoesNotMove>()};
  if (change(force) < kLeastChange) return {.why = reason_text<Reason::kForceDoesNotChange>()};

  // Pairs force[k + lag], target[k]; r of a lag is at lag + most.
  std::vector<double> r;
  for (int lag = -most; lag <= most; ++lag) {
    const auto pairs = static_cast<std::size_t>(points - std::abs(lag));
    r.push_back(correlation(std::span(force).subspan(static_cast<std::size_t>(std::max(lag, 0)), pairs),
                            std::span(target).subspan(static_cast<std::size_t>(std::max(-lag, 0)), pairs)));
  }
  const auto at = [&](int lag) { return r[static_cast<std::size_t>(lag + most)]; };
  const double best = *std::max_element(r.begin(), r.end());
  int lag = 0;
  while (at(lag) < best - kEqual) lag = lag > 0 ? -lag : 1 - lag;  // 0, 1, -1, 2, -2, ..
  double part = 0.0;
  if (std::abs(lag) < most) {
    const double curvature = at(lag - 1) - 2.0 * at(lag) + at(lag + 1);
    if (curvature < -kLeastCurvature)
      part = std::clamp(0.5 * (at(lag - 1) - at(lag + 1)) / curvature, -0.5, 0.5);
  }
  return {.seconds = (lag + part) / kScoreRate, .correlation = at(lag), .why = {}};
}

}  // namespace phalanx
