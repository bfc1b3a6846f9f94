// SPDX-License-Identifier: Apache-2.0
// Each limit of a calibration from both sides, with readings worked out by hand.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/device/calibration.h"
#include "phalanx/hand/anthropometry.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

constexpr int kBoundedPip = joint_index(1, 2);

const HandParameters& bounded_hand() {
  static const HandParameters parameters = test::simple_parameters();
  return parameters;
}

DeviceChannel channel_of(ChannelKind kind, int index) {
  return {.kind = kind, .index = index, .raw_min = 0, .raw_max = 4095};
}

bool taken(const std::vector<PoseReading>& readings,
           const DeviceChannel& channel = channel_of(ChannelKind::kAngle, kBoundedPip)) {
  try {
    static_cast<void>(fit_channel(channel, readings, bounded_hand()));
  } catch (const CalibrationError&) {
    return false;
  }
  return true;
}

/// 0, 45 and 90 degrees at 1000, 2000 and 3000 counts: 0.045 degrees a count.
std::vector<PoseReading> clean_line() {
  return {{.pose = "open", .value = 0.0, .raw = 1000.0},
          {.pose = "half", .value = 45.0 * kDeg, .raw = 2000.0},
          {.pose = "fist", .value = 90.0 * kDeg, .raw = 3000.0}};
}

/// A straight line of two poses.
std::vector<PoseReading> from_to(double low, double high) {
  return {{.pose = "low", .value = low, .raw = 1000.0}, {.pose = "high", .value = high, .raw = 3000.0}};
}

// 3 degrees over 0.045 are 66.67 counts, of either sign and whichever way the counts go.
TEST(CalibrationBounds, AHandMayMoveByThreeDegreesWhileItIsMeasured) {
  for (const double sign : {1.0, -1.0}) {
    for (const bool turned : {false, true}) {
      for (std::size_t pose = 0; pose < 3; ++pose) {
        auto readings = clean_line();
        if (turned)
          for (PoseReading& r : readings) r.raw = 4000.0 - r.raw;
        readings[pose].drift = sign * 66.6;
        EXPECT_TRUE(taken(readings)) << pose;
        readings[pose].drift = sign * 66.8;
        EXPECT_FALSE(taken(readings)) << pose;
      }
    }
  }
}

// 2 degrees over 0.045 are 44.44 counts.
TEST(CalibrationBounds, NoiseMayBeTwoDegrees) {
  auto readings = clean_line();
  readings[1].noise = 44.4;
  EXPECT_TRUE(taken(readings));
  readings[1].noise = 44.6;
  EXPECT_FALSE(taken(readings));
}

// Values 0, x, x at 0, 100, 200 counts: the best line is off by x/6, -x/3, x/6, of which x/3 is 5 degrees at
// 15.
TEST(CalibrationBounds, APoseMayBeFiveDegreesBesideTheLine) {
  const auto beside = [](double x) {
    return std::vector<PoseReading>{{.pose = "a", .value = 0.0, .raw = 0.0},
                                    {.pose = "b", .value = x * kDeg, .raw = 100.0},
                                    {.pose = "c", .value = x * kDeg, .raw = 200.0}};
  };
  EXPECT_TRUE(taken(beside(14.99)));
  EXPECT_FALSE(taken(beside(15.01)));
  EXPECT_TRUE(taken(beside(-14.99))) << "and the other way round";
  EXPECT_FALSE(taken(beside(-15.01)));
}

// At least 50 counts.
TEST(CalibrationBounds, FiftyCountsAreEnough) {
  auto readings = from_to(0.0, 1.0);
  readings[1].raw = 1050.0;
  EXPECT_TRUE(taken(readings));
  readings[1].raw = 1049.9;
  EXPECT_FALSE(taken(readings));
  readings[1].raw = 950.0;
  EXPECT_TRUE(taken(readings)) << "also downwards";
}

// Poses that differ by less than a degree are one. Of a curl, whose joints of this hand go through 2.5 rad, a
// degree is 0.00698.
TEST(CalibrationBounds, TwoPosesMustBeADegreeApart) {
  EXPECT_TRUE(taken(from_to(0.0, 1.01 * kDeg)));
  EXPECT_FALSE(taken(from_to(0.0, 0.99 * kDeg)));
  const DeviceChannel curl = channel_of(ChannelKind::kCurl, 1);
  EXPECT_TRUE(taken(from_to(0.5, 0.5071), curl));
  EXPECT_FALSE(taken(from_to(0.5, 0.5069), curl));
}

