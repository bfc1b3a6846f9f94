// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "exercise/scores/trial_values.h"
#include "phalanx/core/index.h"
#include "phalanx/exercise/force_scores.h"
#include "phalanx/exercise/reasons.h"

namespace phalanx {
namespace {

/// Steps from `first` on, up to but without `end`, in which both digits hold.
struct Hold {
  std::size_t first = 0;
  std::size_t end = 0;
  double seconds = 0.0;
};

/// Finds the longest hold, of equal ones the first. The last step has no length.
template <typename Holds>
Hold longest_hold(std::span<const Observation> steps, const Holds& holds) {
  Hold best;
  std::size_t i = 0;
  while (i < steps.size()) {
    if (!holds(i)) {
      ++i;
      continue;
    }
    Hold hold{.first = i, .end = i, .seconds = 0.0};
    while (hold.end < steps.size() && holds(hold.end)) ++hold.end;
    hold.seconds = steps[std::min(hold.end, steps.size() - 1)].time - steps[hold.first].time;
    if (hold.seconds > best.seconds) best = hold;
    i = hold.end;
  }
  return best;
}

/// Returns why the trial does not count, with the number of onsets of a slip and the first one's time;
/// empty: nothing slipped. A digit that slides along the object without holding it, with less than `least`
/// [N], does not slip.
std::string why_slipped(std::span<const Observation> steps, const DigitFlags& digits,
                        const TrialForces& forces, double least) {
  int onsets = 0;
  double first = 0.0;
  for (std::size_t digit = 0; digit < kDigits; ++digit) {
    if (!digits[digit]) continue;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const auto slips = [&](std::size_t step) {
        return steps[step].slips[digit] && forces.of_digit[digit][step] >= least;
      };
      if (!slips(i) || (i > 0 && slips(i - 1))) continue;
      if (onsets == 0 || steps[i].time < first) first = steps[i].time;
      ++onsets;
    }
  }
  if (onsets == 0) return {};
  return onsets == 1 ? reason_text<Reason::kSlippedOnce>(first)
                     : reason_text<Reason::kSlippedOften>(onsets, first);
}

}  // namespace

std::vector<Score> pinch_scores(std::span<const Observation> steps, const Pinch& task,
                                const DigitFlags& felt) {
  check_digit("finger", task.finger, 1);
  check_above("least_force", task.least_force, 0.0, 1000.0);
  const std::array<ScoreName, 4> names = {
      {{"hold_time_s", "s"}, {"grip_force_n", "N"}, {"force_ratio", "-"}, {"slips", "-"}}};
  DigitFlags digits{};
  digits[0] = true;
  digits[idx(task.finger)] = true;
  TrialForces forces = trial_forces(steps, digits, felt);
  if (forces.invalid.empty()) forces.invalid = why_slipped(steps, digits, forces, task.least_force);
  if (!forces.invalid.empty()) return invalid_scores(names, forces.origin, forces.invalid);

  const std::vector<double>& thumb = forces.of_digit[0];
  const std::vector<double>& finger = forces.of_digit[idx(task.finger)];
  const Hold hold = longest_hold(steps, [&](std::size_t i) {
    return steps[i].touching[0] && steps[i].touching[idx(task.finger)] && thumb[i] >= task.least_force &&
           finger[i] >= task.least_force;
  });
  const ScoreOrigin origin = forces.origin;
  const Score time = valid_score(names[0], hold.seconds, origin);
  const Score slips = valid_score(names[3], 0.0, origin);
  if (!(hold.seconds > 0.0)) {
    const std::string why = reason_text<Reason::kNeverHeld>(task.least_force);
    return {time, invalid_score(names[1], origin, why), invalid_score(names[2], origin, why), slips};
  }
  const std::size_t length = hold.end - hold.first;
  std::vector<double> smaller;
  for (std::size_t i = hold.first; i < hold.end; ++i) smaller.push_back(std::min(thumb[i], finger[i]));
  const std::vector<double> weights = step_weights(steps);
  const std::span<const double> weight = std::span(weights).subspan(hold.first, length);
  const double of_thumb = weighted_mean(weight, std::span(thumb).subspan(hold.first, length));
  const double of_finger = weighted_mean(weight, std::span(finger).subspan(hold.first, length));
  return {time, valid_score(names[1], weighted_mean(weight, smaller), origin),
          valid_score(names[2], of_finger / of_thumb, origin), slips};
}

}  // namespace phalanx
