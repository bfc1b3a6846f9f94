// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "exercise/scores/trial_values.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/exercise/reasons.h"
#include "phalanx/exercise/scored_steps.h"
#include "phalanx/exercise/smoothness.h"

namespace phalanx {
namespace {

constexpr double kMoves = 0.05;          ///< speed at begin and end of the movement, as a share of the peak
constexpr double kPeakChange = 0.1;      ///< rise and fall about a peak of speed, likewise
constexpr std::size_t kLeastPoints = 4;  ///< of a movement

/// Returns the flexion at kScoreRate, interpolated between samples [rad].
std::vector<double> flexion_of(std::span<const Observation> steps, const TrialSamples& samples, int digit) {
  const std::vector<double> angle = angle_sum(steps, flexion_joints(digit));
  std::vector<double> sampled;
  sampled.reserve(samples.step.size());
  for (const std::size_t i : samples.step) sampled.push_back(angle[i]);
  return resample(samples.time, sampled);
}

/// Returns the speed: by central differences, by one-sided ones at both ends [rad/s].
std::vector<double> speed_of(const std::vector<double>& path) {
  std::vector<double> speed;
  speed.reserve(path.size());
  for (std::size_t k = 0; k < path.size(); ++k) {
    const std::size_t before = k == 0 ? 0 : k - 1;
    const std::size_t after = std::min(k + 1, path.size() - 1);
    speed.push_back(std::abs(path[after] - path[before]) * kScoreRate / static_cast<double>(after - before));
  }
  return speed;
}

/// Counts peaks of the speed: maxima before which it rose, and after which it fell, by `change` at least. The
/// movement's begin and end count as rise and fall.
int count_peaks(std::span<const double> speed, double change) {
  int peaks = 0;
  bool rises = true;
  double high = speed.front();
  double low = speed.front();
  for (const double v : speed) {
    high = std::max(high, v);
    low = std::min(low, v);
    if (rises && v < high - change) {
      ++peaks;
      rises = false;
      low = v;
    } else if (!rises && v > low + change) {
      rises = true;
      high = v;
    }
  }
  return rises ? peaks + 1 : peaks;
}

}  // namespace

std::vector<Score> smoothness_scores(std::span<const Observation> steps, const FreeMovement& task) {
  check_digit("digit", task.digit);
  check_above("least_speed", task.least_speed, 0.0, 1000.0);
  const std::array<ScoreName, 4> names = {
      {{"sparc", "-"}, {"movement_time_s", "s"}, {"peak_speed_deg_per_s", "deg/s"}, {"speed_peaks", "-"}}};
  std::string why = why_not_scored(steps);
  if (why.empty()) why = why_not_measured(steps, flexion_joints(task.digit));
  TrialSamples samples;
  if (why.empty()) samples = trial_samples(steps);
  if (why.empty()) why = samples.invalid;
  if (!why.empty()) return invalid_scores(names, ScoreOrigin::kMeasured, why);
  const std::vector<double> flexion = flexion_of(steps, samples, task.digit);
  if (flexion.size() < kLeastPoints)
    return invalid_scores(
        names, ScoreOrigin::kMeasured,
        reason_text<Reason::kShorterThanSpeed>(static_cast<double>(kLeastPoints - 1) / kScoreRate));

  const std::vector<double> speed = speed_of(flexion);
  const double peak = *std::max_element(speed.begin(), speed.end());
  if (!(peak >= task.least_speed))
    return invalid_scores(
        names, ScoreOrigin::kMeasured,
        reason_text<Reason::kSpeedBelowLeast>(peak * kRadToDeg, task.least_speed * kRadToDeg));
  const auto moves = [&](double v) { return v >= kMoves * peak; };
  const auto first =
      static_cast<std::size_t>(std::find_if(speed.begin(), speed.end(), moves) - speed.begin());
  std::size_t last = speed.size() - 1;
  while (!moves(speed[last])) --last;
  if (last - first + 1 < kLeastPoints)
    return invalid_scores(names, ScoreOrigin::kMeasured, reason_text<Reason::kMovementTooShort>());

  const std::span<const double> movement = std::span(speed).subspan(first, last - first + 1);
  return {valid_score(names[0], spectral_arc_length(movement, kScoreRate), ScoreOrigin::kMeasured),
          valid_score(names[1], static_cast<double>(last - first) / kScoreRate, ScoreOrigin::kMeasured),
          task.calibration_independent ? valid_score(names[2], peak * kRadToDeg, ScoreOrigin::kMeasured)
                                       : invalid_score(names[2], ScoreOrigin::kMeasured,
                                                       reason_text<Reason::kCalibrationDependsByMethod>()),
          valid_score(names[3], count_peaks(movement, kPeakChange * peak), ScoreOrigin::kMeasured)};
}

}  // namespace phalanx
