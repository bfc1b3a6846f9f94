// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/deadline_statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include "phalanx/core/latest.h"
#include "station/pacer.h"
#include "support/count_allocations.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;

// Readers get it by assignment between threads.
static_assert(std::is_trivially_copyable_v<Histogram>);
static_assert(sizeof(Histogram) < 4096);

TEST(Histogram, IsEmptyAtFirst) {
  const Histogram h;
  EXPECT_EQ(h.count(), 0U);
  EXPECT_EQ(h.max_us(), 0.0);
  EXPECT_EQ(h.percentile_us(50.0), 0.0);
  EXPECT_EQ(histogram_text(h, "steps"), "steps: nothing measured\n");
}

// 0.1 us 2^3 = 0.8 us opens octave 3; its bins are 0.05 us wide, so that 0.82 us lies in [0.80, 0.85).
TEST(Histogram, PutsADurationIntoTheBinWorkedOutByHand) {
  Histogram h;
  h.add(0.82e-6);
  h.add(1e-3);
  EXPECT_EQ(h.in_octave(3), 1U);
  EXPECT_NEAR(h.percentile_us(50.0), 0.825, 1e-9);
  // 1000 us / 0.1 us = 10,000 = 2^13 1.2207.
  EXPECT_EQ(h.in_octave(13), 1U);
  EXPECT_DOUBLE_EQ(h.percentile_us(100.0), 1000.0);
}

// The edges of bin 5 of octave 10: 0.1 us 2^10 (1 + 5/16) = 134.4 us and 0.1 us 2^10 (1 + 6/16) = 140.8 us.
TEST(Histogram, HasTheSameWidthForAllBinsOfAnOctave) {
  for (const double us : {134.41, 137.0, 140.79}) {
    Histogram h;
    h.add(us * 1e-6);
    h.add(1.0);
    EXPECT_NEAR(h.percentile_us(50.0), 137.6, 1e-9) << us;
  }
}

// Of 1 .. 100 ms the nearest rank of 90 % is the 90th: 90 ms, to within 1/32.
TEST(Histogram, GivesTheNearestRank) {
  Histogram h;
  for (int ms = 100; ms >= 1; --ms) h.add(1e-3 * ms);
  EXPECT_NEAR(h.percentile_us(0.0), 1e3, 1e3 / 32.0);
  EXPECT_NEAR(h.percentile_us(1.0), 1e3, 1e3 / 32.0);
  EXPECT_NEAR(h.percentile_us(50.0), 50e3, 50e3 / 32.0);
  EXPECT_NEAR(h.percentile_us(90.0), 90e3, 90e3 / 32.0);
  EXPECT_DOUBLE_EQ(h.percentile_us(100.0), 100e3);
}

TEST(Histogram, IsNeverFurtherOffThanOneIn32) {
  constexpr unsigned kSeed = 6;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> exponent(-7.0, 1.0);  // 0.1 us .. 10 s
  for (int i = 0; i < 20000; ++i) {
    const double duration = std::max(std::pow(10.0, exponent(random)), 1.0000001e-7);
    Histogram h;
    h.add(duration);
    h.add(13.0);  // so that the maximum does not correct the first
    const double us = 1e6 * duration;
    ASSERT_NEAR(h.percentile_us(50.0), us, us / 32.0 * (1.0 + 1e-9));
  }
}

TEST(Histogram, AgreesWithSortingOnManyDurations) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  std::lognormal_distribution<double> draw(-9.0, 1.5);
  std::vector<double> all(9999);
  Histogram h;
  for (double& d : all) h.add(d = draw(random));
  std::sort(all.begin(), all.end());
  for (const double percent : {1.0, 10.0, 50.0, 90.0, 99.0, 99.9}) {
    const auto rank = static_cast<std::size_t>(std::ceil(percent * 9999.0 / 100.0));
    const double exact = 1e6 * all[rank - 1];
    EXPECT_NEAR(h.percentile_us(percent), exact, exact / 32.0) << percent << " %";
  }
  EXPECT_DOUBLE_EQ(h.max_us(), 1e6 * all.back());
}

