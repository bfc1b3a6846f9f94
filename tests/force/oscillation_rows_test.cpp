// SPDX-License-Identifier: Apache-2.0
// The observer's rule on zigzags whose legs are worked out by hand: how long three half-swings may take, how
// much may die out, and which half-swings are noise.
#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <vector>

#include "phalanx/force/oscillation.h"

namespace phalanx {
namespace {

constexpr double kMillisecond = 1e-3;

/// Straight from extreme to extreme, so many milliseconds each.
/// @returns the leg at which the observer fires first, the leg from extremes[0] to extremes[1] being the
/// first; 0: none
int fires_at_leg(const std::vector<double>& extremes, int milliseconds) {
  OscillationObserver observer;
  observer.watch(extremes[0], 0.5, kMillisecond);
  for (std::size_t leg = 1; leg < extremes.size(); ++leg) {
    const double from = extremes[leg - 1];
    const double to = extremes[leg];
    for (int i = 1; i <= milliseconds; ++i) {
      const double force = i == milliseconds ? to : from + (to - from) * i / milliseconds;
      if (observer.watch(force, 0.5, kMillisecond)) return static_cast<int>(leg);
    }
  }
  return 0;
}

std::vector<double> even(int legs) {
  std::vector<double> extremes;
  for (int i = 0; i <= legs; ++i) extremes.push_back(i % 2 == 0 ? 0.0 : 2.0);
  return extremes;
}

// Three half-swings of 79 ms are 237 ms; of 81 ms, 243: those need six legs. Of 259 ms each the sixth leg
// fires, of 262 ms none.
TEST(OscillationRows, FireAtTheFourthLegWithinTwoHundredAndFortyMillisecondsElseAtTheSixth) {
  EXPECT_EQ(fires_at_leg(even(12), 79), 4);
  EXPECT_EQ(fires_at_leg(even(12), 81), 6);
  EXPECT_EQ(fires_at_leg(even(12), 119), 6) << "two of them are within 240 ms";
  EXPECT_EQ(fires_at_leg(even(12), 259), 6);
  EXPECT_EQ(fires_at_leg(even(12), 262), 0);
}

// At the fourth leg the legs before were 4, 3 and x N: the last is held against half the first, 2 N.
TEST(OscillationRows, DoNotFireWhereTheThirdSwingIsBelowHalfTheFirst) {
  EXPECT_EQ(fires_at_leg({0.0, 4.0, 1.0, 3.0, 0.0}, 40), 4) << "2 N";
  EXPECT_EQ(fires_at_leg({0.0, 4.0, 1.0, 2.875, 0.0}, 40), 0) << "1.875 N, of 3 N more than half";
}

// The same of the sixth: legs of 4, 4, 4, 4 and x N, 100 ms each.
TEST(OscillationRows, DoNotFireAtTheSixthLegWhereTheFifthSwingIsBelowHalfTheFirst) {
  EXPECT_EQ(fires_at_leg({0.0, 4.0, 0.0, 4.0, 0.0, 2.0, 0.0}, 100), 6);
  EXPECT_EQ(fires_at_leg({0.0, 4.0, 0.0, 4.0, 0.0, 1.875, 0.0}, 100), 0);
}

// A force that rests at zero for some steps swings by the whole of 2 N, eight steps of 5 ms to and fro: 25
// Hz.
TEST(OscillationRows, MeasureTheWholeSwingOfAForceThatRestsAtZero) {
  OscillationObserver observer;
  for (int n = 0; n < 80; ++n) observer.watch(n % 8 < 4 ? 0.0 : 2.0, 0.5, 5.0 * kMillisecond);
  EXPECT_EQ(observer.swing(), 2.0);
  EXPECT_DOUBLE_EQ(observer.frequency(), 25.0);
}

TEST(OscillationRows, ForgetAtZeroWhatNeverSwung) {
  OscillationObserver observer;
  observer.watch(0.4, 0.5, kMillisecond);
  EXPECT_FALSE(observer.idle());
  observer.watch(0.0, 0.5, kMillisecond);
  EXPECT_TRUE(observer.idle());
}

// Every step of 200 Hz another extreme is a half-swing of 5 ms and counts; of 1 kHz one of 3 ms is noise.
TEST(OscillationRows, TakeHalfSwingsBelowFourMillisecondsForNoise) {
  EXPECT_EQ(fires_at_leg(even(40), 5), 4);
  EXPECT_EQ(fires_at_leg(even(400), 3), 0);
}

/// From 0 to 2 N and back, one step each.
/// @returns the leg at which the observer fires first; 0: none
int fires_at_step(double period) {
  OscillationObserver observer;
  observer.watch(0.0, 0.5, period);
  for (int leg = 1; leg <= 20; ++leg)
    if (observer.watch(leg % 2 == 1 ? 2.0 : 0.0, 0.5, period)) return leg;
  return 0;
}

// A half-swing of 4 ms is not taken for noise, three of 80 ms are 240 ms, and 260 ms are not too long for six
// legs.
TEST(OscillationRows, FireAtTheirBoundsThemselves) {
  EXPECT_EQ(fires_at_step(4.0 * kMillisecond), 4);
  EXPECT_EQ(fires_at_step(80.0 * kMillisecond), 4);
  EXPECT_EQ(fires_at_step(260.0 * kMillisecond), 6);
}

/// Steps to and fro between 0 and 2 N, so many milliseconds after each other; the first is a leg by itself.
/// @returns the leg at which the observer fires first; 0: none
int fires_at_leg_after(const std::vector<int>& half_swings) {
  OscillationObserver observer;
  observer.watch(0.0, 0.5, kMillisecond);
  double force = 2.0;
  observer.watch(force, 0.5, kMillisecond);
  int leg = 1;
  for (const int half_swing : half_swings) {
    for (int i = 1; i < half_swing; ++i) observer.watch(force, 0.5, kMillisecond);
    force = 2.0 - force;
    ++leg;
    if (observer.watch(force, 0.5, kMillisecond)) return leg;
  }
  return 0;
}

// The fourth leg fires where all three half-swings together take at most 240 ms, each counted once: 220 ms
// do, whether the short one is the first or the last; 250 ms do not, though two of them are 40 ms.
TEST(OscillationRows, AddUpThreeHalfSwingsOfDifferentLengths) {
  EXPECT_EQ(fires_at_leg_after({100, 100, 20}), 4);
  EXPECT_EQ(fires_at_leg_after({20, 100, 100}), 4);
  EXPECT_EQ(fires_at_leg_after({210, 20, 20}), 0);
  EXPECT_EQ(fires_at_leg_after({20, 210, 20}), 0);
}

// Half a second after the first leg the second begins a new row: the sixth of that is the seventh of all.
TEST(OscillationRows, BeginAgainWithALegThatComesAfterMoreThanTheLongestHalfSwing) {
  EXPECT_EQ(fires_at_leg_after({500, 100, 100, 100, 100, 100}), 7);
}

// Steps of 0.25 s: after two of them without a leg the verdict still holds, after three it does not.
TEST(OscillationRows, HoldTheirVerdictForHalfASecondItself) {
  OscillationObserver observer;
  for (int leg = 0; leg <= 6; ++leg) observer.watch(leg % 2 == 1 ? 2.0 : 0.0, 0.5, 0.25);
  ASSERT_TRUE(observer.oscillating());
  for (int n = 1; n <= 3; ++n) {
    observer.watch(0.0, 0.5, 0.25);
    EXPECT_EQ(observer.oscillating(), n <= 2) << n;
  }
}

// A rise and a fall of 0.5 N are not more than 0.5 N.
TEST(OscillationRows, NeedMoreThanTheSwingItself) {
  OscillationObserver observer;
  for (const double force : {0.0, 0.5, 0.0}) observer.watch(force, 0.5, 5.0 * kMillisecond);
  EXPECT_TRUE(observer.idle());
}

TEST(OscillationRows, TakeWhatIsNotFiniteOrNegativeForNoForce) {
  for (const double force :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity(), -2.0}) {
    OscillationObserver observer;
    EXPECT_FALSE(observer.watch(force, 0.5, 5.0 * kMillisecond)) << force;
    EXPECT_TRUE(observer.idle()) << force;
  }
}

}  // namespace
}  // namespace phalanx
