// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/motion_scores.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "exercise/scores/trial_values.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/exercise/reasons.h"

namespace phalanx {
namespace {

constexpr double kLongestHold = 10.0;  ///< [s]

std::string why_no_motion(std::span<const Observation> steps, bool calibration_independent) {
  std::string why = why_not_scored(steps);
  if (why.empty() && !calibration_independent) why = reason_text<Reason::kCalibrationDependsByMethod>();
  return why;
}

std::string too_short(double hold_time) { return reason_text<Reason::kShorterThanHold>(hold_time); }

void append(std::vector<Score>& to, const std::vector<Score>& scores) {
  to.insert(to.end(), scores.begin(), scores.end());
}

double range(const std::vector<double>& value) {
  const auto [low, high] = std::minmax_element(value.begin(), value.end());
  return *high - *low;
}

/// Returns the slope of y on x by weighted least squares.
double slope(std::span<const double> weight, const std::vector<double>& x, const std::vector<double>& y) {
  const double mean_x = weighted_mean(weight, x);
  const double mean_y = weighted_mean(weight, y);
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += weight[i] * (x[i] - mean_x) * (x[i] - mean_x);
    xy += weight[i] * (x[i] - mean_x) * (y[i] - mean_y);
  }
  return xy / xx;
}

/// Returns the extension deficit at each step: the sum of the joints' angles above 0 [rad].
std::vector<double> deficit(std::span<const Observation> steps, std::span<const int> joints) {
  std::vector<double> sum;
  sum.reserve(steps.size());
  for (const Observation& step : steps) {
    double angle = 0.0;
    for (const int joint : joints) angle += std::max(step.angle[idx(joint)], 0.0);
    sum.push_back(angle);
  }
  return sum;
}

}  // namespace

std::vector<Score> range_of_motion_scores(std::span<const Observation> steps, const RangeOfMotion& task) {
  check_between("hold_time", task.hold_time, 0.0, kLongestHold);
  std::vector<int> joints = task.joints;
  if (joints.empty())
    for (int joint = 0; joint < kJoints; ++joint) joints.push_back(joint);
  for (const int joint : joints) check_joint(joint);
  const std::string no_motion = why_no_motion(steps, task.calibration_independent);

  std::vector<Score> scores;
  for (const int joint : joints) {
    const std::array<ScoreName, 3> names = {{{fmt::format("rom_{}_deg", joint_name(joint)), "deg"},
                                             {fmt::format("max_{}_deg", joint_name(joint)), "deg"},
                                             {fmt::format("min_{}_deg", joint_name(joint)), "deg"}}};
    const std::array<int, 1> one = {joint};
    std::string why = no_motion;
    if (why.empty()) why = why_not_measured(steps, one);
    std::optional<double> high;
    std::optional<double> low;
    if (why.empty()) {
      const std::vector<double> angle = angle_sum(steps, one);
      high = held_maximum(steps, angle, task.hold_time);
      low = held_minimum(steps, angle, task.hold_time);
      if (!high || !low) why = too_short(task.hold_time);
    }
    if (!why.empty()) {
      append(scores, invalid_scores(names, ScoreOrigin::kMeasured, why));
      continue;
    }
    scores.push_back(valid_score(names[0], (*high - *low) * kRadToDeg, ScoreOrigin::kMeasured));
    scores.push_back(valid_score(names[1], *high * kRadToDeg, ScoreOrigin::kMeasured));
    scores.push_back(valid_score(names[2], *low * kRadToDeg, ScoreOrigin::kMeasured));
  }
  return scores;
}

std::vector<Score> total_active_motion_scores(std::span<const Observation> steps,
                                              const TotalActiveMotion& task) {
  check_between("hold_time", task.hold_time, 0.0, kLongestHold);
  if (digit_count(task.digits) == 0) throw std::invalid_argument("the task has no digit; name one at least");
  const std::string no_motion = why_no_motion(steps, task.calibration_independent);

  std::vector<Score> scores;
  for (int digit = 0; digit < kDigits; ++digit) {
    if (!task.digits[idx(digit)]) continue;
    const std::array<ScoreName, 3> names = {{{fmt::format("tam_{}_deg", digit_name(digit)), "deg"},
                                             {fmt::format("flexion_{}_deg", digit_name(digit)), "deg"},
                                             {fmt::format("deficit_{}_deg", digit_name(digit)), "deg"}}};
    const std::vector<int> joints = flexion_joints(digit);
    std::string why = no_motion;
    if (why.empty()) why = why_not_measured(steps, joints);
    std::optional<double> fist;
    std::optional<double> open;
    if (why.empty()) {
      fist = held_maximum(steps, angle_sum(steps, joints), task.hold_time);
      open = held_minimum(steps, deficit(steps, joints), task.hold_time);
      if (!fist || !open) why = too_short(task.hold_time);
    }
    if (!why.empty()) {
      append(scores, invalid_scores(names, ScoreOrigin::kMeasured, why));
      continue;
    }
    scores.push_back(valid_score(names[0], (*fist - *open) * kRadToDeg, ScoreOrigin::kMeasured));
    scores.push_back(valid_score(names[1], *fist * kRadToDeg, ScoreOrigin::kMeasured));
    scores.push_back(valid_score(names[2], *open * kRadToDeg, ScoreOrigin::kMeasured));
  }
  return scores;
}

