// SPDX-License-Identifier: Apache-2.0
#include "phalanx/force/oscillation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "phalanx/force/stabiliser_methods.h"

namespace phalanx {
namespace {

constexpr double kSwing = 0.5;

/// Force [N] over time [s].
using Signal = std::function<double(double)>;

/// When it fires [s]; below 0 if it does not within `seconds`.
double fires_at(const Signal& signal, double seconds, double rate_hz = 200.0) {
  OscillationObserver observer;
  const int ticks = static_cast<int>(seconds * rate_hz);
  for (int n = 0; n <= ticks; ++n) {
    observer.watch(std::max(0.0, signal(n / rate_hz)), kSwing, 1.0 / rate_hz);
    if (observer.oscillating()) return n / rate_hz;
  }
  return -1.0;
}

double sine(double hz, double t) { return std::sin(2.0 * std::numbers::pi * hz * t); }

/// The same through S2's smoothing of +-20 N/s.
Signal smoothed(const Signal& signal) {
  return [signal, force = 0.0](double t) mutable {
    return force = smoothed_force(signal(t), force, -20.0, 20.0, 0.005);
  };
}

/// 0 before `from`, 1 after `to`, a straight line between.
double ramp(double t, double from, double to) { return std::clamp((t - from) / (to - from), 0.0, 1.0); }

// 3 N held, and 1 N of swing about it: seen within 200 ms from 8 Hz, within five half-swings and one more
// below. The press itself is one reversal at its beginning, long before.
TEST(Oscillation, FiresOnASteadySineOfEveryFrequency) {
  for (const double hz : {3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0, 13.0, 17.0, 20.0, 25.0, 30.0}) {
    for (const double amplitude : {0.3, 0.5, 1.0, 2.5}) {
      const double fired = fires_at(
          [&](double t) { return t < 1.0 ? 3.0 * ramp(t, 0.0, 0.1) : 3.0 + amplitude * sine(hz, t - 1.0); },
          4.0);
      ASSERT_GT(fired, 1.0) << hz << " Hz, " << amplitude << " N";
      // After the first swing of more than 0.5 N, at the latest the first half-swing after the first quarter:
      const double full = 0.75 / hz;
      EXPECT_LT(fired - 1.0, full + (hz >= 8.0 ? 0.2 : 3.0 / hz + 0.01))
          << hz << " Hz, " << amplitude << " N";
    }
  }
}

/// When the swing between two neighbouring extremes, or between the last extreme and now, first exceeds 0.5
/// N.
double first_swing(const Signal& signal, double from, double seconds) {
  double low = signal(from);
  double high = low;
  double last = low;
  bool rising = true;
  for (double t = from; t < seconds; t += 0.005) {
    const double now = signal(t);
    if (rising != (now > last)) {
      (rising ? high : low) = last;
      rising = !rising;
    }
    (rising ? high : low) = now;
    if (high - low > kSwing) return t;
    last = now;
  }
  return seconds;
}

// What an unstable loop does: it grows. Within 200 ms of the first swing of 0.5 N, from 8 Hz up to 30 Hz, in
// the time in which it grows e-fold given.
TEST(Oscillation, FiresWithin200MillisecondsOfAGrowingSwing) {
  for (const double hz : {8.0, 9.0, 10.0, 12.0, 15.0, 20.0, 30.0}) {
    for (const double growth : {0.05, 0.1, 0.3, 1.0}) {
      const Signal signal = [&](double t) {
        return t < 1.0 ? 3.0 * ramp(t, 0.0, 0.1)
                       : std::max(0.0, 3.0 + std::min(2.0, 0.05 * std::exp((t - 1.0) / growth)) *
                                                 sine(hz, t - 1.0));
      };
      const double fired = fires_at(signal, 10.0);
      const double first = first_swing(signal, 1.0, 10.0);
      ASSERT_GT(fired, 0.0) << hz << " Hz, " << growth << " s";
      EXPECT_GE(fired, first);
      EXPECT_LE(fired - first, 0.2 + 1e-9) << hz << " Hz, " << growth << " s";
    }
  }
}

TEST(Oscillation, StaysSilentBelowItsSwing) {
  for (const double hz : {3.0, 8.0, 12.0, 30.0}) {
    EXPECT_LT(fires_at([&](double t) { return 3.0 * ramp(t, 0, 0.1) + 0.24 * sine(hz, t); }, 5.0), 0.0) << hz;
  }
}

TEST(Oscillation, StaysSilentOnPressHoldAndRelease) {
  for (const double rise : {0.005, 0.03, 0.1, 0.5, 2.0}) {
    for (const double hold : {0.0, 0.05, 0.2, 1.0, 3.0}) {
      const double end = 0.5 + rise + hold;
      EXPECT_LT(
          fires_at([&](double t) { return 4.0 * (ramp(t, 0.5, 0.5 + rise) - ramp(t, end, end + rise)); },
                   end + 3.0),
          0.0)
          << rise << " s, " << hold << " s";
    }
  }
}

TEST(Oscillation, StaysSilentOnAStaircase) {
  EXPECT_LT(fires_at(
                [](double t) {
                  const double n = std::floor(t / 0.1);
                  return n <= 10.0 ? 0.7 * n : std::max(0.0, 7.0 - 0.7 * (n - 10.0));
                },
                4.0),
            0.0);
}

// The page's bump: 2 N for 100 ms on a press of 3 N, through the smoothing and without it; and a press that
// overshoots by 40 % and then by 0.4 of that each half-swing: 1.2, 0.48, 0.19 N about its end.
TEST(Oscillation, StaysSilentOnABumpAndOnAnOvershoot) {
  const Signal bump = [](double t) { return 3.0 * ramp(t, 0.5, 0.6) + (t >= 1.6 && t < 1.7 ? 2.0 : 0.0); };
  EXPECT_LT(fires_at(smoothed(bump), 4.0), 0.0);
  EXPECT_LT(fires_at(bump, 4.0), 0.0);
  const Signal overshoot = [](double t) {
    if (t < 0.5) return 0.0;
    const double half_swings = (t - 0.5) / 0.05;
    return 3.0 - 3.0 * std::pow(0.4, half_swings) * std::cos(std::numbers::pi * half_swings);
  };
  EXPECT_LT(fires_at(overshoot, 4.0), 0.0);
  EXPECT_LT(fires_at([&](double t) { return overshoot(t) + (t >= 1.6 && t < 1.7 ? 2.0 : 0.0); }, 4.0), 0.0);
}

// Two taps of 2 N in 600 ms: four reversals, but slow ones. Six such taps a second apart of each other: never
// six in a row.
TEST(Oscillation, StaysSilentOnADoubleTap) {
  const auto tap = [](double t, double at) {
    return 2.0 * (ramp(t, at, at + 0.1) - ramp(t, at + 0.15, at + 0.25));
  };
  EXPECT_LT(fires_at(
                [&](double t) {
                  double force = 0.0;
                  for (int n = 0; n < 6; ++n) force += tap(t, 1.3 * n + 0.5) + tap(t, 1.3 * n + 0.85);
                  return force;
                },
                9.0),
            0.0);
}

// 30 um of 5-12 Hz tremor into 0.9 N/mm is 0.027 N; 10 um rms of noise is 0.009 N, and the sensor's 25 um
// step 0.02 N.
TEST(Oscillation, StaysSilentOnTremorAndNoise) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 10e-6);
  for (const double hz : {5.0, 8.0, 12.0}) {
    EXPECT_LT(fires_at(
                  [&](double t) {
                    const double x = 3.3e-3 * ramp(t, 0.5, 0.6) + 30e-6 * sine(hz, t) + noise(random);
                    return 900.0 * 25e-6 * std::round(x / 25e-6);
                  },
                  6.0),
              0.0)
        << "seed 7, " << hz << " Hz";
  }
}

