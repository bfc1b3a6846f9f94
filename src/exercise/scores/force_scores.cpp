// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/force_scores.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "exercise/scores/trial_values.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/exercise/reasons.h"

namespace phalanx {
namespace {

constexpr double kLow = 0.1;           ///< lower level of rise and release times, as a share
constexpr double kHigh = 0.9;          ///< upper level
constexpr double kMostForce = 1000.0;  ///< largest force that a parameter may state [N]

void check_digits(const DigitFlags& digits) {
  if (digit_count(digits) < 1) throw std::invalid_argument("the task has no digits; name one at least");
}

/// Time from 10 % to 90 % of a level, or why there is none.
struct RiseTime {
  double seconds = 0.0;
  std::string why = {};
};

/// Finds the first step that reaches 90 % of the level, and before it the last rise above 10 %.
RiseTime find_rise(std::span<const Observation> steps, const std::vector<double>& force, double level) {
  const auto high = std::find_if(force.begin(), force.end(), [&](double f) { return f >= kHigh * level; });
  if (high == force.end()) return {.why = reason_text<Reason::kRiseNotReached>(level)};
  auto begin = high;
  while (begin != force.begin() && *(begin - 1) >= kLow * level) --begin;
  if (begin == force.begin()) return {.why = reason_text<Reason::kRiseBeganHigh>(level)};
  const auto time = [&](auto at) { return steps[static_cast<std::size_t>(at - force.begin())].time; };
  return {.seconds = time(high) - time(begin), .why = {}};
}

Score time_score(const ScoreName& name, const RiseTime& time, ScoreOrigin origin) {
  return time.why.empty() ? valid_score(name, time.seconds, origin) : invalid_score(name, origin, time.why);
}

/// Returns the time for which the force is within `half_width` of its target [s].
double time_in_band(std::span<const double> weight, std::span<const double> force,
                    std::span<const double> target, double half_width) {
  double inside = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i)
    if (std::abs(force[i] - target[i]) <= half_width) inside += weight[i];
  return inside;
}

double total(std::span<const double> weight) {
  double sum = 0.0;
  for (const double w : weight) sum += w;
  return sum;
}

/// Returns sqrt(sum(w (x - reference)^2) / sum(w)).
double rms_about(std::span<const double> weight, std::span<const double> value,
                 std::span<const double> reference) {
  std::vector<double> square(value.size());
  for (std::size_t i = 0; i < value.size(); ++i)
    square[i] = (value[i] - reference[i]) * (value[i] - reference[i]);
  return std::sqrt(weighted_mean(weight, square));
}

}  // namespace

std::vector<Score> press_and_hold_scores(std::span<const Observation> steps, const PressAndHold& task,
                                         const DigitFlags& felt) {
  check_digits(task.digits);
  check_above("target", task.target, 0.0, kMostForce);
  check_between("tolerance", task.tolerance, 0.0, 1.0);
  check_between("settle_time", task.settle_time, 0.0, kLongestTrial);
  const std::array<ScoreName, 6> names = {{{"mean_force_n", "N"},
                                           {"sd_force_n", "N"},
                                           {"cv", "-"},
                                           {"time_in_target_s", "s"},
                                           {"time_in_target_share", "-"},
                                           {"rise_time_s", "s"}}};
  const TrialForces forces = trial_forces(steps, task.digits, felt);
  if (!forces.invalid.empty()) return invalid_scores(names, forces.origin, forces.invalid);
  const auto settled = std::find_if(steps.begin(), steps.end(), [&](const Observation& step) {
    return step.time - steps.front().time >= task.settle_time;
  });
  const auto first = static_cast<std::size_t>(settled - steps.begin());
  if (first + 1 >= steps.size())
    return invalid_scores(names, forces.origin,
                          reason_text<Reason::kNotLongerThanSettling>(task.settle_time));

  const std::vector<double> force = forces.sum(task.digits);
  const std::vector<double> weights = step_weights(steps);
  const std::span<const double> held = std::span(force).subspan(first);
  const std::span<const double> weight = std::span(weights).subspan(first);
  const double mean = weighted_mean(weight, held);
  const double deviation = rms_about(weight, held, std::vector<double>(held.size(), mean));
  const double inside =
      time_in_band(weight, held, std::vector<double>(held.size(), task.target), task.tolerance * task.target);
  const ScoreOrigin origin = forces.origin;
  return {valid_score(names[0], mean, origin),
          valid_score(names[1], deviation, origin),
          mean > 0.0 ? valid_score(names[2], deviation / mean, origin)
                     : invalid_score(names[2], origin, reason_text<Reason::kMeanForceNotPositive>()),
          valid_score(names[3], inside, origin),
          valid_score(names[4], inside / total(weight), origin),
          time_score(names[5], find_rise(steps, force, task.target), origin)};
}

