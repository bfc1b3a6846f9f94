// SPDX-License-Identifier: Apache-2.0
// Scores of a trial from the digits' forces. docs/exercises.md ("Scores") has each formula with its source.
//
// The force of a digit is that of its sensor (Observation::measured_force) if all steps have it, and then
// the scores' origin is "measured". Without a sensor it is the force as sent (Observation::force), origin
// "rendered". A sensor that misses some steps makes the scores invalid. F is the sum over the task's
// digits. A value holds from its step to the next one: step i has the weight w_i = t_(i+1) - t_i, and the
// last step has none.
//
// All functions are pure, not real-time (they allocate), and always return the same names in the same order.
// Scores are invalid, with the reason in words, if why_not_scored() has one, if the torques were off or
// ramped (factor below 1) in a step, if a force is not finite, or if a digit of the task is not in `felt`:
// its force or angles are copied from another digit.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "phalanx/exercise/observation.h"
#include "phalanx/exercise/score.h"
#include "phalanx/exercise/scored_steps.h"

namespace phalanx {

/// Press and hold: the digits press with a constant target force.
struct PressAndHold {
  DigitFlags digits = {};    ///< F is the sum of their forces
  double target = 0.0;       ///< above 0 [N]
  double tolerance = 0.1;    ///< half the width of the target band over the target, 0 .. 1 [-]
  double settle_time = 1.0;  ///< mean, deviation and time in target count from then on [s]
};

/// Calculates mean_force_n, sd_force_n, cv, time_in_target_s, time_in_target_share, rise_time_s (from 10 % to
/// 90 % of the target).
/// @throws std::invalid_argument  for a task without digits, or with a number outside its range
[[nodiscard]] std::vector<Score> press_and_hold_scores(std::span<const Observation> steps,
                                                       const PressAndHold& task, const DigitFlags& felt);

/// Force tracking: the digits follow a target that moves.
struct ForceTracking {
  DigitFlags digits = {};    ///< F is the sum of their forces
  double tolerance = 0.1;    ///< half the width of the target band over the largest target, 0 .. 1 [-]
  double longest_lag = 1.0;  ///< lags from -longest_lag to longest_lag are compared, above 0 [s]
};

/// Calculates rmse_n, rrmse (RMSE over the largest target), time_in_target_s, time_in_target_share, lag_s
/// (positive: F comes later), correlation (at that lag).
/// @param target  of each step [N]
/// @throws std::invalid_argument  as press_and_hold_scores(), or if there is not one finite target
/// for each step
[[nodiscard]] std::vector<Score> force_tracking_scores(std::span<const Observation> steps,
                                                       std::span<const double> target,
                                                       const ForceTracking& task, const DigitFlags& felt);

/// Squeeze and release: the digits press as strongly as they can, then let go.
struct SqueezeAndRelease {
  DigitFlags digits = {};                  ///< F is the sum of their forces
  double least_peak = 0.5;                 ///< with a smaller peak the times are invalid, above 0 [N]
  std::optional<double> release_cue = {};  ///< since the first step: the instruction changes to "release" [s]
};

/// Calculates peak_force_n, rise_time_s (from 10 % to 90 % of the peak), release_time_s (from 90 % to 10 % of
/// the peak), release_delay_s (from the cue to 10 % of the peak; only with a cue).
/// @throws std::invalid_argument  as press_and_hold_scores()
[[nodiscard]] std::vector<Score> squeeze_and_release_scores(std::span<const Observation> steps,
                                                            const SqueezeAndRelease& task,
                                                            const DigitFlags& felt);

/// Pinch: thumb and one finger hold an object.
struct Pinch {
  int finger = 1;            ///< 1 (index) .. 4 (little)
  double least_force = 0.2;  ///< each of both digits must press at least so much to hold, above 0 [N]
};

/// Calculates hold_time_s (the longest hold), grip_force_n (mean of the smaller force in that hold),
/// force_ratio (mean force of the finger over that of the thumb, in that hold), slips (always 0: a slip of
/// either digit while it presses with least_force makes all scores invalid).
/// @throws std::invalid_argument  for a finger or number outside its range
[[nodiscard]] std::vector<Score> pinch_scores(std::span<const Observation> steps, const Pinch& task,
                                              const DigitFlags& felt);

}  // namespace phalanx
