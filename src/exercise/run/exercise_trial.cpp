// SPDX-License-Identifier: Apache-2.0
#include "exercise/run/exercise_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exercise/scores/trial_values.h"
#include "phalanx/core/index.h"
#include "phalanx/exercise/force_scores.h"
#include "phalanx/exercise/motion_scores.h"
#include "phalanx/exercise/reasons.h"
#include "phalanx/exercise/smoothness.h"

namespace phalanx {
namespace {

constexpr double kNoTarget = std::numeric_limits<double>::quiet_NaN();
constexpr double kMostLag = 1.0;  ///< longest lag of a force behind a moving target [s]
constexpr double kLagOfPeriod =
    0.45;  ///< longest lag in periods of the target: below a half, it has one sign

/// Instructed digits that are felt.
std::vector<int> turns_of(const ExerciseDescription& exercise, const PersonLimits& person) {
  std::vector<int> turns;
  for (int digit = 0; digit < kDigits; ++digit)
    if (exercise.digits[idx(digit)] && person.felt[idx(digit)]) turns.push_back(digit);
  return turns;
}

double spanned(const std::optional<DifficultySpan>& span, double difficulty, double otherwise) {
  return span ? span->at(difficulty) : otherwise;
}

double sum_of(const std::array<double, kDigits>& forces) {
  double sum = 0.0;
  for (const double force : forces) sum += force;
  return sum;
}

/// Factor on the target's centre at time t of a tracking trial.
double tracking_factor(const TrialPlan& plan, double t) {
  if (t < kTrackingLeadIn) return 1.0;
  return 1.0 + kTrackingSwing * std::sin(2.0 * std::numbers::pi * plan.rate_hz * (t - kTrackingLeadIn));
}

/// Angle of a joint at a share of its own range; none for a joint without a range.
std::optional<double> angle_at(const PersonLimits& person, int joint, double share) {
  const auto& range = person.own_range[idx(joint)];
  return range ? std::optional(range->min + share * (range->max - range->min)) : std::nullopt;
}

/// Angles of the instructed digit at a share of its own range; NaN for joints without a range.
void set_angles(const PersonLimits& person, int digit, double share, ExerciseTarget& target) {
  for (const int joint : flexion_joints(digit))
    if (const auto angle = angle_at(person, joint, share)) target.angle[idx(joint)] = *angle;
}

/// Sum of these angles: the flexion that is the target [rad].
double target_flexion(const PersonLimits& person, int digit, double share) {
  double sum = 0.0;
  for (const int joint : flexion_joints(digit)) sum += angle_at(person, joint, share).value_or(0.0);
  return sum;
}

std::vector<Score> tracking_scores(const ExerciseDescription& exercise, const PersonLimits& person,
                                   const TrialPlan& plan, std::span<const Observation> steps) {
  const double centre = sum_of(target_forces(exercise, person, plan));
  const double begin = steps.empty() ? 0.0 : steps.front().time;
  std::vector<double> target;
  std::size_t first = 0;
  while (first < steps.size() && steps[first].time - begin < kTrackingLeadIn) ++first;
  const auto scored = steps.subspan(first);
  target.reserve(scored.size());
  for (const Observation& step : scored) {
    const double t = step.time - begin;
    target.push_back(centre * tracking_factor(plan, std::isfinite(t) ? t : 0.0));
  }
  const ForceTracking task = {.digits = trial_digits(exercise, plan),
                              .tolerance = plan.tolerance,
                              .longest_lag = std::min(kMostLag, kLagOfPeriod / plan.rate_hz)};
  return force_tracking_scores(scored, target, task, person.felt);
}

std::vector<Score> entry_scores_of_all(const ExerciseDescription& exercise, const PersonLimits& person,
                                       std::span<const Observation> steps) {
  std::vector<Score> scores;
  for (int digit = 0; digit < kDigits; ++digit) {
    if (!exercise.digits[idx(digit)] || !person.felt[idx(digit)]) continue;
    for (Score& score : entry_scores(steps, digit, person.calibration_independent))
      scores.push_back(std::move(score));
  }
  return scores;
}

/// Scores of a pinch, and its time in the band around the target. Without contacts that can slide a slip
/// is not seen.
std::vector<Score> pinch_and_band_scores(const ExerciseDescription& exercise, const PersonLimits& person,
                                         const TrialPlan& plan, std::span<const Observation> steps) {
  std::vector<Score> scores = pinch_scores(steps, {.finger = plan.digit}, person.felt);
  std::string slipped = scores.front().invalid;
  for (Score& score : press_and_hold_scores(steps,
                                            {.digits = trial_digits(exercise, plan),
                                             .target = sum_of(target_forces(exercise, person, plan)),
                                             .tolerance = plan.tolerance,
                                             .settle_time = kPressSettle},
                                            person.felt)) {
    if (!score.name.starts_with("time_in_target")) continue;
    if (!slipped.empty()) score.invalid = slipped;
    scores.push_back(std::move(score));
  }
  for (Score& score : scores) {
    if (!person.detects_slips) score.invalid = reason_text<Reason::kNoSlidingContacts>();
    if (!score.valid()) score.value = 0.0;
  }
  return scores;
}

std::vector<Score> scores_of_measure(const ExerciseDescription& exercise, const PersonLimits& person,
                                     const TrialPlan& plan, std::span<const Observation> steps) {
  const std::array<bool, kDigits> digits = trial_digits(exercise, plan);
  const bool independent = person.calibration_independent;
  switch (exercise.measure) {
    case ExerciseMeasure::kRangeOfMotion: {
      RangeOfMotion task;
      for (int joint = 0; joint < kJoints; ++joint)
        if (digits[idx(digit_of_joint(joint))]) task.joints.push_back(joint);
      task.calibration_independent = independent;
      return range_of_motion_scores(steps, task);
    }
    case ExerciseMeasure::kTotalActiveMotion:
      return total_active_motion_scores(steps, {.digits = digits, .calibration_independent = independent});
    case ExerciseMeasure::kPressAndHold:
      return press_and_hold_scores(steps,
                                   {.digits = digits,
                                    .target = sum_of(target_forces(exercise, person, plan)),
                                    .tolerance = plan.tolerance,
                                    .settle_time = kPressSettle},
                                   person.felt);
    case ExerciseMeasure::kForceTracking:
      return tracking_scores(exercise, person, plan, steps);
    case ExerciseMeasure::kSqueezeRelease:
      return squeeze_and_release_scores(steps, {.digits = digits, .release_cue = 0.5 * exercise.trial_s},
                                        person.felt);
    case ExerciseMeasure::kOwnForce:
      return squeeze_and_release_scores(steps, {.digits = digits, .release_cue = {}}, person.felt);
    case ExerciseMeasure::kPinch:
      return pinch_and_band_scores(exercise, person, plan, steps);
    case ExerciseMeasure::kOpposition:
      return opposition_scores(steps, {.fingers = digits, .calibration_independent = independent});
    case ExerciseMeasure::kIndependence:
      return motion_independence_scores(
          steps,
          {.instructed = plan.digit, .digits = exercise.digits, .calibration_independent = independent});
    case ExerciseMeasure::kSmoothness:
      return smoothness_scores(steps, {.digit = plan.digit, .calibration_independent = independent});
    case ExerciseMeasure::kEntryCheck:
      return entry_scores_of_all(exercise, person, steps);
    case ExerciseMeasure::kFeelAndFind:
    case ExerciseMeasure::kObjectInHand:
      return {};
  }
  return {};
}

}  // namespace

int planned_trials(const ExerciseDescription& exercise, const PersonLimits& person) {
  if (!digits_in_turn(exercise.measure)) return exercise.trials;
  return exercise.trials * static_cast<int>(turns_of(exercise, person).size());
}

TrialPlan plan_trial(const ExerciseDescription& exercise, const PersonLimits& person, int index,
                     double difficulty) {
  TrialPlan plan;
  plan.number = index + 1;
  plan.target = exercise.target;
  plan.tolerance = exercise.tolerance;
  plan.rate_hz = exercise.rate_hz;
  plan.success = exercise.success;
  if (digits_in_turn(exercise.measure)) {
    const std::vector<int> turns = turns_of(exercise, person);
    plan.digit = turns[static_cast<std::size_t>(index) % turns.size()];
  }
  if (exercise.difficulty) {
    plan.difficulty = difficulty;
    plan.target = spanned(exercise.difficulty->target, difficulty, plan.target);
    plan.tolerance = spanned(exercise.difficulty->tolerance, difficulty, plan.tolerance);
    plan.rate_hz = spanned(exercise.difficulty->rate_hz, difficulty, plan.rate_hz);
    if (plan.success)
      plan.success->bound = spanned(exercise.difficulty->success, difficulty, plan.success->bound);
  }
  return plan;
}

std::array<bool, kDigits> trial_digits(const ExerciseDescription& exercise, const TrialPlan& plan) {
  if (plan.digit < 0) return exercise.digits;
  std::array<bool, kDigits> digits = {};
  digits[idx(plan.digit)] = true;
  if (exercise.measure == ExerciseMeasure::kPinch || exercise.measure == ExerciseMeasure::kOpposition)
    digits[0] = true;
  return digits;
}

std::array<double, kDigits> target_forces(const ExerciseDescription& exercise, const PersonLimits& person,
                                          const TrialPlan& plan) {
  std::array<double, kDigits> forces = {};
  const std::array<bool, kDigits> digits = trial_digits(exercise, plan);
  double cap = person.force_cap;
  if (exercise.limits.force) cap = std::min(cap, *exercise.limits.force);
  const double largest = exercise.measure == ExerciseMeasure::kForceTracking ? 1.0 + kTrackingSwing : 1.0;
  for (int digit = 0; digit < kDigits; ++digit)
    if (digits[idx(digit)])
      forces[idx(digit)] =
          std::min(plan.target * person.own_force[idx(digit)].value_or(0.0), kReachableForce * cap / largest);
  return forces;
}

ExerciseTarget trial_target(const ExerciseDescription& exercise, const PersonLimits& person,
                            const TrialPlan& plan, double t) {
  using Kind = ExerciseTarget::Kind;
  ExerciseTarget target;
  target.digits = trial_digits(exercise, plan);
  target.force.fill(kNoTarget);
  target.angle.fill(kNoTarget);
  const double third = exercise.trial_s / 3.0;
  const double half = exercise.trial_s / 2.0;
  switch (exercise.measure) {
    case ExerciseMeasure::kRangeOfMotion:
    case ExerciseMeasure::kTotalActiveMotion:
    case ExerciseMeasure::kEntryCheck:
    case ExerciseMeasure::kIndependence:
      target.kind = t >= third && t < 2.0 * third ? Kind::kClose : Kind::kOpen;
      break;
    case ExerciseMeasure::kPressAndHold:
    case ExerciseMeasure::kForceTracking:
    case ExerciseMeasure::kPinch: {
      target.kind = Kind::kForce;
      const bool tracks = exercise.measure == ExerciseMeasure::kForceTracking;
      const double factor = tracks ? tracking_factor(plan, t) : 1.0;
      const std::array<double, kDigits> forces = target_forces(exercise, person, plan);
      for (int digit = 0; digit < kDigits; ++digit)
        if (target.digits[idx(digit)]) target.force[idx(digit)] = forces[idx(digit)] * factor;
      const double sum = sum_of(forces);
      const double width = plan.tolerance * sum * (tracks ? 1.0 + kTrackingSwing : 1.0);
      target.low = sum * factor - width;
      target.high = sum * factor + width;
      break;
    }
    case ExerciseMeasure::kSqueezeRelease:
      target.kind = t < half ? Kind::kSqueeze : Kind::kOpen;
      break;
    case ExerciseMeasure::kOwnForce:
      target.kind = Kind::kSqueeze;
      break;
    case ExerciseMeasure::kOpposition:
      target.kind = Kind::kTouch;
      break;
    case ExerciseMeasure::kSmoothness:
      target.kind = Kind::kAngle;
      set_angles(person, plan.digit, t < kMoveLeadIn ? 0.0 : plan.target, target);
      break;
    case ExerciseMeasure::kFeelAndFind:
    case ExerciseMeasure::kObjectInHand:
      target.kind = Kind::kExplore;
      break;
  }
  return target;
}

std::vector<Score> trial_scores(const ExerciseDescription& exercise, const PersonLimits& person,
                                const TrialPlan& plan, std::span<const Observation> steps) {
  std::vector<Score> scores = scores_of_measure(exercise, person, plan, steps);
  if (plan.digit >= 0 && exercise.measure != ExerciseMeasure::kOpposition)
    for (Score& score : scores) score.name = fmt::format("{}_{}", digit_name(plan.digit), score.name);
  return scores;
}

std::vector<Score> scores_of_followers(const ExerciseDescription& exercise, const PersonLimits& person) {
  std::vector<Score> scores;
  if (!digits_in_turn(exercise.measure)) return scores;
  PersonLimits all = person;
  all.felt.fill(true);
  all.own_force.fill(1.0);
  all.own_range.fill(OwnRange{.min = 0.0, .max = 1.0});
  for (int digit = 0; digit < kDigits; ++digit) {
    if (!exercise.digits[idx(digit)] || person.felt[idx(digit)]) continue;
    TrialPlan plan = plan_trial(exercise, all, 0, 0.0);
    plan.digit = digit;
    for (Score& score : trial_scores(exercise, all, plan, {})) {
      score.value = 0.0;
      score.invalid = reason_text<Reason::kDigitFollows>(digit_name(digit));
      scores.push_back(std::move(score));
    }
  }
  return scores;
}

const Score* scored_by(const SuccessRule& rule, const TrialPlan& plan, const std::vector<Score>& scores) {
  for (const Score& score : scores) {
    if (score.name == rule.score) return &score;
    if (plan.digit < 0) continue;
    const std::string digit(digit_name(plan.digit));
    if (score.name == fmt::format("{}_{}", digit, rule.score)) return &score;
    std::string without = score.name;
    const std::string infix = fmt::format("_{}_", digit);
    if (const std::size_t at = without.find(infix); at != std::string::npos) {
      without.replace(at, infix.size(), "_");
      if (without == rule.score) return &score;
    }
  }
  return nullptr;
}

void state_conditions(const ExerciseDescription& exercise, const PersonLimits& person, const TrialPlan& plan,
                      ExerciseTrial& trial) {
  const bool with_thumb =
      exercise.measure == ExerciseMeasure::kPinch || exercise.measure == ExerciseMeasure::kOpposition;
  if (plan.digit >= 0)
    trial.condition = fmt::format("{}{}", with_thumb ? "thumb and " : "", digit_name(plan.digit));
  trial.difficulty = plan.difficulty;
  if (needs_own_force(exercise.measure)) {
    trial.target = sum_of(target_forces(exercise, person, plan));
    trial.tolerance = plan.tolerance;
    if (exercise.measure == ExerciseMeasure::kForceTracking) trial.rate_hz = plan.rate_hz;
  } else if (needs_own_range(exercise.measure)) {
    trial.target = target_flexion(person, plan.digit, plan.target);
  }
}

}  // namespace phalanx