std::vector<Score> force_tracking_scores(std::span<const Observation> steps, std::span<const double> target,
                                         const ForceTracking& task, const DigitFlags& felt) {
  check_digits(task.digits);
  check_between("tolerance", task.tolerance, 0.0, 1.0);
  check_above("longest_lag", task.longest_lag, 0.0, 60.0);
  if (target.size() != steps.size())
    throw std::invalid_argument(
        fmt::format("there are {} targets for {} steps; state one for each", target.size(), steps.size()));
  for (const double each : target) check_between("a target", each, 0.0, kMostForce);
  const std::array<ScoreName, 6> names = {{{"rmse_n", "N"},
                                           {"rrmse", "-"},
                                           {"time_in_target_s", "s"},
                                           {"time_in_target_share", "-"},
                                           {"lag_s", "s"},
                                           {"correlation", "-"}}};
  const TrialForces forces = trial_forces(steps, task.digits, felt);
  if (!forces.invalid.empty()) return invalid_scores(names, forces.origin, forces.invalid);
  const double largest = *std::max_element(target.begin(), target.end());
  if (!(largest > 0.0)) return invalid_scores(names, forces.origin, reason_text<Reason::kTargetAllZero>());

  const std::vector<double> force = forces.sum(task.digits);
  const std::vector<double> weight = step_weights(steps);
  const double error = rms_about(weight, force, target);
  const double inside = time_in_band(weight, force, target, task.tolerance * largest);
  const std::vector<double> time = step_times(steps);
  const ForceLag lag = find_lag(resample(time, force), resample(time, target), task.longest_lag);
  const ScoreOrigin origin = forces.origin;
  const auto lag_score = [&](const ScoreName& name, double value) {
    return lag.why.empty() ? valid_score(name, value, origin) : invalid_score(name, origin, lag.why);
  };
  return {valid_score(names[0], error, origin),  valid_score(names[1], error / largest, origin),
          valid_score(names[2], inside, origin), valid_score(names[3], inside / total(weight), origin),
          lag_score(names[4], lag.seconds),      lag_score(names[5], lag.correlation)};
}

std::vector<Score> squeeze_and_release_scores(std::span<const Observation> steps,
                                              const SqueezeAndRelease& task, const DigitFlags& felt) {
  check_digits(task.digits);
  check_above("least_peak", task.least_peak, 0.0, kMostForce);
  if (task.release_cue) check_between("release_cue", *task.release_cue, 0.0, kLongestTrial);
  std::vector<ScoreName> names = {{"peak_force_n", "N"}, {"rise_time_s", "s"}, {"release_time_s", "s"}};
  if (task.release_cue) names.push_back({"release_delay_s", "s"});
  const TrialForces forces = trial_forces(steps, task.digits, felt);
  if (!forces.invalid.empty()) return invalid_scores(names, forces.origin, forces.invalid);

  const std::vector<double> force = forces.sum(task.digits);
  const double peak = *std::max_element(force.begin(), force.end());
  std::vector<Score> scores = {valid_score(names[0], peak, forces.origin)};
  if (!(peak >= task.least_peak)) {
    const std::string why = reason_text<Reason::kPeakBelowLeast>(peak, task.least_peak);
    for (std::size_t i = 1; i < names.size(); ++i)
      scores.push_back(invalid_score(names[i], forces.origin, why));
    return scores;
  }
  scores.push_back(time_score(names[1], find_rise(steps, force, peak), forces.origin));

  // The force falls below 90 % for the last time at `leaves`, and then below 10 % at `released`.
  std::size_t leaves = force.size();
  while (!(force[leaves - 1] >= kHigh * peak)) --leaves;
  std::size_t released = leaves;
  while (released < force.size() && !(force[released] < kLow * peak)) ++released;
  RiseTime release;
  if (released == force.size())
    release.why = reason_text<Reason::kNotReleased>();
  else
    release.seconds = steps[released].time - steps[leaves].time;
  scores.push_back(time_score(names[2], release, forces.origin));
  if (!task.release_cue) return scores;

  RiseTime delay{.seconds = 0.0, .why = release.why};
  if (delay.why.empty()) {
    delay.seconds = steps[released].time - steps.front().time - *task.release_cue;
    if (delay.seconds < 0.0) delay.why = reason_text<Reason::kReleasedBeforeCue>();
  }
  scores.push_back(time_score(names[3], delay, forces.origin));
  return scores;
}

}  // namespace phalanx
