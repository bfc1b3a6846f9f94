// SPDX-License-Identifier: Apache-2.0
// Values of a trial that several scores use: weights of the steps, forces with their origin, joints that are
// measured, the lag of a force behind its target, and values that were held for a time.
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/exercise/observation.h"
#include "phalanx/exercise/score.h"
#include "phalanx/exercise/scored_steps.h"

namespace phalanx {

/// Name and unit of a score.
struct ScoreName {
  std::string name;
  std::string unit;
};

[[nodiscard]] Score valid_score(const ScoreName& name, double value, ScoreOrigin origin);
/// The value of an invalid score is NaN, so that no later sum can use it.
[[nodiscard]] Score invalid_score(const ScoreName& name, ScoreOrigin origin, std::string why);
/// Returns all scores as invalid for the same reason.
[[nodiscard]] std::vector<Score> invalid_scores(std::span<const ScoreName> names, ScoreOrigin origin,
                                                const std::string& why);

/// @throws std::invalid_argument  naming the parameter, its value and its range, unless low < value <= high
/// (or low <= value)
void check_above(std::string_view name, double value, double low, double high);
void check_between(std::string_view name, double value, double low, double high);
/// @throws std::invalid_argument  for a digit or a joint that does not exist
void check_digit(std::string_view name, int digit, int first = 0);
void check_joint(int joint);

[[nodiscard]] int digit_count(const DigitFlags& digits) noexcept;

/// Returns the weights t_(i+1) - t_i of the steps [s]; the last one is 0.
[[nodiscard]] std::vector<double> step_weights(std::span<const Observation> steps);
/// Returns sum(w x) / sum(w). @pre the sum of the weights is above 0
[[nodiscard]] double weighted_mean(std::span<const double> weight, std::span<const double> value);

/// Forces of a trial's digits, or why there are none.
struct TrialForces {
  ScoreOrigin origin = ScoreOrigin::kRendered;
  std::string invalid;                                  ///< for people; empty: there are forces
  std::array<std::vector<double>, kDigits> of_digit{};  ///< of the task's digits [N]
  [[nodiscard]] std::vector<double> sum(const DigitFlags& digits) const;  ///< [N]
};

/// Reads the forces of digits by the rules in force_scores.h. @param felt  as there
[[nodiscard]] TrialForces trial_forces(std::span<const Observation> steps, const DigitFlags& digits,
                                       const DigitFlags& felt);

/// Returns why angles of these joints cannot be scored, for people; empty: all are measured and finite
/// in all steps.
[[nodiscard]] std::string why_not_measured(std::span<const Observation> steps, std::span<const int> joints);

/// Returns the joints whose sum is the digit's flexion: MCP, PIP and DIP of a finger, MCP and IP
/// of the thumb.
[[nodiscard]] std::vector<int> flexion_joints(int digit);
/// Returns the sum of these joints' angles at each step [rad].
[[nodiscard]] std::vector<double> angle_sum(std::span<const Observation> steps, std::span<const int> joints);

/// Rate at which signals are interpolated for correlations and spectra [Hz].
inline constexpr double kScoreRate = 100.0;
/// Interpolates linearly at t_0 + k / kScoreRate, k = 0 .. floor((t_last - t_0) kScoreRate + 1e-9).
/// @param time  two or more, strictly increasing [s]
[[nodiscard]] std::vector<double> resample(std::span<const double> time, std::span<const double> value);
/// Returns the times of the steps [s].
[[nodiscard]] std::vector<double> step_times(std::span<const Observation> steps);

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

/// Returns the largest value that was held:  max over i of min{x_k : t_i <= t_k <= t_i + hold}, where
/// t_i + hold <= t_last. Nothing if the steps do not span the hold. Takes time in proportion to the
/// number of steps.
/// @param value  of each step  @param hold  [s]
[[nodiscard]] std::optional<double> held_maximum(std::span<const Observation> steps,
                                                 std::span<const double> value, double hold);
/// Returns the smallest value that was held:  min over i of max{x_k : t_i <= t_k <= t_i + hold}.
[[nodiscard]] std::optional<double> held_minimum(std::span<const Observation> steps,
                                                 std::span<const double> value, double hold);

/// Samples of the device in a trial: a step without a new one repeats the last one's angles.
struct TrialSamples {
  std::vector<std::size_t> step = {};  ///< numbers of the steps that have a new sample, and of the first step
  std::vector<double> time = {};       ///< Observation::sample_time of these steps, strictly increasing [s]
  /// Why speeds cannot be scored, for people: times of samples that are not known or do not increase, or
  /// fewer than kLeastSampleRate. Empty: they can
  std::string invalid = {};
};
/// Least number of samples a second for scores of speed: twice the upper frequency of SPARC [Hz].
inline constexpr double kLeastSampleRate = 20.0;
[[nodiscard]] TrialSamples trial_samples(std::span<const Observation> steps);

}  // namespace phalanx
