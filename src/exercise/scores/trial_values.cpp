// SPDX-License-Identifier: Apache-2.0
#include "exercise/scores/trial_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "phalanx/core/index.h"
#include "phalanx/exercise/reasons.h"

namespace phalanx {
namespace {

/// How many steps have a value of the digit's force sensor.
std::size_t sensed_steps(std::span<const Observation> steps, std::size_t digit) {
  return static_cast<std::size_t>(std::count_if(steps.begin(), steps.end(), [&](const Observation& step) {
    return !std::isnan(step.measured_force[digit]);
  }));
}

bool all_sensed(std::span<const Observation> steps, const DigitFlags& digits) {
  for (std::size_t digit = 0; digit < kDigits; ++digit)
    if (digits[digit] && sensed_steps(steps, digit) != steps.size()) return false;
  return true;
}

std::string why_no_forces(std::span<const Observation> steps, const DigitFlags& digits,
                          const DigitFlags& felt) {
  for (int digit = 0; digit < kDigits; ++digit)
    if (digits[idx(digit)] && !felt[idx(digit)])
      return reason_text<Reason::kNoForceOfDigitAlone>(digit_name(digit));
  for (const Observation& step : steps) {
    if (!step.torque_on) return reason_text<Reason::kTorquesOffAt>(step.time);
    if (!(step.factor >= 1.0)) return reason_text<Reason::kTorquesRampedAt>(step.time, step.factor);
  }
  for (int digit = 0; digit < kDigits; ++digit) {
    const std::size_t sensed = sensed_steps(steps, idx(digit));
    if (digits[idx(digit)] && sensed > 0 && sensed < steps.size())
      return reason_text<Reason::kForceSensorGaps>(digit_name(digit), steps.size() - sensed, steps.size());
  }
  return {};
}

std::string why_not_finite(const std::array<std::vector<double>, kDigits>& forces,
                           std::span<const Observation> steps) {
  for (int digit = 0; digit < kDigits; ++digit)
    for (std::size_t i = 0; i < forces[idx(digit)].size(); ++i)
      if (!std::isfinite(forces[idx(digit)][i]))
        return reason_text<Reason::kForceNotFinite>(digit_name(digit), steps[i].time);
  return {};
}

}  // namespace

Score valid_score(const ScoreName& name, double value, ScoreOrigin origin) {
  if (!std::isfinite(value)) return invalid_score(name, origin, reason_text<Reason::kScoreNotFinite>());
  return {.name = name.name, .unit = name.unit, .value = value, .origin = origin, .invalid = {}};
}

Score invalid_score(const ScoreName& name, ScoreOrigin origin, std::string why) {
  return {.name = name.name,
          .unit = name.unit,
          .value = std::numeric_limits<double>::quiet_NaN(),
          .origin = origin,
          .invalid = std::move(why)};
}

std::vector<Score> invalid_scores(std::span<const ScoreName> names, ScoreOrigin origin,
                                  const std::string& why) {
  std::vector<Score> scores;
  for (const ScoreName& name : names) scores.push_back(invalid_score(name, origin, why));
  return scores;
}

void check_above(std::string_view name, double value, double low, double high) {
  if (!(value > low && value <= high))
    throw std::invalid_argument(
        fmt::format("{} is {}; write a number above {} and at most {}", name, value, low, high));
}

void check_between(std::string_view name, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw std::invalid_argument(
        fmt::format("{} is {}; write a number from {} to {}", name, value, low, high));
}

void check_digit(std::string_view name, int digit, int first) {
  if (digit < first || digit >= kDigits)
    throw std::invalid_argument(
        fmt::format("{} is {}; digits have the numbers {} to {}", name, digit, first, kDigits - 1));
}

void check_joint(int joint) {
  if (joint < 0 || joint >= kJoints)
    throw std::invalid_argument(
        fmt::format("joint {} does not exist; joints have the numbers 0 to {}", joint, kJoints - 1));
}

int digit_count(const DigitFlags& digits) noexcept {
  return static_cast<int>(std::count(digits.begin(), digits.end(), true));
}

std::vector<double> step_weights(std::span<const Observation> steps) {
  std::vector<double> weight(steps.size(), 0.0);
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) weight[i] = steps[i + 1].time - steps[i].time;
  return weight;
}

double weighted_mean(std::span<const double> weight, std::span<const double> value) {
  double sum = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    sum += weight[i] * value[i];
    total += weight[i];
  }
  return sum / total;
}

