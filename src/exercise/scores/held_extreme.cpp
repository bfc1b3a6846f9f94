// SPDX-License-Identifier: Apache-2.0
#include "exercise/scores/trial_values.h"

#include <cstddef>
#include <deque>
#include <functional>

namespace phalanx {
namespace {

/// Finds the best of all windows' worst values. @param better  std::greater: the largest is best;
/// std::less: the smallest
template <typename Better>
std::optional<double> held_best(std::span<const Observation> steps, std::span<const double> value,
                                double hold, const Better& better) {
  std::optional<double> best;
  std::deque<std::size_t>
      worst;  // steps of the window, from the worst value on; each next one is better and later
  std::size_t end = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double until = steps[i].time + hold;
    if (!(until <= steps.back().time)) break;
    for (; end < steps.size() && steps[end].time <= until; ++end) {
      while (!worst.empty() && !better(value[end], value[worst.back()])) worst.pop_back();
      worst.push_back(end);
    }
    while (worst.front() < i) worst.pop_front();
    const double held = value[worst.front()];
    if (!best || better(held, *best)) best = held;
  }
  return best;
}

}  // namespace

std::optional<double> held_maximum(std::span<const Observation> steps, std::span<const double> value,
                                   double hold) {
  return held_best(steps, value, hold, std::greater<>());
}

std::optional<double> held_minimum(std::span<const Observation> steps, std::span<const double> value,
                                   double hold) {
  return held_best(steps, value, hold, std::less<>());
}

}  // namespace phalanx
