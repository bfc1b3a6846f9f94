// SPDX-License-Identifier: Apache-2.0
// Simulated observers of known thresholds, and how far the staircase's estimates are from them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "phalanx/core/random.h"
#include "phalanx/exercise/discrimination.h"
#include "phalanx/exercise/participant_skill.h"

namespace phalanx::test {

/// How observers are drawn.
struct ObserverStudy {
  int observers = 500;
  std::uint64_t seed = 0;
  double least = 0.05;  ///< thresholds are drawn log-uniformly from here [-]
  double most = 0.8;    ///< to here [-]
  ParticipantSkill skill = {.lapses = 0.05, .slope = 1.0};
  double deviation = 0.0;  ///< of the sent stiffness from the commanded one, uniform [-]
  double lost = 0.0;       ///< share of the presentations whose presses do not count [-]
  DiscriminationSettings settings = {};
};

/// Estimates of all observers.
struct ObserverErrors {
  double mean_relative = 0.0;   ///< mean of estimate / threshold - 1
  double geometric = 0.0;       ///< exp(mean of ln(estimate / threshold)) - 1
  double median = 0.0;          ///< of estimate / threshold - 1
  double spread = 0.0;          ///< standard deviation of ln(estimate / threshold)
  double interval_ratio = 0.0;  ///< geometric mean of the intervals' upper over lower end
  double covered = 0.0;         ///< share of the observers whose interval holds the threshold
  double invalid = 0.0;         ///< share without a result; not covered, and left out of the errors
  int most_presented = 0;       ///< pairs that were presented to one observer, counted or not
};

/// Runs one observer to its end.
inline StiffnessDiscrimination observed(const ObserverStudy& study, const ParticipantSkill& skill,
                                        Random& random, std::uint64_t seed) {
  StiffnessDiscrimination staircase(study.settings, seed);
  while (const auto pair = staircase.pair()) {
    std::array<double, 2> sent = pair->stiffness;
    for (double& each : sent) each *= 1.0 + study.deviation * random.between(-1.0, 1.0);
    const bool counts = study.lost <= 0.0 || random.uniform() >= study.lost;
    staircase.answer(calls_first_softer(skill, sent[0], sent[1], random) ? 0 : 1, sent,
                     counts ? PairVerdict::kCounted : PairVerdict::kPressInvalid);
  }
  return staircase;
}

inline ObserverErrors measure(const ObserverStudy& study) {
  ObserverErrors out;
  std::vector<double> ratios;
  double log_sum = 0.0;
  double log_squares = 0.0;
  double width = 0.0;
  Random thresholds(study.seed);
  for (int i = 0; i < study.observers; ++i) {
    ParticipantSkill skill = study.skill;
    skill.weber = std::exp(thresholds.between(std::log(study.least), std::log(study.most)));
    const std::uint64_t own = study.seed * 1'000'003U + static_cast<std::uint64_t>(i);
    Random answers(own ^ 0x5bd1e995U);
    const StiffnessDiscrimination staircase = observed(study, skill, answers, own);
    const StiffnessThreshold result = staircase.threshold();
    out.most_presented = std::max(out.most_presented, static_cast<int>(staircase.trials().size()));
    if (!result.invalid.empty()) {
      out.invalid += 1.0 / study.observers;
      continue;
    }
    const double ratio = result.weber / skill.weber;
    ratios.push_back(ratio);
    log_sum += std::log(ratio);
    log_squares += std::log(ratio) * std::log(ratio);
    width += std::log(result.high / result.low);
    if (result.low <= skill.weber && skill.weber <= result.high) out.covered += 1.0 / study.observers;
  }
  if (ratios.empty()) return out;
  const auto n = static_cast<double>(ratios.size());
  for (const double ratio : ratios) out.mean_relative += (ratio - 1.0) / n;
  std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2),
                   ratios.end());
  out.median = ratios[ratios.size() / 2] - 1.0;
  out.geometric = std::exp(log_sum / n) - 1.0;
  out.spread = std::sqrt(std::max(0.0, log_squares / n - log_sum * log_sum / n / n));
  out.interval_ratio = std::exp(width / n);
  return out;
}

}  // namespace phalanx::test
