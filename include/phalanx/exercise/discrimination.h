// SPDX-License-Identifier: Apache-2.0
// Assessment "which of two sponges is softer": an adaptive staircase that estimates the smallest
// difference of stiffness that a participant feels. docs/exercises.md, "Feel and find", has the model, its
// sources and its measured errors.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/core/random.h"
#include "phalanx/exercise/score.h"

namespace phalanx {

/// Fixed conditions of the assessment. Results of different settings are not compared.
struct DiscriminationSettings {
  int trials = 40;          ///< counted trials, 10 .. 40
  int presentations = 60;   ///< largest number of presented pairs, counted or not; >= trials
  double softest = 100.0;   ///< least stiffness that is presented [N/m]
  double stiffest = 700.0;  ///< largest stable stiffness of device and stabiliser; no pair exceeds it [N/m]
  double rove = 0.3;  ///< the pair's geometric mean is drawn within +- this about the middle, 0 .. 0.5 [ln]
  double largest_force = 3.0;  ///< no end position requires more, even at `stiffest` [N]
  double deep = 5e-3;          ///< deeper of the two end positions; less if `largest_force` demands it [m]
  double shallow_ratio = 0.7;  ///< the other end position over the deeper one, 0.5 .. 1 [-]
  double tolerance =
      0.1;  ///< largest deviation of the sent stiffness from the commanded one, 0.01 .. 0.1 [-]
};

/// One pair of sponges, in the order in which they are presented. A participant must not see the stiffness,
/// the hand or the object, and is not told whether an answer was right.
struct StiffnessPair {
  int number = 0;                        ///< of the presentation, from 1
  std::array<double, 2> stiffness{};     ///< commanded, of the first and the second sponge [N/m]
  std::array<double, 2> end_position{};  ///< depth in the sponge at which the participant is told to stop [m]
};

/// Why an answer was not counted.
enum class PairVerdict : std::uint8_t {
  kCounted,
  kSentNotKnown,  ///< no sent stiffness of a sponge was reported
  kSentDiffers,  ///< a sent stiffness deviates by more than the tolerance, in its mean or in too many samples
  kPressInvalid,  ///< a press does not count: too short, a fault, a ramp of the torque
  kNotAnswered,   ///< it was presented without an answer
};

/// A presented pair and what became of it.
struct DiscriminationTrial {
  StiffnessPair pair = {};
  std::array<double, 2> sent{};  ///< really sent, of the first and second sponge; NaN: not known [N/m]
  int answer = 0;                ///< sponge that the participant called softer, 0 or 1
  PairVerdict verdict = PairVerdict::kCounted;
  bool right = false;  ///< by the sent stiffnesses
};

/// Estimated threshold. The Weber fraction w is exp(theta) - 1, where theta is the difference of the
/// logarithms of two stiffnesses of which a participant without lapses calls the right one softer in 84.1 %
/// of the trials.
struct StiffnessThreshold {
  /// Power mean of the posterior of w with exponent -1/2: 0.2 means that a sponge must be 20 % stiffer [-]
  double weber = 0.0;
  double low = 0.0;   ///< lower end of the 95 % interval [-]
  double high = 0.0;  ///< upper end [-]
  int trials = 0;     ///< counted
  int right = 0;      ///< of these
  /// Of these: the first sponge was called softer. Far from a half, the answers prefer one of the two.
  int called_first = 0;
  int discarded = 0;  ///< presented and answered, not counted
  /// Why there is no threshold, for people: too few trials counted, answers no better than guesses, or beyond
  /// 2 to 200 %. Empty: it holds.
  std::string invalid = {};
};

/// Staircase: chooses pairs, takes answers, estimates. Bayesian, with a fixed slope and 5 % lapses. The same
/// settings, seed and answers give the same pairs and results. It knows no clock, device or thread. Not
/// real-time: call it between presentations.
class StiffnessDiscrimination {
 public:
  /// @throws std::invalid_argument naming the setting, its value and the remedy: a number out of its range,
  /// or a stable zone (`softest` .. `stiffest`) that is too narrow for a useful pair
  StiffnessDiscrimination(const DiscriminationSettings& settings, std::uint64_t seed);

  /// Returns the pair to present now: the same one until answer() or skip() is called. None when
  /// it is finished.
  [[nodiscard]] std::optional<StiffnessPair> pair() const;
  /// Takes the answer to pair().
  /// @param softer  sponge that the participant called softer: 0 the first, 1 the second
  /// @param sent    stiffness that was really sent (SentStiffness::mean()), of each sponge;
  /// NaN: not known [N/m]
  /// @param presses verdict on the presses themselves; other than kCounted, the answer does not count
  /// @throws std::invalid_argument if `softer` is neither 0 nor 1; std::logic_error after the end
  PairVerdict answer(int softer, const std::array<double, 2>& sent,
                     PairVerdict presses = PairVerdict::kCounted);
  /// Takes the present pair as presented without an answer: it counts as discarded. Does nothing
  /// after the end.
  /// @param sent  as for answer(), as far as it is known
  void skip(const std::array<double, 2>& sent = {std::numeric_limits<double>::quiet_NaN(),
                                                 std::numeric_limits<double>::quiet_NaN()});

  /// @returns true after the last counted trial, or when no further pair may be presented
  [[nodiscard]] bool finished() const noexcept;
  [[nodiscard]] int counted() const noexcept { return counted_; }
  [[nodiscard]] const std::vector<DiscriminationTrial>& trials() const noexcept { return trials_; }
  [[nodiscard]] const DiscriminationSettings& settings() const noexcept { return settings_; }
  /// Returns the present estimate; before the end it is invalid.
  [[nodiscard]] StiffnessThreshold threshold() const;

 private:
  void choose();
  [[nodiscard]] double wanted_difference() const;

  DiscriminationSettings settings_;
  Random random_;
  std::vector<std::uint8_t> conditions_;  ///< of the presentations to come, the next one last
  std::vector<double> posterior_;         ///< probability of each cell of the grid of ln theta
  std::vector<DiscriminationTrial> trials_;
  std::optional<StiffnessPair> pair_;
  int presented_ = 0;
  int counted_ = 0;
};

/// Checks a pair before it is presented. @returns why it may not be presented, for people; empty: it may
[[nodiscard]] std::string refused_pair(const StiffnessPair& pair, const DiscriminationSettings& settings);

/// Returns the threshold as scores: stiffness_threshold_percent, its interval's ends, share right. Their
/// origin is "rendered". All are invalid if the threshold is.
[[nodiscard]] std::vector<Score> threshold_scores(const StiffnessThreshold& threshold);

}  // namespace phalanx
