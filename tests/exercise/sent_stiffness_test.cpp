// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/sent_stiffness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "phalanx/exercise/observation.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;

constexpr std::array<bool, kDigits> kIndexOnly{false, true, false, false, false};

Observation pressed(double sent, double force = 1.0) {
  Observation out;
  out.torque_on = true;
  out.factor = 1.0;
  out.touching[1] = true;
  out.force[1] = force;
  out.depth.fill(std::numeric_limits<double>::quiet_NaN());
  out.depth[1] = force / sent;
  out.sent_stiffness.fill(std::numeric_limits<double>::quiet_NaN());
  out.sent_stiffness[1] = sent;
  return out;
}

TEST(SentStiffness, IsTheMeanOfTheSamples) {
  SentStiffness meter(500.0, kIndexOnly);
  for (int i = 0; i < 10; ++i) meter.add(pressed(480.0));
  for (int i = 0; i < 10; ++i) meter.add(pressed(500.0, 2.0));
  EXPECT_EQ(meter.reason(), "");
  EXPECT_DOUBLE_EQ(meter.mean(), 490.0);
  EXPECT_DOUBLE_EQ(meter.deepest(), 2.0 / 500.0);
}

TEST(SentStiffness, AFastPressThroughSmoothingDoesNotCount) {
  SentStiffness meter(1600.0, kIndexOnly);
  for (int i = 0; i < 40; ++i) meter.add(pressed(0.38 * 1600.0));
  for (int i = 0; i < 60; ++i) meter.add(pressed(1600.0));
  EXPECT_TRUE(meter.differs());
  EXPECT_DOUBLE_EQ(meter.mean(), 1600.0 * (0.4 * 0.38 + 0.6));
  EXPECT_THAT(meter.reason(),
              HasSubstr("40 % of the samples were not within 10 % of the commanded stiffness"));
}

TEST(SentStiffness, TooFewSamplesFaultsAndRampsDoNotCount) {
  SentStiffness few(500.0, kIndexOnly);
  for (int i = 0; i < 19; ++i) few.add(pressed(500.0));
  EXPECT_THAT(few.reason(), HasSubstr("19 samples"));
  EXPECT_FALSE(few.differs());
  few.add(pressed(500.0));
  EXPECT_EQ(few.reason(), "");

  SentStiffness faulty = few;
  Observation lost = pressed(500.0);
  lost.fault = ObservationFault::kNoSample;
  faulty.add(lost);
  EXPECT_THAT(faulty.reason(), HasSubstr("fault"));

  SentStiffness ramped = few;
  Observation half = pressed(500.0);
  half.factor = 0.5;
  ramped.add(half);
  EXPECT_THAT(ramped.reason(), HasSubstr("ramped"));

  SentStiffness off = few;
  Observation without = pressed(500.0);
  without.torque_on = false;
  off.add(without);
  EXPECT_THAT(off.reason(), HasSubstr("torque was off"));
}

TEST(SentStiffness, EveryDigitThatTouchesIsMeteredAndStepsWithoutContactAreLeftOut) {
  SentStiffness meter(500.0, kIndexOnly);
  for (int i = 0; i < 20; ++i) meter.add(pressed(500.0));
  meter.add(pressed(std::numeric_limits<double>::quiet_NaN()));  // too shallow
  Observation away = pressed(100.0);
  away.touching[1] = false;
  away.factor = 0.0;
  meter.add(away);
  EXPECT_EQ(meter.samples(), 20);
  EXPECT_EQ(meter.reason(), "");

  // The thumb presses the same sponge, six times at another stiffness: 6 of 26 samples differ.
  for (int i = 0; i < 6; ++i) {
    Observation thumb = pressed(std::numeric_limits<double>::quiet_NaN());
    thumb.touching[0] = true;
    thumb.sent_stiffness[0] = 100.0;
    thumb.depth[0] = 0.02;
    meter.add(thumb);
  }
  EXPECT_EQ(meter.samples(), 20) << "of the instructed digit";
  EXPECT_DOUBLE_EQ(meter.mean(), (20 * 500.0 + 6 * 100.0) / 26);
  EXPECT_TRUE(meter.differs());
  EXPECT_DOUBLE_EQ(meter.deepest(), 1.0 / 500.0) << "the thumb's depth is no end position";
  EXPECT_TRUE(std::isnan(SentStiffness(500.0, kIndexOnly).mean()));
}

TEST(SentStiffness, TheDepthIsThatOfTheContactNotTheForceOfAllSegmentsOverIt) {
  SentStiffness meter(500.0, kIndexOnly);
  Observation two_segments = pressed(500.0, 3.0);
  two_segments.depth[1] = 0.004;  // another segment of the digit presses, too
  meter.add(two_segments);
  EXPECT_DOUBLE_EQ(meter.deepest(), 0.004);
}

}  // namespace
}  // namespace phalanx
