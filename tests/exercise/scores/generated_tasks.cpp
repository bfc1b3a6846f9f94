// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "exercise/scores/generated_trial.h"

namespace phalanx::test {
namespace {

std::string digits_json(const DigitFlags& digits) {
  std::vector<std::string> names;
  for (int digit = 0; digit < kDigits; ++digit)
    if (digits[idx(digit)]) names.push_back(fmt::format("\"{}\"", digit_name(digit)));
  return fmt::format("[{}]", fmt::join(names, ","));
}

std::string flag_json(bool flag) { return flag ? "true" : "false"; }

/// Draws digits, the finger among them.
DigitFlags drawn_digits(Random& random, int finger, double share) {
  DigitFlags digits{};
  for (bool& digit : digits) digit = random.uniform() < share;
  digits[idx(finger)] = true;
  return digits;
}

void add_force_tasks(Random& random, const std::vector<Observation>& steps, const DigitFlags& felt,
                     int finger, std::vector<ScoredTask>& tasks) {
  const std::string with_felt = fmt::format("\"felt\":{}", digits_json(felt));
  const PressAndHold press{.digits = drawn_digits(random, finger, 0.2),
                           .target = random.between(0.5, 4.0),
                           .tolerance = random.between(0.05, 0.5),
                           .settle_time = random.between(0.0, 2.0)};
  tasks.push_back(
      {fmt::format(R"({{"measure":"press_and_hold",{},"digits":{},"target":{:.17g},"tolerance":{:.17g},)"
                   R"("settle_time":{:.17g}}})",
                   with_felt, digits_json(press.digits), press.target, press.tolerance, press.settle_time),
       [=](const auto& all) { return press_and_hold_scores(all, press, felt); }});

  const ForceTracking tracking{.digits = drawn_digits(random, finger, 0.2),
                               .tolerance = random.between(0.05, 0.5),
                               .longest_lag = random.between(0.2, 1.2)};
  const Wander wander(random, 1.5);
  std::vector<double> target;
  std::vector<std::string> numbers;
  for (const Observation& step : steps) {
    target.push_back(std::max(0.0, 2.0 + wander.at(step.time)));
    numbers.push_back(fmt::format("{:.17g}", target.back()));
  }
  tasks.push_back(
      {fmt::format(R"({{"measure":"force_tracking",{},"digits":{},"target":[{}],"tolerance":{:.17g},)"
                   R"("longest_lag":{:.17g}}})",
                   with_felt, digits_json(tracking.digits), fmt::join(numbers, ","), tracking.tolerance,
                   tracking.longest_lag),
       [=](const auto& all) { return force_tracking_scores(all, target, tracking, felt); }});

  SqueezeAndRelease squeeze{.digits = drawn_digits(random, finger, 0.2),
                            .least_peak = random.between(0.2, 2.0)};
  std::string cue;
  if (random.uniform() < 0.7) {
    squeeze.release_cue = random.between(0.0, 4.0);
    cue = fmt::format(R"(,"release_cue":{:.17g})", *squeeze.release_cue);
  }
  tasks.push_back({fmt::format(R"({{"measure":"squeeze_release",{},"digits":{},"least_peak":{:.17g}{}}})",
                               with_felt, digits_json(squeeze.digits), squeeze.least_peak, cue),
                   [=](const auto& all) { return squeeze_and_release_scores(all, squeeze, felt); }});

  const Pinch pinch{.finger = finger, .least_force = random.between(0.05, 0.6)};
  tasks.push_back({fmt::format(R"({{"measure":"pinch",{},"finger":"{}","least_force":{:.17g}}})", with_felt,
                               digit_name(finger), pinch.least_force),
                   [=](const auto& all) { return pinch_scores(all, pinch, felt); }});
}

void add_motion_tasks(Random& random, int finger, std::vector<ScoredTask>& tasks) {
  const bool independent = random.uniform() < 0.9;
  const std::string calibration = fmt::format(R"("calibration_independent":{})", flag_json(independent));
  const double hold = random.uniform() < 0.2 ? 0.0 : random.between(0.02, 0.4);
  RangeOfMotion range{.hold_time = hold, .calibration_independent = independent};
  std::vector<std::string> names;
  for (int joint = 0; joint < kJoints; ++joint)
    if (random.uniform() < 0.3 || joint == kJoints - 1) {
      range.joints.push_back(joint);
      names.push_back(fmt::format("\"{}\"", joint_name(joint)));
    }
  tasks.push_back({fmt::format(R"({{"measure":"range_of_motion",{},"joints":[{}],"hold_time":{:.17g}}})",
                               calibration, fmt::join(names, ","), hold),
                   [=](const auto& all) { return range_of_motion_scores(all, range); }});

  const TotalActiveMotion total{
      .digits = drawn_digits(random, finger, 0.5), .hold_time = hold, .calibration_independent = independent};
  tasks.push_back({fmt::format(R"({{"measure":"total_active_motion",{},"digits":{},"hold_time":{:.17g}}})",
                               calibration, digits_json(total.digits), hold),
                   [=](const auto& all) { return total_active_motion_scores(all, total); }});

  Opposition opposition{.fingers = drawn_digits(random, finger, 0.5), .calibration_independent = independent};
  opposition.fingers[0] = false;
  tasks.push_back({fmt::format(R"({{"measure":"opposition",{},"digits":{}}})", calibration,
                               digits_json(opposition.fingers)),
                   [=](const auto& all) { return opposition_scores(all, opposition); }});

  MotionIndependence alone{.instructed = finger,
                           .digits = drawn_digits(random, finger, 0.7),
                           .calibration_independent = independent};
  alone.digits[finger == 4 ? 3 : 4] = true;
  tasks.push_back({fmt::format(R"({{"measure":"motion_independence",{},"instructed":"{}","digits":{}}})",
                               calibration, digit_name(finger), digits_json(alone.digits)),
                   [=](const auto& all) { return motion_independence_scores(all, alone); }});

  const FreeMovement movement{.digit = finger, .least_speed = 0.01, .calibration_independent = independent};
  tasks.push_back({fmt::format(R"({{"measure":"smoothness",{},"digit":"{}","least_speed":0.01}})",
                               calibration, digit_name(finger)),
                   [=](const auto& all) { return smoothness_scores(all, movement); }});
}

}  // namespace

std::vector<ScoredTask> generated_tasks(std::uint64_t seed, const std::vector<Observation>& steps) {
  Random random(seed ^ 0x7a5cU);
  const int finger = 1 + static_cast<int>(4.0 * random.uniform());
  DigitFlags felt = kAllFelt;
  if (seed % 5 == 1) felt = {true, true, false, false, false};
  std::vector<ScoredTask> tasks;
  add_force_tasks(random, steps, felt, finger, tasks);
  add_motion_tasks(random, finger, tasks);
  return tasks;
}

}  // namespace phalanx::test