TEST(Histogram, TakesWhateverComes) {
  Histogram h;
  h.add(0.0);
  h.add(-1.0);
  h.add(5e-8);
  h.add(std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(h.below_range(), 4U);
  EXPECT_DOUBLE_EQ(h.percentile_us(50.0), 0.05);  // no more than the longest
  h.add(13.43);                                   // 0.1 us 2^27 is 13.42 s
  h.add(1e300);
  h.add(std::numeric_limits<double>::infinity());
  EXPECT_EQ(h.above_range(), 3U);
  h.add(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(h.count(), 7U);
}

TEST(Histogram, MergesAsIfAllHadBeenAddedToOne) {
  Histogram a;
  Histogram b;
  Histogram both;
  for (int i = 1; i <= 300; ++i) {
    Histogram& one = i % 3 == 1 ? a : b;
    one.add(7e-6 * i);
    both.add(7e-6 * i);
  }
  a.merge(b);
  EXPECT_EQ(a.count(), 300U);
  EXPECT_EQ(a.max_us(), both.max_us());
  for (std::size_t k = 0; k < Histogram::kOctaves; ++k) EXPECT_EQ(a.in_octave(k), both.in_octave(k)) << k;
  for (const double p : {0.0, 12.5, 50.0, 99.9}) EXPECT_EQ(a.percentile_us(p), both.percentile_us(p)) << p;
}

// Three in [3.2, 6.4) us, one in [6.4, 12.8) us: 75 % is 37.5 of 50 characters, and 38 are drawn.
TEST(Histogram, PrintsOneLineForEveryOctave) {
  Histogram h;
  for (const double us : {4.0, 5.0, 6.0, 12.0}) h.add(us * 1e-6);
  const std::string text = histogram_text(h, "jitter");
  EXPECT_THAT(text, HasSubstr("jitter: 4 measured"));
  EXPECT_THAT(text, HasSubstr("longest 12.0 us"));
  EXPECT_THAT(text, HasSubstr("3.2 .. 6.4 us          3   75.000 % " + std::string(38, '#') + "\n"));
  EXPECT_THAT(text, HasSubstr("6.4 .. 12.8 us          1   25.000 % " + std::string(13, '#') + "\n"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
}

// Of 2,000 durations the ranks 1,000, 1,980 and 1,998: 40.5 of the bin [40, 42) x 0.1 us, 202 of [200, 208)
// and 1,000 of [992, 1024), of which the middles are 4.1, 20.4 and 100.8 us. No percentile a per cent further
// on is the same.
TEST(Histogram, PrintsThreePercentilesAndTheLongest) {
  Histogram h;
  const auto add = [&h](int count, double us) {
    for (int i = 0; i < count; ++i) h.add(1e-6 * us);
  };
  add(1010, 4.05);
  add(980, 20.2);
  add(9, 100.0);
  add(1, 300.0);
  EXPECT_THAT(histogram_text(h, "steps"),
              HasSubstr("steps: 2000 measured; 50 % 4.1, 99 % 20.4, 99.9 % 100.8, longest 300.0 us\n"));
}

// One of four below 0.1 us and three above 13.4 s: 12.5 and 37.5 of 50 characters, 13 and 38 are drawn.
TEST(Histogram, PrintsWhatLiesOutsideItsRange) {
  Histogram h;
  h.add(5e-8);
  for (int i = 0; i < 3; ++i) h.add(20.0);
  const std::string text = histogram_text(h, "steps");
  EXPECT_THAT(text, HasSubstr("under 0.1 us          1   25.000 % " + std::string(13, '#') + "\n"));
  EXPECT_THAT(text, HasSubstr("longer us          3   75.000 % " + std::string(38, '#') + "\n"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
}

TEST(Histogram, AllocatesNothing) {
  Histogram a;
  Histogram b;
  const std::size_t before = test::allocations_of_this_thread();
  for (int i = 0; i < 1000; ++i) a.add(1e-6 * i);
  b.merge(a);
  const double median = b.percentile_us(50.0);
  EXPECT_EQ(test::allocations_of_this_thread(), before);
  EXPECT_GT(median, 0.0);
}

TEST(DeadlineStatistics, OfTwoLoopsAreThoseOfBothOneAfterTheOther) {
  DeadlineStatistics both{.period = 0.5};
  DeadlineStatistics later{.period = 0.25};
  for (const double end : {11.125, 11.25, 10.25})
    both.add({.deadline = 10.0, .now = 10.0, .lateness = 0.125, .skipped = 2}, end);
  for (const double end : {20.5, 20.125})
    later.add({.deadline = 20.0, .now = 20.0, .lateness = 0.5, .skipped = 1}, end);
  both.append(later);
  EXPECT_EQ(both.period, 0.25);
  EXPECT_EQ(both.steps, 5U);
  EXPECT_EQ(both.overruns, 3U);
  EXPECT_EQ(both.longest_run, 2U);
  EXPECT_EQ(both.overruns_in_row, 0U);
  EXPECT_EQ(both.skipped, 8U);
  EXPECT_EQ(both.last_overrun, 20.5);
  EXPECT_EQ(both.lateness.count(), 5U);
  EXPECT_EQ(both.lateness.max_us(), 0.5e6);
  EXPECT_EQ(both.step.count(), 5U);
  both.append({.period = 0.125});
  EXPECT_EQ(both.last_overrun, 20.5) << "a loop that was always in time has none";
}

// The reader sees each of the writer's states whole: what was added together is there together.
TEST(DeadlineStatistics, AreCarriedToAReaderWhole) {
  Latest<DeadlineStatistics> latest;
  constexpr std::uint64_t kSteps = 5000;
  std::thread writer([&latest] {
    DeadlineStatistics s{.period = 0.5};
    for (std::uint64_t i = 0; i < kSteps; ++i) {
      const auto t = static_cast<double>(i);
      s.add({.deadline = t, .now = t, .lateness = 0.0, .skipped = 1}, t + 0.75);
      latest.write(s);
    }
  });
  std::uint64_t seen = 0;
  while (seen < kSteps) {
    if (!latest.update()) continue;
    const DeadlineStatistics& s = latest.value();
    EXPECT_GT(s.steps, seen);
    EXPECT_EQ(s.lateness.count(), s.steps);
    EXPECT_EQ(s.step.count(), s.steps);
    EXPECT_EQ(s.longest_run, s.steps);
    EXPECT_EQ(s.skipped, s.steps);
    seen = s.steps;
  }
  writer.join();
}

static_assert(std::is_trivially_copyable_v<DeadlineStatistics>);
static_assert(sizeof(DeadlineStatistics) < 16384);

/// A wake 1/64 s late for the deadline at t; the loop's period is 1/2 s.
Wake wake_at(double t) { return {.deadline = t, .now = t + 0.015625, .lateness = 0.015625, .skipped = 0}; }

TEST(DeadlineStatistics, CountsAStepThatEndsAfterTheNextDeadline) {
  DeadlineStatistics s{.period = 0.5};
  s.add(wake_at(1.0), 1.25);
  EXPECT_EQ(s.overruns, 0U);
  s.add(wake_at(1.5), 2.0);  // right on the next deadline: in time
  EXPECT_EQ(s.overruns, 0U);
  s.add(wake_at(2.0), 2.501);
  EXPECT_EQ(s.overruns, 1U);
  EXPECT_EQ(s.steps, 3U);
}

TEST(DeadlineStatistics, MeasuresTheWakeFromItsDeadlineAndTheStepFromTheWake) {
  DeadlineStatistics s{.period = 0.5};
  s.add(wake_at(1.0), 1.265625);  // 0.25 s after the wake
  EXPECT_DOUBLE_EQ(s.lateness.max_us(), 15625.0);
  EXPECT_DOUBLE_EQ(s.step.max_us(), 250000.0);
  EXPECT_EQ(s.lateness.count(), 1U);
  EXPECT_EQ(s.step.count(), 1U);
}

// late, late, in time, late, late, late, in time
TEST(DeadlineStatistics, RemembersTheLongestRunOfOverruns) {
  DeadlineStatistics s{.period = 0.5};
  const std::vector<bool> late = {true, true, false, true, true, true, false};
  const std::vector<std::uint64_t> in_row = {1, 2, 0, 1, 2, 3, 0};
  const std::vector<std::uint64_t> longest = {1, 2, 2, 2, 2, 3, 3};
  for (std::size_t i = 0; i < late.size(); ++i) {
    const double t = static_cast<double>(i);
    s.add(wake_at(t), t + (late[i] ? 0.75 : 0.25));
    EXPECT_EQ(s.overruns_in_row, in_row[i]) << i;
    EXPECT_EQ(s.longest_run, longest[i]) << i;
  }
  EXPECT_EQ(s.overruns, 5U);
}

TEST(DeadlineStatistics, IsDegradedForOneSecondAfterAnOverrun) {
  DeadlineStatistics s{.period = 0.5};
  EXPECT_FALSE(s.degraded(0.0));
  s.add(wake_at(1.0), 1.75);
  EXPECT_TRUE(s.degraded(1.75));
  s.add(wake_at(2.0), 2.25);  // in time again, but the second is not over
  EXPECT_TRUE(s.degraded(2.625));
  EXPECT_FALSE(s.degraded(2.75));
}

TEST(DeadlineStatistics, AddsUpWhatThePacerLeftOut) {
  DeadlineStatistics s{.period = 0.5};
  Wake wake = wake_at(3.0);
  wake.skipped = 4;
  s.add(wake, 3.25);
  s.add(wake_at(3.5), 3.75);
  EXPECT_EQ(s.skipped, 4U);
}

}  // namespace
}  // namespace phalanx
