// SPDX-License-Identifier: Apache-2.0
// The arithmetic is tested without sleeping; with the real clock only what holds on the slowest machine.
#include "station/pacer.h"

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
#include <utility>

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

// A signal comes every millisecond while the pacer waits for 50. The next one is sent when it has been handled.
TEST(Pacer, IsNotWokenBySignals) {
  struct sigaction action{};
  struct sigaction before{};
  action.sa_handler = count_signal;
  signals = 0;
  ASSERT_EQ(sigaction(SIGALRM, &action, &before), 0);
  const Clock clock;
  Pacer pacer(clock, 0.05);
  std::thread sender([&clock, pacing = pthread_self()] {
    for (int i = 1; i <= 40; ++i) {
      clock.sleep_until(1e-3 * i);
      pthread_kill(pacing, SIGALRM);
      while (signals.load() < i) std::this_thread::yield();
    }
  });
  const Wake wake = pacer.wait();
  sender.join();
  sigaction(SIGALRM, &before, nullptr);
  EXPECT_EQ(signals.load(), 40);
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

static_assert(noexcept(std::declval<Pacer&>().wait()));

}  // namespace
}  // namespace phalanx
