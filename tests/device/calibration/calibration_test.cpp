// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "phalanx/core/constants.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;

constexpr int kCalibrated = joint_index(1, 2);

DeviceChannel pip_channel() {
  return {.kind = ChannelKind::kAngle, .index = kCalibrated, .raw_min = 0, .raw_max = 4095};
}

const HandParameters& the_hand() {
  static const HandParameters parameters = test::simple_parameters();
  return parameters;
}

PoseReading reading(const char* pose, double value, double raw) {
  return {.pose = pose, .value = value, .raw = raw, .noise = 1.0, .drift = 1.0};
}

// 0, 45 and 90 deg at 1000, 2000 and 3000 counts.
std::vector<PoseReading> straight_line() {
  return {reading("open hand", 0.0, 1000.0), reading("half way", 45.0 * kDeg, 2000.0),
          reading("fist", 90.0 * kDeg, 3000.0)};
}

void expect_refused(const std::vector<PoseReading>& readings, const std::vector<std::string>& words,
                    const DeviceChannel& channel = pip_channel()) {
  try {
    static_cast<void>(fit_channel(channel, readings, the_hand()));
    ADD_FAILURE() << "accepted; expected a message with " << ::testing::PrintToString(words);
  } catch (const CalibrationError& error) {
    for (const std::string& word : words) EXPECT_THAT(error.what(), HasSubstr(word));
  }
}

// ---- averaging ----

TEST(RawAverage, OfAStraightLineHasItsMeanAndDriftAndNoNoise) {
  RawAverage average;
  for (int i = 0; i <= 100; ++i) average.add(2000000000 + 3 * i);
  EXPECT_EQ(average.count(), 101U);
  EXPECT_NEAR(average.mean(), 2000000150.0, 1e-5);
  EXPECT_NEAR(average.drift(), 300.0, 1e-9);
  EXPECT_NEAR(average.noise(), 0.0, 1e-4);
}

// Up and down by one: rms 1, and no drift, however large the counts are.
TEST(RawAverage, OfAnAlternationIsItsRms) {
  for (const int counts : {100, 2000000000}) {
    RawAverage average;
    for (int i = 0; i < 1001; ++i) average.add(i % 2 == 0 ? counts + 1 : counts - 1);
    EXPECT_NEAR(average.noise(), 1.0, 1e-3);
    EXPECT_NEAR(average.drift(), 0.0, 1e-9);
  }
}

TEST(RawAverage, OfNothingOrOneIsQuiet) {
  RawAverage average;
  EXPECT_EQ(average.mean(), 0.0);
  EXPECT_EQ(average.noise(), 0.0);
  average.add(-7);
  EXPECT_EQ(average.mean(), -7.0);
  EXPECT_EQ(average.drift(), 0.0);
}

// ---- the fit ----

TEST(CalibrationFit, OfAStraightLineIsThatLine) {
  const ChannelFit fit = fit_channel(pip_channel(), straight_line(), the_hand());
  EXPECT_NEAR(fit.gain, 0.045 * kDeg, 1e-15);
  EXPECT_NEAR(fit.offset, -45.0 * kDeg, 1e-12);
  EXPECT_NEAR(fit.worst, 0.0, 1e-12);
}

TEST(CalibrationFit, FindsTheDirection) {
  auto readings = straight_line();
  for (PoseReading& r : readings) r.raw = 4000.0 - r.raw;
  const ChannelFit fit = fit_channel(pip_channel(), readings, the_hand());
  EXPECT_NEAR(fit.gain, -0.045 * kDeg, 1e-15);
  EXPECT_NEAR(fit.gain * 3000.0 + fit.offset, 0.0, 1e-12);
}

// By hand: values 0, 1, 2 (of 0.03 rad) at raw 0, 100, 200 with the middle one 0.03 too
// high: gain 0.0003, offset 0.01, residuals +0.01, -0.02, +0.01.
TEST(CalibrationFit, IsTheLeastSquaresOne) {
  const std::vector<PoseReading> readings = {reading("a", 0.0, 0.0), reading("b", 0.06, 100.0),
                                             reading("c", 0.06, 200.0)};
  const ChannelFit fit =
      fit_channel(pip_channel(), readings, the_hand(), {.most_noise = 1.0, .most_drift = 1.0});
  EXPECT_NEAR(fit.gain, 0.0003, 1e-12);
  EXPECT_NEAR(fit.offset, 0.01, 1e-12);
  EXPECT_NEAR(fit.residual[0], 0.01, 1e-12);
  EXPECT_NEAR(fit.residual[1], -0.02, 1e-12);
  EXPECT_NEAR(fit.worst, 0.02, 1e-12);
}