// 200 random rows of presses at the pace of a hand: each 0.15 to 1 s long, 0.3 to 1 s apart.
TEST(Oscillation, StaysSilentOnRandomPresses) {
  std::mt19937_64 random(2026);
  const auto between = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  for (int run = 0; run < 200; ++run) {
    struct Press {
      double from, to, rise, force;
    };
    std::vector<Press> presses;
    for (double t = 0.2; t < 10.0;) {
      const double length = between(0.15, 1.0);
      presses.push_back({t, t + length, between(0.02, 0.15), between(0.5, 5.0)});
      t += length + between(0.3, 1.0);
    }
    const Signal signal = [&](double t) {
      double force = 0.0;
      for (const Press& p : presses)
        force += p.force * (ramp(t, p.from, p.from + p.rise) - ramp(t, p.to, p.to + p.rise));
      return force;
    };
    ASSERT_LT(fires_at(run % 2 == 0 ? signal : smoothed(signal), 10.0), 0.0) << "seed 2026 run " << run;
  }
}

// 10 Hz, 2 N from peak to peak; then held. Measured at 1 kHz so that the extremes are hit.
TEST(Oscillation, SaysFrequencyAndSwingAndClearsAfterHalfASecond) {
  OscillationObserver observer;
  for (int n = 0; n <= 2000; ++n) observer.watch(3.0 + sine(10.0, 1e-3 * n), kSwing, 1e-3);
  ASSERT_TRUE(observer.oscillating());
  EXPECT_NEAR(observer.frequency(), 10.0, 0.05);
  EXPECT_NEAR(observer.swing(), 2.0, 1e-6);
  int held = 0;
  while (observer.oscillating() && held < 5000) {
    observer.watch(3.0, kSwing, 1e-3);
    ++held;
  }
  // The last reversal was within a half-swing before the hold began.
  EXPECT_GT(held, 440);
  EXPECT_LE(held, 502);
  EXPECT_EQ(observer.frequency(), 0.0);
  EXPECT_EQ(observer.swing(), 0.0);
}

