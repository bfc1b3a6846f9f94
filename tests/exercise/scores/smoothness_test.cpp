// SPDX-License-Identifier: Apache-2.0
// Smoothness: the published value of SPARC, a spectrum by hand, and movements of known shape.
#include "phalanx/exercise/smoothness.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <stdexcept>

#include "exercise/scores/observed_steps.h"
#include "phalanx/core/random.h"

namespace phalanx::test {
namespace {

using ::testing::HasSubstr;

/// exp(-5 t^2), t in [-1, 1), at 100 Hz: the example of the authors' program.
std::vector<double> published_speed() {
  std::vector<double> speed;
  for (int i = -100; i < 100; ++i) speed.push_back(std::exp(-5.0 * (0.01 * i) * (0.01 * i)));
  return speed;
}

/// The path of least jerk from 0 to 1 in the time 1.                                      Flash & Hogan 1985
double least_jerk(double t) {
  const double s = std::min(std::max(t, 0.0), 1.0);
  return s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
}

/// 3 s at 200 Hz: the index flexes by `parts` equal movements of 1 rad in all, one each 1/parts s, from
/// 0.5 s on.
std::vector<Observation> flexed_in(int parts) {
  std::vector<Observation> steps;
  for (int i = 0; i <= 600; ++i) {
    steps.push_back(running_step(0.005 * i));
    double angle = 0.0;
    for (int part = 0; part < parts; ++part)
      angle += least_jerk((steps.back().time - 0.5) * parts - part) / parts;
    steps.back().angle[idx(joint_index(1, 2))] = angle;
  }
  return steps;
}

/// The arc of a spectrum that is summed term by term, without a fast transform.
double arc_by_definition(const std::vector<double>& speed, double rate) {
  std::size_t points = 1;
  while (points < speed.size()) points *= 2;
  points *= 16;
  std::vector<double> magnitude;
  for (std::size_t k = 0; static_cast<double>(k) * rate / static_cast<double>(points) <= 10.0; ++k) {
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < speed.size(); ++i)
      sum += speed[i] *
             std::polar(1.0, -2.0 * kPi * static_cast<double>(k * i % points) / static_cast<double>(points));
    magnitude.push_back(std::abs(sum));
  }
  const double largest = magnitude.front();  // all speeds are positive
  std::size_t last = magnitude.size() - 1;
  while (magnitude[last] < 0.05 * largest) --last;
  double length = 0.0;
  for (std::size_t k = 0; k < last; ++k)
    length += std::sqrt(std::pow(1.0 / static_cast<double>(last), 2) +
                        std::pow((magnitude[k + 1] - magnitude[k]) / largest, 2));
  return -length;
}

TEST(Smoothness, SparcHasThePublishedValue) {
  EXPECT_NEAR(spectral_arc_length(published_speed(), 100.0), -1.41403, 0.5e-5);
  EXPECT_NEAR(spectral_arc_length(published_speed(), 100.0), -1.4140312617104789, 1e-12)
      << "by NumPy's transform";
}

TEST(Smoothness, SparcOfTwoEqualSpeedsIsAsByHand) {
  const std::vector<double> speed = {1.0, 1.0};
  EXPECT_DOUBLE_EQ(spectral_arc_length(speed, 4.0, {.padding = 0, .threshold = 0.0}), -std::sqrt(2.0));
}

TEST(Smoothness, SparcEqualsASpectrumThatIsSummedByDefinition) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::vector<double> speed(static_cast<std::size_t>(random.between(20.0, 90.0)));
    for (double& v : speed) v = random.between(0.1, 1.0);
    EXPECT_NEAR(spectral_arc_length(speed, 100.0), arc_by_definition(speed, 100.0), 1e-12);
  }
}

TEST(Smoothness, SparcDoesNotDependOnTheSizeOfTheMovement) {
  std::vector<double> speed = published_speed();
  const double one = spectral_arc_length(speed, 100.0);
  for (double& v : speed) v *= 1e-3;
  EXPECT_NEAR(spectral_arc_length(speed, 100.0), one, 1e-12);
}

