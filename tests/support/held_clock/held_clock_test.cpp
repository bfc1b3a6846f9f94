// SPDX-License-Identifier: Apache-2.0
// The clock that this program is held by (HELD_CLOCK).
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "phalanx/core/index.h"
#include "support/held_clock/hold_this_process.h"

namespace phalanx::test {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

timespec real_time() {
  timespec t{};
  ::syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &t);
  return t;
}

TEST(HeldClock, StandsStillWhileAThreadComputes) {
  std::this_thread::sleep_for(milliseconds(1));
  const Clock::time_point before = Clock::now();
  std::thread sleeper([before] { std::this_thread::sleep_until(before + milliseconds(1)); });
  const timespec begin = real_time();
  while (real_time().tv_sec - begin.tv_sec < 2) {
  }
  EXPECT_EQ(Clock::now(), before);
  sleeper.join();
  EXPECT_EQ(Clock::now(), before + milliseconds(1));
}

TEST(HeldClock, PassesWhileAThreadOfANameIsMadeToWait) {
  const Clock::time_point begin = Clock::now();
  std::optional<ThreadsWait> waiting("named");
  std::atomic<bool> went_on{false};
  std::thread thread([&] {
    ::pthread_setname_np(::pthread_self(), "another");
    ::pthread_setname_np(::pthread_self(), "named");
    went_on = true;
  });
  while (!waiting->one_waits()) std::this_thread::sleep_for(milliseconds(1));
  std::this_thread::sleep_for(std::chrono::hours(1));
  EXPECT_GE(Clock::now(), begin + std::chrono::hours(1));
  EXPECT_FALSE(went_on);
  waiting.reset();
  thread.join();
  EXPECT_TRUE(went_on);
}

TEST(HeldClock, AThreadThatGivesWayKeepsItsPolicy) {
  const int policy = ::sched_getscheduler(0);
  const sched_param ordinary{};
  EXPECT_EQ(::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &ordinary), 0);
  EXPECT_EQ(::sched_getscheduler(0), policy);
  if (policy == SCHED_OTHER) GTEST_SKIP() << "real-time priority is not permitted here";
  EXPECT_EQ(policy, SCHED_RR);
}

TEST(HeldClock, MovesToEachDeadlineInTurnOnceAllThreadsSleep) {
  const Clock::time_point begin = Clock::now();
  Clock::time_point other{};
  std::thread sleeper([&] {
    std::this_thread::sleep_until(begin + milliseconds(500));
    other = Clock::now();
  });
  std::this_thread::sleep_until(begin + std::chrono::hours(1));
  EXPECT_EQ(Clock::now(), begin + std::chrono::hours(1));
  sleeper.join();
  EXPECT_EQ(other, begin + milliseconds(500));
}

TEST(HeldClock, APollEndsAtItsTimeLimitOrWithItsDescriptor) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  pollfd input{.fd = pipe[0], .events = POLLIN, .revents = 0};
  Clock::time_point begin = Clock::now();
  EXPECT_EQ(::poll(&input, 1, 250), 0);
  EXPECT_EQ(Clock::now(), begin + milliseconds(250));
  begin = Clock::now();
  std::thread writer([&] {
    std::this_thread::sleep_until(begin + milliseconds(100));
    EXPECT_EQ(::write(pipe[1], "x", 1), 1);
  });
  EXPECT_EQ(::poll(&input, 1, 250), 1);
  EXPECT_EQ(Clock::now(), begin + milliseconds(100));
  writer.join();
  ::close(pipe[0]);
  ::close(pipe[1]);
}

/// Children that sleep for as long as this lives, and that no clock knows.
class Children {
 public:
  explicit Children(int count) {
    const pid_t parent = ::getpid();
    for (int i = 0; i < count; ++i) {
      const auto child = static_cast<pid_t>(::syscall(SYS_clone, SIGCHLD, 0, 0, 0, 0));
      if (child == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        while (::getppid() == parent) ::pause();
        ::_exit(0);
      }
      if (child > 0) ids_.push_back(child);
    }
  }
  ~Children() {
    for (const pid_t child : ids_) ::kill(child, SIGKILL);
    for (const pid_t child : ids_) ::waitpid(child, nullptr, 0);
  }
  [[nodiscard]] std::size_t count() const { return ids_.size(); }
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;

 private:
  std::vector<pid_t> ids_;
};

// While waitpid() looks through the children, its thread has the state of one that sleeps.
TEST(HeldClock, AThreadThatLooksForEndedChildrenIsWaitedFor) {
  const Children children(50);
  ASSERT_EQ(children.count(), 50U);
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  const Clock::time_point begin = Clock::now();
  std::thread looker([&] {
    for (int i = 0; i < 200'000; ++i) EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), 0);
    EXPECT_EQ(::write(pipe[1], "x", 1), 1);
  });
  pollfd input{.fd = pipe[0], .events = POLLIN, .revents = 0};
  EXPECT_EQ(::poll(&input, 1, 1000), 1);
  EXPECT_EQ(Clock::now(), begin);
  looker.join();
  ::close(pipe[0]);
  ::close(pipe[1]);
}

// In both directions, and with a reader that has no time limit.
TEST(HeldClock, WhatIsWrittenToATerminalArrivesBeforeTimeGoesOn) {
  static constexpr int kBytes = 400;
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_TRUE(master >= 0 && ::grantpt(master) == 0 && ::unlockpt(master) == 0);
  std::array<char, 64> name{};
  ASSERT_EQ(::ptsname_r(master, name.data(), name.size()), 0);
  const int slave = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_GE(slave, 0);
  termios raw{};
  ASSERT_EQ(::tcgetattr(slave, &raw), 0);
  ::cfmakeraw(&raw);
  ASSERT_EQ(::tcsetattr(slave, TCSANOW, &raw), 0);
  for (const auto& [from, to] : {std::pair{master, slave}, std::pair{slave, master}}) {
    std::array<std::atomic<Clock::rep>, kBytes> written{};
    std::thread reader([&written, end = to] {
      int late = 0;
      for (int i = 0; i < kBytes; ++i) {
        pollfd input{.fd = end, .events = POLLIN, .revents = 0};
        ASSERT_EQ(::poll(&input, 1, i % 2 == 0 ? 60'000 : -1), 1);
        late += Clock::now().time_since_epoch().count() == written[idx(i)] ? 0 : 1;
        char byte = 0;
        ASSERT_EQ(::read(end, &byte, 1), 1);
      }
      EXPECT_EQ(late, 0) << "of " << kBytes << " bytes";
    });
    for (int i = 0; i < kBytes; ++i) {
      std::this_thread::sleep_for(milliseconds(1));
      written[idx(i)] = Clock::now().time_since_epoch().count();
      ASSERT_EQ(::write(from, "x", 1), 1);
    }
    reader.join();
  }
  ::close(master);
  ::close(slave);
}

}  // namespace
}  // namespace phalanx::test