// Whatever the gain, the offset and the noise below the limits, both come back within what the noise allows.
TEST(CalibrationFit, FindsWhatMadeTheCounts) {
  constexpr unsigned kSeed = 4711;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int round = 0; round < 2000; ++round) {
    const double span = 1000.0 + 400.0 * unit(random);
    const double sign = unit(random) < 0.0 ? -1.0 : 1.0;
    const double gain = sign * 90.0 * kDeg / span;
    const double offset = 45.0 * kDeg - gain * 2000.0;  // half way at 2000 counts
    std::vector<PoseReading> readings = straight_line();
    for (PoseReading& r : readings) r.raw = (r.value - offset) / gain + 5.0 * unit(random);
    const ChannelFit fit = fit_channel(pip_channel(), readings, the_hand());
    EXPECT_NEAR(fit.gain, gain, 5.0 * std::abs(gain) / span * 2.0) << "seed " << kSeed;
    EXPECT_LE(fit.worst, 10.0 * std::abs(gain)) << "seed " << kSeed;
  }
}

// A curl's 5 deg are 5 deg of the mean joint: 2.5 rad here, so that 0.034 of a curl is still believed.
TEST(CalibrationFit, MeasuresACurlsResidualInAngle) {
  const DeviceChannel curl{.kind = ChannelKind::kCurl, .index = 1, .raw_min = 0, .raw_max = 4095};
  std::vector<PoseReading> readings = {reading("open hand", 0.2, 1000.0), reading("fist", 1.0, 3000.0),
                                       reading("stretched", 0.0, 500.0)};
  EXPECT_NEAR(fit_channel(curl, readings, the_hand()).worst, 0.0, 1e-12);
  readings[0].raw += 0.03 / 0.8 * 2000.0;
  const ChannelFit fit = fit_channel(curl, readings, the_hand());
  EXPECT_GT(fit.worst, 0.01 * 2.5);
  EXPECT_LT(fit.worst, 0.03 * 2.5);
}

// ---- what is refused ----

TEST(CalibrationFit, RefusesFewerThanTwoPosesThatDiffer) {
  expect_refused({}, {"angle of index_pip_flexion", "0 poses", "more than 1 deg"});
  expect_refused({reading("fist", 1.5, 3000.0)}, {"1 poses"});
  expect_refused({reading("fist", 1.5, 1000.0), reading("end stop", 1.5, 3000.0)},
                 {"2 poses, 0.0 deg apart"});
}

TEST(CalibrationFit, RefusesASensorThatDoesNotMove) {
  expect_refused({reading("open hand", 0.0, 1000.0), reading("fist", 1.5, 1049.0)},
                 {"by only 49.0", "at least 50", "connected"});
}

TEST(CalibrationFit, RefusesAPoseBesideTheLine) {
  auto readings = straight_line();
  readings[1].raw += 200.0;  // 9 deg: 5.9 of them remain beside the best line
  expect_refused(readings, {"half way: +5.9 deg", "5.0", "the angle that is stated"});
}

TEST(CalibrationFit, RefusesPosesThatDisagreeOnTheDirection) {
  expect_refused({reading("open hand", 0.0, 1000.0), reading("fist", 90.0 * kDeg, 3000.0),
                  reading("bent", 90.0 * kDeg, 2950.0), reading("straight", 0.0, 3500.0)},
                 {"'straight' (raw 3500)", "the other way"});
}

TEST(CalibrationFit, RefusesAHandThatMoved) {
  auto readings = straight_line();
  readings[2].drift = 100.0;  // 4.5 deg
  expect_refused(readings, {"fist", "moved by 4.5 deg", "measure again"});
}

TEST(CalibrationFit, RefusesNoise) {
  auto readings = straight_line();
  readings[0].noise = 50.0;  // 2.25 deg
  expect_refused(readings, {"open hand", "noise is 2.2 deg", "2.0"});
}

TEST(CalibrationFit, RefusesWhatNoHandCanDo) {
  expect_refused({reading("open hand", 0.0, 1000.0), reading("fist", 200.0 * kDeg, 3000.0)},
                 {"fist: 200.0 deg", "beyond what a hand can do"});
}

