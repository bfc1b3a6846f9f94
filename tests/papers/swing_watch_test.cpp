// SPDX-License-Identifier: Apache-2.0
#include "papers/swing_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace phalanx {
namespace {

constexpr double kHostPeriod = 0.005;  // of the host [s]

/// What the watch says first of a force over 4 s; NaN: nothing.
double first_verdict(const std::function<double(double t)>& force) {
  SwingWatch watch;
  for (int i = 0; i <= 800; ++i) {
    const double since = watch.add(kHostPeriod * i, force(kHostPeriod * i));
    if (!std::isnan(since)) return since;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double sine(double t, double amplitude, double hz) {
  return 3.0 + amplitude * std::sin(2.0 * std::numbers::pi * hz * t);
}

TEST(SwingWatch, SaysNothingOfAPressAndARelease) {
  EXPECT_TRUE(std::isnan(first_verdict([](double) { return 3.0; })));
  EXPECT_TRUE(std::isnan(first_verdict([](double t) { return std::min(3.0, 10.0 * t); })));
  EXPECT_TRUE(std::isnan(first_verdict([](double t) { return std::max(0.0, 3.0 - 10.0 * t); })));
}

TEST(SwingWatch, SaysNothingOfABumpOfATenthOfASecond) {
  EXPECT_TRUE(std::isnan(first_verdict([](double t) { return t >= 1.6 && t < 1.7 ? 5.0 : 3.0; })));
}

TEST(SwingWatch, SaysNothingOfASwingBelowHalfANewton) {
  EXPECT_TRUE(std::isnan(first_verdict([](double t) { return sine(t, 0.24, 10.0); })));
}

// A period of 10 Hz holds a rise and a fall of 4 N: the swing has begun within the first one.
TEST(SwingWatch, SaysSinceWhenAForceOscillates) {
  const double since = first_verdict([](double t) { return t < 1.0 ? 3.0 : sine(t - 1.0, 2.0, 10.0); });
  EXPECT_GT(since, 1.0);
  EXPECT_LT(since, 1.1);
}

// Up by 0.9 N in 20 ms and down again in 20 ms, over and over: down by 0.675 N after 35 ms, the first step
// beyond 0.5 N.
TEST(SwingWatch, BeginsWithTheFirstRiseAndFallBeyondTheSwing) {
  const double since = first_verdict([](double t) {
    if (t < 1.0 - 1e-9) return 3.0;
    const double phase = std::fmod(t - 1.0 + 1e-9, 0.04) / 0.02;
    return 3.0 + 0.9 * (phase < 1.0 ? phase : 2.0 - phase);
  });
  EXPECT_NEAR(since, 1.035, 1e-9);
}

TEST(SwingWatch, WaitsUntilTheSwingHasLastedAFifthOfASecond) {
  // Ten cycles a second for as long as stated, then rest.
  const auto lasting = [](double seconds) {
    return [seconds](double t) { return t < 1.0 || t > 1.0 + seconds ? 3.0 : sine(t - 1.0, 2.0, 10.0); };
  };
  EXPECT_TRUE(std::isnan(first_verdict(lasting(0.1))));
  EXPECT_FALSE(std::isnan(first_verdict(lasting(0.5))));
}

}  // namespace
}  // namespace phalanx
