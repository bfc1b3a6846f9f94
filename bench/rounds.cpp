// SPDX-License-Identifier: Apache-2.0
#include "rounds.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "phalanx/core/random.h"
#include "phalanx/simulation/step_times.h"

namespace phalanx::bench {
namespace {

constexpr int kDraws = 400;
constexpr std::uint64_t kSeed = 1;

/// How often each round is taken.
using Weights = std::vector<std::int64_t>;

struct Value {
  double value;
  std::size_t round;
};

std::vector<Value> sorted(const Rounds& rounds) {
  std::vector<Value> all;
  for (std::size_t k = 0; k < rounds.size(); ++k)
    for (const double value : rounds[k]) all.push_back({value, k});
  std::sort(all.begin(), all.end(), [](const Value& a, const Value& b) { return a.value < b.value; });
  return all;
}

/// Nearest rank among values of which each counts as often as its round; NaN if none counts.
double weighted_percentile(const std::vector<Value>& sorted, const Weights& weights, double percent) {
  std::int64_t total = 0;
  for (const Value& each : sorted) total += weights[each.round];
  auto left = static_cast<std::int64_t>(std::ceil(percent * static_cast<double>(total) / 100.0));
  for (const Value& each : sorted) {
    left -= weights[each.round];
    if (total > 0 && left <= 0) return each.value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

double percentile(const Rounds& rounds, double percent) {
  return weighted_percentile(sorted(rounds), Weights(rounds.size(), 1), percent);
}

Ratio ratio(const Rounds& loaded, const Rounds& quiet, double percent) {
  assert(loaded.size() == quiet.size() && !quiet.empty());
  const std::vector<Value> above = sorted(loaded);
  const std::vector<Value> below = sorted(quiet);
  Random random(kSeed);
  std::vector<double> drawn;
  for (int draw = 0; draw < kDraws; ++draw) {
    Weights weights(quiet.size(), 0);
    for (std::size_t k = 0; k < weights.size(); ++k)
      ++weights[static_cast<std::size_t>(random.uniform() * static_cast<double>(weights.size()))];
    const double of_draw =
        weighted_percentile(above, weights, percent) / weighted_percentile(below, weights, percent);
    if (std::isfinite(of_draw)) drawn.push_back(of_draw);
  }
  std::sort(drawn.begin(), drawn.end());
  Ratio ratio{.value = percentile(loaded, percent) / percentile(quiet, percent)};
  if (drawn.empty()) return ratio;
  ratio.low = nearest_rank(drawn, 2.5);
  ratio.high = nearest_rank(drawn, 97.5);
  return ratio;
}

}  // namespace phalanx::bench