TEST(CalibrationFit, RefusesAnOpenSensorAndWhatIsNotANumber) {
  auto readings = straight_line();
  readings[2].raw = 5000.0;
  expect_refused(readings, {"fist: raw 5000", "0 .. 4095", "cable"});
  for (double PoseReading::* field :
       {&PoseReading::raw, &PoseReading::value, &PoseReading::noise, &PoseReading::drift}) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      readings = straight_line();
      readings[1].*field = bad;
      expect_refused(readings, {"half way", "not finite"});
    }
  }
}

// ---- names ----

TEST(ChannelLabel, SaysWhatIsMeasuredAndWhere) {
  struct Label {
    ChannelKind kind;
    int index;
    const char* text;
  };
  for (const Label& label : {Label{ChannelKind::kAngle, 6, "angle of index_pip_flexion"},
                             {ChannelKind::kTorque, 4, "torque on index_mcp_flexion"},
                             {ChannelKind::kForce, 0, "force on thumb"},
                             {ChannelKind::kMotor, 3, "motor 3"},
                             {ChannelKind::kCurl, 4, "curl of little"},
                             {ChannelKind::kSplay, 2, "splay of middle"},
                             {ChannelKind::kAngle, 20, "angle of joint 20"},
                             {ChannelKind::kTorque, -1, "torque on joint -1"},
                             {ChannelKind::kCurl, 5, "curl of digit 5"},
                             {ChannelKind::kForce, -1, "force on digit -1"},
                             {static_cast<ChannelKind>(9), 0, "channel of kind 9"}})
    EXPECT_EQ(channel_label(label.kind, label.index), label.text);
}

// ---- whose it is ----

DeviceInfo device() {
  DeviceInfo info;
  info.name = "glove";
  info.serial = "0007";
  info.channels = {pip_channel(),
                   {.kind = ChannelKind::kMotor, .index = 0, .raw_min = -9, .raw_max = 9, .gain = 1e-6},
                   {.kind = ChannelKind::kSplay, .index = 3, .raw_min = 0, .raw_max = 1023}};
  return info;
}

Calibration calibration() {
  Calibration c{.device = "glove",
                .serial = "0007",
                .date = "2026-05-04T09:30:00Z",
                .phalanx = "0.1.0",
                .channels = {}};
  c.channels.push_back({.channel = {.kind = ChannelKind::kSplay, .index = 3, .gain = 0.003, .offset = -1.5}});
  c.channels.push_back(
      {.channel = {.kind = ChannelKind::kAngle, .index = kCalibrated, .gain = -0.001, .offset = 2.0}});
  return c;
}

void expect_not_applied(const std::function<void(Calibration&, DeviceInfo&)>& change,
                        const std::vector<std::string>& words) {
  Calibration c = calibration();
  DeviceInfo info = device();
  change(c, info);
  try {
    static_cast<void>(apply_calibration(c, info));
    ADD_FAILURE() << "accepted; expected a message with " << ::testing::PrintToString(words);
  } catch (const CalibrationError& error) {
    for (const std::string& word : words) EXPECT_THAT(error.what(), HasSubstr(word));
  }
}

TEST(ApplyCalibration, ReplacesGainAndOffsetAndNothingElse) {
  const auto channels = apply_calibration(calibration(), device());
  ASSERT_EQ(channels.size(), 3U);
  EXPECT_EQ(channels[0].gain, -0.001);
  EXPECT_EQ(channels[0].offset, 2.0);
  EXPECT_EQ(channels[0].raw_max, 4095);
  EXPECT_EQ(channels[1].gain, 1e-6) << "a motor keeps the maker's";
  EXPECT_EQ(channels[2].gain, 0.003);
}

TEST(ApplyCalibration, RefusesAnotherDevicesCalibration) {
  expect_not_applied([](Calibration&, DeviceInfo& d) { d.serial = "0008"; },
                     {"made for glove 0007", "this is glove 0008", "calibrate this device"});
  expect_not_applied([](Calibration&, DeviceInfo& d) { d.name = "hand"; }, {"this is hand 0007"});
}

TEST(ApplyCalibration, RefusesOtherChannels) {
  expect_not_applied([](Calibration& c, DeviceInfo&) { c.channels.pop_back(); },
                     {"no angle of index_pip_flexion", "calibrate again"});
  expect_not_applied([](Calibration&, DeviceInfo& d) { d.channels.pop_back(); }, {"2 channels", "only 1"});
}

}  // namespace
}  // namespace phalanx