TEST(CalibrationBounds, TheEndsOfTheRawRangeAreInside) {
  auto readings = clean_line();
  readings[0].raw = 0.0;
  readings[1].raw = 2047.5;
  readings[2].raw = 4095.0;
  EXPECT_TRUE(taken(readings));
  readings[0].raw = -0.5;
  EXPECT_FALSE(taken(readings));
  readings[0].raw = 0.0;
  readings[2].raw = 4095.5;
  EXPECT_FALSE(taken(readings));
}

// 5 degrees beyond what is anatomically possible, both ways.
TEST(CalibrationBounds, AnAngleMayBeFiveDegreesBeyondWhatAHandCanDo) {
  for (const int joint : {kBoundedPip, joint_index(0, 1), joint_index(4, 1)}) {
    const DeviceChannel channel = channel_of(ChannelKind::kAngle, joint);
    const PlausibleRange range = plausible_angle(joint);
    EXPECT_TRUE(taken(from_to(range.min - 4.99 * kDeg, range.max + 4.99 * kDeg), channel));
    EXPECT_FALSE(taken(from_to(range.min - 5.01 * kDeg, range.max), channel));
    EXPECT_FALSE(taken(from_to(range.min, range.max + 5.01 * kDeg), channel));
  }
}

// A curl is 0 to 1, and 5 degrees of 2.5 rad are 0.0349; a splay is -1 to 1, and 5 degrees of 0.6 rad are
// 0.1454.
TEST(CalibrationBounds, ACurlAndASplayMayBeFiveDegreesBeyondTheirEnds) {
  const DeviceChannel curl = channel_of(ChannelKind::kCurl, 1);
  EXPECT_TRUE(taken(from_to(-0.0348, 1.0348), curl));
  EXPECT_FALSE(taken(from_to(-0.0350, 1.0), curl));
  EXPECT_FALSE(taken(from_to(0.0, 1.0350), curl));
  const DeviceChannel splay = channel_of(ChannelKind::kSplay, 1);
  EXPECT_TRUE(taken(from_to(-1.1453, 1.1453), splay));
  EXPECT_FALSE(taken(from_to(-1.1456, 1.0), splay));
  EXPECT_FALSE(taken(from_to(-1.0, 1.1456), splay));
}

// Ranges of 1.5, 0.8, 1.8 and 1.2 rad: a curl is (1.5 + 1.8 + 1.2) / 3 = 1.5 rad, a splay half of 0.8.
TEST(CalibrationBounds, AUnitOfACurlIsTheMeanFlexionAndOfASplayHalfTheAbduction) {
  HandParameters hand = bounded_hand();
  const std::array<double, kJointsPerDigit> range = {1.5, 0.8, 1.8, 1.2};
  for (int i = 0; i < kJointsPerDigit; ++i) {
    const auto j = static_cast<std::size_t>(joint_index(3, i));
    hand.min_angle[j] = -0.1 * (i + 1);
    hand.max_angle[j] = hand.min_angle[j] + range[static_cast<std::size_t>(i)];
  }
  EXPECT_NEAR(radians_per_unit(ChannelKind::kCurl, 3, hand), 1.5, 1e-12);
  EXPECT_NEAR(radians_per_unit(ChannelKind::kSplay, 3, hand), 0.4, 1e-12);
  EXPECT_EQ(radians_per_unit(ChannelKind::kAngle, joint_index(3, 2), hand), 1.0);
}

// 0, 2, 1: the line 0.5, 1, 1.5 drifts by 1, and -0.5, 1, -0.5 are left: rms sqrt(1.5 / 3).
TEST(CalibrationBounds, MeanDriftAndNoiseOfThreeCountsByHand) {
  RawAverage average;
  for (const int raw : {100, 102, 101}) average.add(raw);
  EXPECT_NEAR(average.mean(), 101.0, 1e-12);
  EXPECT_NEAR(average.drift(), 1.0, 1e-12);
  EXPECT_NEAR(average.noise(), std::sqrt(0.5), 1e-12);
  RawAverage two;
  for (const int raw : {10, 20}) two.add(raw);
  EXPECT_NEAR(two.mean(), 15.0, 1e-12);
  EXPECT_NEAR(two.drift(), 10.0, 1e-12);
  EXPECT_NEAR(two.noise(), 0.0, 1e-12);
}

}  // namespace
}  // namespace phalanx