TEST(Smoothness, SparcRefusesWhatHasNoSpectrum) {
  const std::vector<double> still(100, 0.0);
  EXPECT_THROW(static_cast<void>(spectral_arc_length(still, 100.0)), std::invalid_argument);
  for (const std::vector<double>& bad :
       {std::vector<double>{}, std::vector<double>{1.0}, std::vector<double>{1.0, kNaN, 1.0},
        std::vector<double>{1.0, kInfinity}})
    EXPECT_THROW(static_cast<void>(spectral_arc_length(bad, 100.0)), std::invalid_argument);
  const std::vector<double> good = published_speed();
  for (const double rate : {0.0, -1.0, kNaN, kInfinity})
    EXPECT_THROW(static_cast<void>(spectral_arc_length(good, rate)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(spectral_arc_length(good, 100.0, {.padding = 30})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(spectral_arc_length(good, 100.0, {.cut_off = kNaN})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(spectral_arc_length(good, 100.0, {.threshold = 1.5})),
               std::invalid_argument);
}

TEST(Smoothness, AMovementOfLeastJerkHasItsPeakSpeedAndDuration) {
  const auto scores = smoothness_scores(flexed_in(1), {.digit = 1, .calibration_independent = true});
  EXPECT_NEAR(value_of(scores, "peak_speed_deg_per_s"), 1.875 * kRadToDeg, 0.1) << "15/8 of the mean speed";
  // The speed 30 s^2 (1-s)^2 is 5 % of its peak at s = 0.0593.
  EXPECT_NEAR(value_of(scores, "movement_time_s"), 1.0 - 2.0 * 0.0593, 0.02);
  EXPECT_DOUBLE_EQ(value_of(scores, "speed_peaks"), 1.0);
}

TEST(Smoothness, AMovementInPartsIsLessSmooth) {
  double last = 0.0;
  for (int parts = 1; parts <= 4; ++parts) {
    const auto scores = smoothness_scores(flexed_in(parts), {.digit = 1});
    EXPECT_DOUBLE_EQ(value_of(scores, "speed_peaks"), parts);
    EXPECT_LT(value_of(scores, "sparc"), last - 0.1) << parts << " parts";
    last = value_of(scores, "sparc");
  }
}

TEST(Smoothness, WithoutAnIndependentCalibrationOnlyTheSpeedIsMissing) {
  const auto scores = smoothness_scores(flexed_in(1), {.digit = 1});
  EXPECT_THAT(reason_of(scores, "peak_speed_deg_per_s"), HasSubstr("the calibration depends on"));
  for (const char* name : {"sparc", "movement_time_s", "speed_peaks"})
    EXPECT_TRUE(score_of(scores, name).valid()) << name;
}

/// 1.5 s of a loop of 500 Hz over a device of `rate`, which a movement of least jerk crosses: 1.2 rad in
/// 0.8 s, from 0.3 s on. The newest sample is the last one that the device took before the step, `phase` of
/// its interval apart.
std::vector<Observation> held_samples(double rate, double phase) {
  std::vector<Observation> steps;
  for (int i = 0; i < 750; ++i) {
    steps.push_back(running_step(0.002 * i));
    const double sampled = (std::floor(steps.back().time * rate - phase) + phase) / rate;
    steps.back().sample_time = sampled;
    steps.back().angle[idx(joint_index(1, 2))] = 1.2 * least_jerk((sampled - 0.3) / 0.8);
  }
  return steps;
}

TEST(Smoothness, ADeviceThatIsSlowerThanTheLoopGivesTheTrueMovement) {
  const double peak = 1.875 * 1.2 / 0.8 * kRadToDeg;  // 161 deg/s
  const double sparc = value_of(smoothness_scores(held_samples(500.0, 0.0), {.digit = 1}), "sparc");
  for (const double rate : {30.0, 60.0, 90.0, 125.0, 400.0})
    for (const double phase : {0.0, 0.25, 0.5, 0.75}) {
      SCOPED_TRACE(fmt::format("{} Hz, phase {}", rate, phase));
      const auto scores =
          smoothness_scores(held_samples(rate, phase), {.digit = 1, .calibration_independent = true});
      EXPECT_EQ(value_of(scores, "speed_peaks"), 1.0);
      EXPECT_NEAR(value_of(scores, "peak_speed_deg_per_s"), peak, 0.02 * peak);
      EXPECT_NEAR(value_of(scores, "movement_time_s"), 0.8 * (1.0 - 2.0 * 0.0593), 0.05);
      EXPECT_NEAR(value_of(scores, "sparc"), sparc, 0.02);
    }
}

TEST(Smoothness, TooFewSamplesASecondHaveNoSpeed) {
  const auto slow = held_samples(15.0, 0.0);
  expect_none(smoothness_scores(slow, {.digit = 1}), "the device gave 15.0 samples a second in the trial");
  auto steps = held_samples(60.0, 0.0);
  steps[400].sample_time = 0.1;
  expect_none(smoothness_scores(steps, {.digit = 1}), "the device's time goes back at 0.800 s");
  for (Observation& step : steps) step.sample_time = 0.0;
  expect_none(smoothness_scores(steps, {.digit = 1}), "the device gave 0.0 samples a second");
  steps[3].sample_time = kNaN;
  expect_none(smoothness_scores(steps, {.digit = 1}), "the time of the sample at 0.006 s is not known");
}

TEST(Smoothness, FlexionNeedsItsOwnJointsOnly) {
  auto steps = flexed_in(1);
  for (Observation& step : steps) step.angle_origin[idx(joint_index(1, 1))] = AngleOrigin::kFixed;
  EXPECT_TRUE(score_of(smoothness_scores(steps, {.digit = 1}), "sparc").valid());
  for (Observation& step : steps) step.angle_origin[idx(joint_index(1, 3))] = AngleOrigin::kCompleted;
  expect_none(smoothness_scores(steps, {.digit = 1}),
              "not measured: the angle of index_dip_flexion is completed");
}

TEST(Smoothness, AHandThatHardlyMovesHasNoScore) {
  expect_none(smoothness_scores(flexed_in(1), {.digit = 2}),
              "the largest speed of 0.0 deg/s is below 5.7 deg/s");
  auto steps = flexed_in(1);
  steps.resize(5);  // 0.02 s
  expect_none(smoothness_scores(steps, {.digit = 1}), "the trial is shorter than 0.03 s");
  EXPECT_THROW(static_cast<void>(smoothness_scores(steps, {.digit = 5})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(smoothness_scores(steps, {.least_speed = 0.0})), std::invalid_argument);
}

}  // namespace
}  // namespace phalanx::test
