// SPDX-License-Identifier: Apache-2.0
// The entry check, and the scores of a whole exercise from those of its trials.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exercise/run/exercise_trial.h"
#include "exercise/scores/trial_values.h"
#include "phalanx/core/index.h"
#include "phalanx/exercise/reasons.h"
#include "phalanx/exercise/scored_steps.h"

namespace phalanx {
namespace {

/// Flexion joints of a digit that are measured in all steps.
std::vector<int> measured_flexion(std::span<const Observation> steps, int digit) {
  std::vector<int> joints;
  for (const int joint : flexion_joints(digit)) {
    if (std::all_of(steps.begin(), steps.end(), [&](const Observation& step) {
          return step.angle_origin[idx(joint)] == AngleOrigin::kMeasured;
        }))
      joints.push_back(joint);
  }
  return joints;
}

std::string why_no_entry(std::span<const Observation> steps, const std::vector<int>& joints, int digit,
                         bool calibration_independent) {
  if (std::string reason = why_not_scored(steps); !reason.empty()) return reason;
  if (joints.empty()) return reason_text<Reason::kNoFlexionSensor>(digit_name(digit));
  if (!calibration_independent) return reason_text<Reason::kCalibrationDepends>();
  return {};
}

const Score* find_entry_score(const std::vector<Score>& scores, const std::string& name) {
  const auto found =
      std::find_if(scores.begin(), scores.end(), [&](const Score& score) { return score.name == name; });
  return found == scores.end() ? nullptr : &*found;
}

/// Mean of one name over the trials; invalid with the first reason.
Score mean_of(const std::vector<ExerciseTrial>& trials, const Score& first) {
  Score mean = {.name = first.name, .unit = first.unit, .value = 0.0, .origin = first.origin, .invalid = {}};
  int count = 0;
  bool mixed = false;
  std::string reason;
  for (const ExerciseTrial& trial : trials) {
    const Score* score = find_entry_score(trial.scores, first.name);
    if (score == nullptr) continue;
    if (!trial.invalid.empty() || !score->valid()) {
      if (reason.empty()) reason = score->valid() ? trial.invalid : score->invalid;
      continue;
    }
    if (count == 0) mean.origin = score->origin;
    mixed = mixed || score->origin != mean.origin;
    mean.value += score->value;
    ++count;
  }
  if (count > 0) mean.value /= count;
  if (count == 0) mean.invalid = std::move(reason);
  if (mixed) mean.invalid = reason_text<Reason::kMixedOrigins>();
  if (!mean.valid()) mean.value = 0.0;
  return mean;
}

}  // namespace

std::vector<Score> entry_scores(std::span<const Observation> steps, int digit, bool calibration_independent) {
  const std::vector<int> joints = measured_flexion(steps, digit);
  std::string reason = why_no_entry(steps, joints, digit, calibration_independent);
  double flexion = 0.0;
  double release = 0.0;
  if (reason.empty()) {
    double least = std::numeric_limits<double>::infinity();
    double peak = -std::numeric_limits<double>::infinity();
    double before_peak = 0.0;
    for (const Observation& step : steps) {
      double sum = 0.0;
      for (const int joint : joints) sum += step.angle[idx(joint)];
      least = std::min(least, sum);
      if (sum > peak) {
        peak = sum;
        before_peak = least;
        release = 0.0;
      }
      release = std::max(release, peak - sum);
    }
    flexion = peak - before_peak;
    if (!std::isfinite(flexion) || !std::isfinite(release))
      reason = reason_text<Reason::kEntryAngleNotFinite>();
  }
  if (!reason.empty()) flexion = release = 0.0;
  return {{.name = fmt::format("entry_flexion_{}_deg", digit_name(digit)),
           .unit = "deg",
           .value = flexion * kRadToDeg,
           .origin = ScoreOrigin::kMeasured,
           .invalid = reason},
          {.name = fmt::format("entry_release_{}_deg", digit_name(digit)),
           .unit = "deg",
           .value = release * kRadToDeg,
           .origin = ScoreOrigin::kMeasured,
           .invalid = reason}};
}

EntryVerdict entry_verdict(const ExerciseDescription& exercise, const PersonLimits& person,
                           const std::vector<Score>& scores) {
  EntryVerdict verdict;
  verdict.flexion = std::numeric_limits<double>::infinity();
  verdict.release = std::numeric_limits<double>::infinity();
  std::string problem;
  bool measured = true;
  for (int digit = 0; digit < kDigits && problem.empty(); ++digit) {
    if (!exercise.digits[idx(digit)] || !person.felt[idx(digit)]) continue;
    const Score* flexion = find_entry_score(scores, fmt::format("entry_flexion_{}_deg", digit_name(digit)));
    const Score* release = find_entry_score(scores, fmt::format("entry_release_{}_deg", digit_name(digit)));
    if (flexion == nullptr || release == nullptr || !flexion->valid() || !release->valid()) {
      measured = false;
      problem = flexion != nullptr && !flexion->valid() ? flexion->invalid : "it did not end";
      problem.append("; repeat the entry check");
      break;
    }
    verdict.flexion = std::min(verdict.flexion, flexion->value * kDeg);
    verdict.release = std::min(verdict.release, release->value * kDeg);
    const auto below = [&](double value, double least) { return value * kDeg < least; };
    if (below(flexion->value, exercise.entry.flexion))
      problem = fmt::format("the {} flexed by {:.0f} of {:.0f} degrees", digit_name(digit), flexion->value,
                            exercise.entry.flexion * kRadToDeg);
    else if (below(release->value, exercise.entry.release))
      problem = fmt::format("the {} released by {:.0f} of {:.0f} degrees", digit_name(digit), release->value,
                            exercise.entry.release * kRadToDeg);
  }
  if (!std::isfinite(verdict.flexion)) verdict.flexion = verdict.release = 0.0;
  verdict.suitable = problem.empty();
  if (verdict.suitable)
    verdict.text = "suitable";
  else if (!measured)
    verdict.text = fmt::format("not known: {}", problem);
  else
    verdict.text = fmt::format("not suitable on this device (it resists, it does not assist): {}", problem);
  return verdict;
}

std::vector<Score> mean_scores(const std::vector<ExerciseTrial>& trials) {
  std::vector<Score> means;
  for (const ExerciseTrial& trial : trials)
    for (const Score& score : trial.scores)
      if (find_entry_score(means, score.name) == nullptr) means.push_back(mean_of(trials, score));
  return means;
}

}  // namespace phalanx
