// SPDX-License-Identifier: Apache-2.0
// The arithmetic is tested without sleeping; with the real clock only what holds on the slowest machine.
#include "phalanx/station/pacer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <limits>
#include <random>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "phalanx/device/latest.h"
#include "phalanx/station/deadline_statistics.h"
#include "support/count_allocations.h"

namespace phalanx {
namespace {

// Deadlines at 10.5, 11, 11.5, ...: binary fractions, so that "exactly on it" can be said.
constexpr DeadlineGrid kGrid{.begin = 10.0, .period = 0.5};

TEST(DeadlineGrid, GivesOneAfterTheOtherToALoopThatIsInTime) {
  EXPECT_EQ(kGrid.at(1), 10.5);
  EXPECT_EQ(kGrid.next(0, 10.0), 1U);
  EXPECT_EQ(kGrid.next(1, 10.6), 2U);
  EXPECT_EQ(kGrid.next(2, 11.49), 3U);
}

TEST(DeadlineGrid, CountsADeadlineThatIsMetExactlyAsMet) {
  EXPECT_EQ(kGrid.next(1, 11.0), 2U);
  EXPECT_EQ(kGrid.next(1, 11.25), 3U);
  EXPECT_EQ(kGrid.next(1, 11.5), 3U);
}

// The loop that began at 10.5 ends at 12.7: 11, 11.5, 12 and 12.5 have passed, and 13 is next.
TEST(DeadlineGrid, LeavesOutWhatWasMissedAndStaysWhereItWas) {
  EXPECT_EQ(kGrid.next(1, 12.7), 6U);
  EXPECT_EQ(kGrid.at(6), 13.0);
}

TEST(DeadlineGrid, NeverGoesBackEvenIfTheClockDoes) {
  EXPECT_EQ(kGrid.next(7, 3.0), 8U);
  EXPECT_EQ(kGrid.next(7, -1e9), 8U);
}

// Against its definition, with periods that no double holds exactly, up to 30 hours after the beginning.
TEST(DeadlineGrid, IsTheFirstDeadlineThatHasNotPassed) {
  constexpr unsigned kSeed = 8;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (int i = 0; i < 100000; ++i) {
    const DeadlineGrid grid{.begin = 10.0 * any(random),
                            .period = 1.0 / std::ceil(200.0 + 1800.0 * any(random))};
    const auto last = static_cast<std::uint64_t>(2e8 * any(random));
    // Every other time right on a deadline, where rounding decides.
    const double periods = 50.0 * any(random);
    const double now = grid.at(last + static_cast<std::uint64_t>(periods)) +
                       (i % 2 == 0 ? 0.0 : (periods - std::floor(periods)) * grid.period);
    const std::uint64_t k = grid.next(last, now);
    ASSERT_GT(k, last);
    ASSERT_GE(grid.at(k), now);
    ASSERT_TRUE(k == last + 1 || grid.at(k - 1) < now) << k - last;
  }
}

TEST(Pacer, RefusesAPeriodThatIsNone) {
  const Clock clock;
  for (const double period :
       {0.0, -0.001, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(Pacer(clock, period), std::invalid_argument) << period;
}

TEST(Pacer, BeginsOnePeriodAfterItWasMade) {
  const Clock clock;
  const double before = clock.now();
  Pacer pacer(clock, 0.02);
  const double after = clock.now();
  EXPECT_GE(pacer.grid().begin, before);
  EXPECT_LE(pacer.grid().begin, after);
  EXPECT_EQ(pacer.grid().at(1), pacer.grid().begin + 0.02);
}

// On a busy machine a wake may be late and a deadline be skipped; never is one early or off the grid.
TEST(Pacer, WakesOnTheGridAndNeverBeforeADeadline) {
  const Clock clock;
  Pacer pacer(clock, 0.001);
  std::uint64_t k = 0;
  for (int i = 0; i < 100; ++i) {
    const double before = clock.now();
    const Wake wake = pacer.wait();
    k += 1 + wake.skipped;
    ASSERT_EQ(wake.deadline, pacer.grid().at(k));
    ASSERT_GE(wake.now, wake.deadline);
    ASSERT_EQ(wake.lateness, wake.now - wake.deadline);
    ASSERT_LE(wake.now, clock.now() + 1e-9);
    ASSERT_GE(wake.deadline, before);
  }
}

TEST(Pacer, SkipsWhatAnOverrunMissedInsteadOfMakingItUp) {
  const Clock clock;
  Pacer pacer(clock, 0.005);
  const Wake first = pacer.wait();
  const double busy_until = first.deadline + 3.5 * 0.005;
  while (!clock.sleep_until(busy_until)) {
  }
  const Wake second = pacer.wait();
  EXPECT_GE(second.skipped, 3U);
  EXPECT_GE(second.deadline, busy_until);
  EXPECT_NEAR(second.deadline - first.deadline, 0.005 * static_cast<double>(second.skipped + 1), 1e-12);
}

std::atomic<int> signals{0};
void count_signal(int) { signals.fetch_add(1, std::memory_order_relaxed); }

// A signal comes every millisecond while the pacer waits for 50.
TEST(Pacer, IsNotWokenBySignals) {
  struct sigaction action{};
  struct sigaction before{};
  action.sa_handler = count_signal;
  ASSERT_EQ(sigaction(SIGALRM, &action, &before), 0);
  const Clock clock;
  Pacer pacer(clock, 0.05);
  std::thread sender([&clock, pacing = pthread_self()] {
    for (int i = 1; i <= 40; ++i) {
      clock.sleep_until(1e-3 * i);
      pthread_kill(pacing, SIGALRM);
    }
  });
  const Wake wake = pacer.wait();
  sender.join();
  sigaction(SIGALRM, &before, nullptr);
  EXPECT_GE(signals.load(), 2) << "two that come before the thread has seen the first are one";
  EXPECT_GE(wake.now, wake.deadline);
  EXPECT_GE(clock.now(), wake.deadline);
}

TEST(Pacer, AllocatesNothing) {
  const Clock clock;
  Pacer pacer(clock, 0.001);
  DeadlineStatistics statistics{.period = 0.001};
  const std::size_t before = test::allocations_of_this_thread();
  for (int i = 0; i < 5; ++i) {
    const Wake wake = pacer.wait();
    statistics.add(wake, clock.now());
  }
  EXPECT_EQ(test::allocations_of_this_thread(), before);
  EXPECT_EQ(statistics.steps, 5U);
}

// The reader sees each of the writer's states whole: what was added together is there together.
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
static_assert(noexcept(std::declval<Pacer&>().wait()));

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