std::vector<double> TrialForces::sum(const DigitFlags& digits) const {
  std::vector<double> total;
  for (std::size_t digit = 0; digit < kDigits; ++digit) {
    if (!digits[digit]) continue;
    total.resize(of_digit[digit].size(), 0.0);
    for (std::size_t i = 0; i < total.size(); ++i) total[i] += of_digit[digit][i];
  }
  return total;
}

TrialForces trial_forces(std::span<const Observation> steps, const DigitFlags& digits,
                         const DigitFlags& felt) {
  TrialForces out;
  const bool sensed = !steps.empty() && all_sensed(steps, digits);
  out.origin = sensed ? ScoreOrigin::kMeasured : ScoreOrigin::kRendered;
  out.invalid = why_not_scored(steps);
  if (out.invalid.empty()) out.invalid = why_no_forces(steps, digits, felt);
  if (!out.invalid.empty()) return out;
  for (std::size_t digit = 0; digit < kDigits; ++digit) {
    if (!digits[digit]) continue;
    for (const Observation& step : steps)
      out.of_digit[digit].push_back(sensed ? step.measured_force[digit] : step.force[digit]);
  }
  out.invalid = why_not_finite(out.of_digit, steps);
  return out;
}

std::string why_not_measured(std::span<const Observation> steps, std::span<const int> joints) {
  for (const int joint : joints)
    for (const Observation& step : steps) {
      if (step.angle_origin[idx(joint)] != AngleOrigin::kMeasured)
        return reason_text<Reason::kAngleNotMeasured>(joint_name(joint),
                                                      angle_origin_name(step.angle_origin[idx(joint)]));
      if (!std::isfinite(step.angle[idx(joint)]))
        return reason_text<Reason::kAngleNotFinite>(joint_name(joint), step.time);
    }
  return {};
}

std::vector<int> flexion_joints(int digit) {
  if (digit == 0) return {joint_index(0, 2), joint_index(0, 3)};
  return {joint_index(digit, 0), joint_index(digit, 2), joint_index(digit, 3)};
}

std::vector<double> angle_sum(std::span<const Observation> steps, std::span<const int> joints) {
  std::vector<double> sum;
  sum.reserve(steps.size());
  for (const Observation& step : steps) {
    double angle = 0.0;
    for (const int joint : joints) angle += step.angle[idx(joint)];
    sum.push_back(angle);
  }
  return sum;
}

std::vector<double> step_times(std::span<const Observation> steps) {
  std::vector<double> time;
  time.reserve(steps.size());
  for (const Observation& step : steps) time.push_back(step.time);
  return time;
}

TrialSamples trial_samples(std::span<const Observation> steps) {
  TrialSamples out;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double time = steps[i].sample_time;
    if (!std::isfinite(time)) {
      out.invalid = reason_text<Reason::kSampleTimeNotKnown>(steps[i].time);
      return out;
    }
    if (i > 0 && time == out.time.back()) continue;
    if (i > 0 && time < out.time.back()) {
      out.invalid = reason_text<Reason::kSampleTimeGoesBack>(steps[i].time);
      return out;
    }
    out.step.push_back(i);
    out.time.push_back(time);
  }
  const double seconds = out.time.empty() ? 0.0 : out.time.back() - out.time.front();
  const double intervals = out.time.empty() ? 0.0 : static_cast<double>(out.time.size() - 1);
  if (!(intervals > 0.0) || intervals < kLeastSampleRate * seconds)
    out.invalid =
        reason_text<Reason::kTooFewSamples>(seconds > 0.0 ? intervals / seconds : 0.0, kLeastSampleRate);
  return out;
}

std::vector<double> resample(std::span<const double> time, std::span<const double> value) {
  const double begin = time.front();
  const auto last = static_cast<std::size_t>((time.back() - begin) * kScoreRate + 1e-9);
  std::vector<double> out;
  out.reserve(last + 1);
  std::size_t i = 0;
  for (std::size_t k = 0; k <= last; ++k) {
    const double at = begin + static_cast<double>(k) / kScoreRate;
    while (i + 2 < time.size() && time[i + 1] <= at) ++i;
    const double share = (at - time[i]) / (time[i + 1] - time[i]);
    out.push_back(value[i] + std::min(share, 1.0) * (value[i + 1] - value[i]));
  }
  return out;
}

}  // namespace phalanx
