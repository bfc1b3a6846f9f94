// SPDX-License-Identifier: Apache-2.0
// What a HandObserver makes of a slow device, of samples that are lost, and of torque limits.
#include "phalanx/record/hand_observer.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/exercise/smoothness.h"
#include "station/session_fixture.h"

namespace phalanx::test {
namespace {

using ::testing::HasSubstr;

constexpr double kLoop = 0.002;  ///< period of the loop [s]

/// Angle of a movement of least jerk: 1.2 rad in 0.8 s, from 1 s on.                       Flash & Hogan 1985
double moved(double time) {
  const double s = std::clamp((time - 1.0) / 0.8, 0.0, 1.0);
  return 1.2 * s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
}

/// A trial of 2.5 s, observed by a loop of 500 Hz, with a device that gives `rate` samples a second. Samples
/// come 1 to 3 ms after they were taken; those for which `lost` is true do not come.
struct SlowDevice {
  double rate = 90.0;
  std::function<bool(double time)> lost = [](double) { return false; };
  double most_age = 0.0;  ///< of the observer, at the end [s]

  std::vector<Observation> observed() {
    HandObserver observer;
    std::vector<Observation> steps;
    std::uint32_t taken = 0;
    StepRecord record;
    record.station = 1;
    record.state = SafetyState::kRunning;
    record.angle_origin.fill(AngleOrigin::kMeasured);
    for (int i = 1; i <= 1250; ++i) {
      record.command.tick = static_cast<std::uint64_t>(i);
      record.input.time = 100.0 + kLoop * i;
      record.samples = 0;
      for (;;) {
        const double at = (taken + 1) / rate;
        if (at + 0.001 * (1 + taken % 3) > kLoop * i) break;
        ++taken;
        if (lost(at)) continue;
        ++record.samples;
        record.sample_sequence = taken;
        record.sample_time_us = 7'000'000 + static_cast<std::uint64_t>(std::llround(1e6 * at));
        record.angle[idx(joint_index(1, 2))] = moved(at);
      }
      steps.push_back(observer.observe(record));
    }
    most_age = observer.most_age();
    return {steps.begin() + 250, steps.end()};  // a trial begins after a rest
  }
};

std::vector<Score> smoothness_of(const std::vector<Observation>& steps) {
  return smoothness_scores(steps, {.digit = 1, .calibration_independent = true});
}

TEST(SlowDevice, OneMovementHasOnePeakAndItsTrueSpeed) {
  const double peak = 1.875 * 1.2 / 0.8 * kRadToDeg;  // 161 deg/s
  for (const double rate : {30.0, 60.0, 90.0}) {
    SCOPED_TRACE(rate);
    SlowDevice device{.rate = rate};
    const auto scores = smoothness_of(device.observed());
    ASSERT_EQ(scores.size(), 4U);
    for (const Score& score : scores) EXPECT_TRUE(score.valid()) << score.name << ": " << score.invalid;
    EXPECT_NEAR(scores[2].value, peak, 0.02 * peak) << scores[2].name;
    EXPECT_EQ(scores[3].value, 1.0) << scores[3].name;
    RecordProperty(fmt::format("at_{}_hz", rate),
                   fmt::format("{:.2f} of {:.2f} deg/s", scores[2].value, peak));
    EXPECT_NEAR(device.most_age, 2.5 / rate, 1e-4);
  }
}

TEST(SlowDevice, ADropoutIsNotScoredAndOneLostSampleIs) {
  for (const double rate : {30.0, 60.0, 90.0}) {
    SCOPED_TRACE(rate);
    SlowDevice drops{.rate = rate, .lost = [](double time) { return time > 1.35 && time < 1.45; }};
    const auto steps = drops.observed();
    EXPECT_TRUE(std::any_of(steps.begin(), steps.end(), [](const Observation& step) {
      return step.fault == ObservationFault::kNoSample;
    }));
    for (const Score& score : smoothness_of(steps))
      EXPECT_THAT(score.invalid, HasSubstr("the device sent no sample")) << score.name;
    SlowDevice loses{.rate = rate,
                     .lost = [&](double time) { return time > 1.4 && time <= 1.4 + 1.0 / rate; }};
    for (const Score& score : smoothness_of(loses.observed()))
      EXPECT_TRUE(score.valid()) << score.name << ": " << score.invalid;
  }
}

TEST(SlowDevice, TimesOfSamplesAreThoseOfTheDevice) {
  SlowDevice device{.rate = 50.0};
  const auto steps = device.observed();
  double last = steps.front().sample_time;
  for (const Observation& step : steps) {
    if (step.sample_time == last) continue;
    EXPECT_NEAR(step.sample_time - last, 0.02, 1e-9) << "not the uneven times at which they came";
    last = step.sample_time;
  }
  HandObserver observer;
  EXPECT_TRUE(std::isnan(observer.observe({}).sample_time)) << "no sample has come";
}

/// A session in which the index presses, its position being given.
class Limited : public SessionFixture {
 protected:
  /// Presses with a torque limit; without one if it is 0. @returns the newest step
  StepRecord pressed(double limit) {
    SessionSettings settings = with("sliders", "index_ball");
    settings.overrides = {{"rate_hz", "200"}};
    if (limit > 0.0) settings.overrides.emplace_back("limits.joint_torque_nm", fmt::format("{:.17g}", limit));
    start(settings);
    EXPECT_TRUE(until_running());
    const HandParameters& hand = session->info()->geometry->hand;
    for (double share = 0.2; share < 0.62; share += 0.06) {
      JointArray angle = session->sliders();
      for (const int i : {0, 2, 3}) {
        const auto j = idx(joint_index(1, i));
        angle[j] = hand.open_angle[j] +
                   share * (hand.closed_angle[j].value_or(hand.max_angle[j]) - hand.open_angle[j]);
      }
      EXPECT_TRUE(session->set_sliders(angle));
      pass(0.03);
    }
    pass(0.5);
    const StepRecord newest = records.back();
    session->shut_down();
    session.reset();
    records.clear();
    return newest;
  }
};

TEST_F(Limited, ATorqueLimitLowersTheDescribedForceAndStiffnessAsTheTorques) {
  const StepRecord whole = pressed(0.0);
  ASSERT_GT(whole.force[1], 0.5);
  ASSERT_EQ(whole.factor, 1.0);
  EXPECT_EQ(whole.sent_share[1], 1.0);
  double most = 0.0;
  for (const double torque : whole.command.torque) most = std::max(most, std::abs(torque));
  const double limit = 0.5 * most;
  const StepRecord limited = pressed(limit);
  double product = 0.0;
  double square = 0.0;
  for (const double torque : whole.command.torque) {
    product += torque * std::clamp(torque, -limit, limit);
    square += torque * torque;
  }
  const double share = product / square;
  EXPECT_GE(share, 0.5) << "the largest torque is halved";
  EXPECT_LT(share, 0.75);
  EXPECT_NEAR(limited.force[1], whole.force[1], 1e-3) << "of the force law; both hands have come to rest";
  EXPECT_NEAR(limited.sent_share[1], share, 1e-4);
  EXPECT_EQ(limited.sent_share[2], 1.0) << "the middle finger does not press";
  EXPECT_NEAR(limited.sent_stiffness[1], share * whole.sent_stiffness[1], 1e-3 * whole.sent_stiffness[1]);
  HandObserver observer;
  EXPECT_DOUBLE_EQ(observer.observe(limited).force[1], limited.sent_share[1] * limited.force[1]);
  RecordProperty("share", fmt::format("{:.4f} of {:.3f} N", share, whole.force[1]));
}

}  // namespace
}  // namespace phalanx::test