TEST(Oscillation, HasNothingToRememberAfterTheForceIsGone) {
  OscillationObserver observer;
  EXPECT_TRUE(observer.idle());
  for (int n = 0; n < 200; ++n) observer.watch(3.0 + 2.0 * sine(10.0, 0.005 * n), kSwing, 0.005);
  EXPECT_FALSE(observer.idle());
  for (int n = 0; n < 200; ++n) observer.watch(0.0, kSwing, 0.005);
  EXPECT_TRUE(observer.idle());
}

TEST(Oscillation, IsFiniteWhateverArrives) {
  std::mt19937_64 random(5);
  const std::vector<double> wild = {0.0,
                                    std::numeric_limits<double>::quiet_NaN(),
                                    std::numeric_limits<double>::infinity(),
                                    1e300,
                                    -1e300,
                                    2.0,
                                    1e-310};
  OscillationObserver observer;
  int oscillated = 0;
  for (int n = 0; n < 20000; ++n) {
    observer.watch(wild[random() % wild.size()], kSwing, 0.005);
    ASSERT_TRUE(std::isfinite(observer.frequency()) && std::isfinite(observer.swing()))
        << "seed 5 step " << n;
    oscillated += observer.oscillating() ? 1 : 0;
  }
  EXPECT_GT(oscillated, 1000);
}

// Halved once, over 200 ms: 40 steps of 0.0125. Not again within 500 ms although it still swings; then to
// 0.25.
TEST(StiffnessFactor, IsHalvedOverARampAndAtMostEveryHalfSecond) {
  StiffnessFactor factor;
  factor.advance(false, 0.005);
  EXPECT_EQ(factor.value(), 1.0);
  for (int n = 1; n <= 100; ++n) {
    factor.advance(true, 0.005);
    EXPECT_NEAR(factor.value(), n <= 40 ? 1.0 - 0.0125 * n : 0.5, 1e-12);
  }
  for (int n = 0; n < 50; ++n) factor.advance(true, 0.005);
  EXPECT_NEAR(factor.value(), 0.25, 1e-12);
  for (int n = 0; n < 1000; ++n) factor.advance(false, 0.005);
  EXPECT_EQ(factor.value(), 0.25) << "it stays";
  for (int n = 0; n < 5000; ++n) factor.advance(true, 0.005);
  EXPECT_EQ(factor.value(), 1.0 / 1024.0) << "and has an end";
}

}  // namespace
}  // namespace phalanx