std::vector<Score> opposition_scores(std::span<const Observation> steps, const Opposition& task) {
  check_between("hold_time", task.hold_time, 0.0, 10.0);
  const std::string no_motion = why_no_motion(steps, task.calibration_independent);
  std::vector<Score> scores;
  for (int finger = 1; finger < kDigits; ++finger) {
    if (!task.fingers[idx(finger)]) continue;
    const std::array names = {ScoreName{fmt::format("opposition_{}_mm", digit_name(finger)), "mm"},
                              ScoreName{fmt::format("opposition_held_{}_mm", digit_name(finger)), "mm"}};
    std::vector<int> joints;
    for (const int digit : {0, finger})
      for (int i = 0; i < kJointsPerDigit; ++i) joints.push_back(joint_index(digit, i));
    std::string why = no_motion;
    if (why.empty()) why = why_not_measured(steps, joints);
    std::vector<double> distance;
    for (const Observation& step : steps) {
      if (!why.empty()) break;
      distance.push_back((step.pad[0] - step.pad[idx(finger)]).norm());
      if (!std::isfinite(distance.back())) why = reason_text<Reason::kPadNotFinite>(step.time);
    }
    if (!why.empty()) {
      append(scores, invalid_scores(names, ScoreOrigin::kMeasured, why));
      continue;
    }
    scores.push_back(valid_score(names[0], *std::min_element(distance.begin(), distance.end()) / kMm,
                                 ScoreOrigin::kMeasured));
    const std::optional<double> held = held_minimum(steps, distance, task.hold_time);
    scores.push_back(held ? valid_score(names[1], *held / kMm, ScoreOrigin::kMeasured)
                          : invalid_score(names[1], ScoreOrigin::kMeasured, too_short(task.hold_time)));
  }
  if (scores.empty()) throw std::invalid_argument("the task has no finger; name one at least");
  return scores;
}

std::vector<Score> motion_independence_scores(std::span<const Observation> steps,
                                              const MotionIndependence& task) {
  check_digit("instructed", task.instructed);
  if (digit_count(task.digits) < 2 || !task.digits[idx(task.instructed)])
    throw std::invalid_argument(
        "the task needs two digits at least, the instructed one among them; name them in `digits`");
  check_above("least_range", task.least_range, 0.0, 4.0 * kPi);
  std::vector<ScoreName> names = {{"instructed_range_deg", "deg"}};
  std::vector<int> others;
  for (int digit = 0; digit < kDigits; ++digit)
    if (task.digits[idx(digit)] && digit != task.instructed) {
      names.push_back({fmt::format("enslaving_{}", digit_name(digit)), "-"});
      others.push_back(digit);
    }
  names.push_back({"individuation_index", "-"});

  std::string why = why_no_motion(steps, task.calibration_independent);
  const std::vector<int> leading_joints = flexion_joints(task.instructed);
  if (why.empty()) why = why_not_measured(steps, leading_joints);
  if (!why.empty()) return invalid_scores(names, ScoreOrigin::kMeasured, why);
  const std::vector<double> leading = angle_sum(steps, leading_joints);
  const double leading_range = range(leading);
  std::vector<Score> scores = {valid_score(names[0], leading_range * kRadToDeg, ScoreOrigin::kMeasured)};
  if (!(leading_range >= task.least_range)) {
    why =
        reason_text<Reason::kInstructedMovedLittle>(leading_range * kRadToDeg, task.least_range * kRadToDeg);
    append(scores, invalid_scores(std::span(names).subspan(1), ScoreOrigin::kMeasured, why));
    return scores;
  }

  const std::vector<double> weight = step_weights(steps);
  double slopes = 0.0;  // sum of their magnitudes
  for (std::size_t i = 0; i < others.size(); ++i) {
    const std::vector<int> joints = flexion_joints(others[i]);
    const std::string unmeasured = why_not_measured(steps, joints);
    if (!unmeasured.empty()) {
      scores.push_back(invalid_score(names[i + 1], ScoreOrigin::kMeasured, unmeasured));
      why = unmeasured;
      continue;
    }
    const std::vector<double> flexion = angle_sum(steps, joints);
    scores.push_back(valid_score(names[i + 1], range(flexion) / leading_range, ScoreOrigin::kMeasured));
    slopes += std::abs(slope(weight, leading, flexion));
  }
  const double index = 1.0 - slopes / static_cast<double>(others.size());
  scores.push_back(why.empty() ? valid_score(names.back(), index, ScoreOrigin::kMeasured)
                               : invalid_score(names.back(), ScoreOrigin::kMeasured, why));
  return scores;
}

}  // namespace phalanx
