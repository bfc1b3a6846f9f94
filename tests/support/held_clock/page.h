// SPDX-License-Identifier: Apache-2.0
// What the programs under a held clock and the one that holds it share: the time, and who waits until when.
#pragma once

#include <linux/futex.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <climits>
#include <csignal>
#include <cstdint>

namespace phalanx::test {

/// Environment variable that names the page's file to a program.
inline constexpr const char* kClockVariable = "PHALANX_HELD_CLOCK";

enum class WaitKind : std::uint32_t {
  kNone,   ///< the thread does not wait for a time
  kSleep,  ///< on `woken`, for nothing else
  kPoll,   ///< in ppoll() or epoll_pwait(): a descriptor may end it; wake_signal() makes it look at the time
  kNap,    ///< on a condition variable: it looks at the time again and again
};

/// One thread's wait.
struct ClockWait {
  std::atomic<std::int32_t> tid{0};  ///< 0: free
  std::atomic<std::int32_t> pid{0};
  std::atomic<WaitKind> kind{WaitKind::kNone};
  std::atomic<std::int64_t> deadline{0};  ///< [ns]
  std::atomic<std::uint32_t> woken{0};    ///< futex: set to 1 once the deadline has come
  std::atomic<bool> terminal{false};      ///< one of the descriptors of a kPoll is a terminal

  void give_back() noexcept {
    kind.store(WaitKind::kNone);
    pid.store(0);  // who takes it next has no process until it says so, rather than one that may have ended
    tid.store(0);
  }
};

inline constexpr std::int64_t kNever = INT64_MAX;  ///< the deadline of a wait that time does not end

struct ClockPage {
  static constexpr std::int64_t kBegin = 1'000'000'000'000;  ///< [ns]; times before the start stay positive

  std::atomic<std::int64_t> now{kBegin};    ///< CLOCK_MONOTONIC of all programs under this clock [ns]
  std::atomic<std::uint32_t> changes{1};    ///< of threads and processes: another list is to be read
  std::atomic<std::uint32_t> waits{0};      ///< that have begun so far
  std::atomic<std::int64_t> loop_delay{0};  ///< a station's loop wakes up so much later than it asks [ns]
  std::atomic<std::int32_t> forking{0};     ///< children that have not entered themselves yet
  std::array<std::atomic<std::int32_t>, 64> process{};  ///< ids; 0: free
  std::array<ClockWait, 512> wait{};
};

/// Makes a thread in WaitKind::kPoll look at the time and at its descriptors again; blocked outside of it.
inline int wake_signal() noexcept { return SIGRTMAX - 3; }

inline long futex(std::atomic<std::uint32_t>* word, int what, std::uint32_t value) noexcept {
  return ::syscall(SYS_futex, word, what, value, nullptr, nullptr, 0);
}

/// Where it is allowed, the calling thread runs as soon as it wakes up, whatever else a busy computer does:
/// under a held clock threads wake up some hundred thousand times a test. Elsewhere the same test takes
/// longer. Threads and processes that the caller starts inherit it, and keep it when they give way: they all
/// precede ordinary processes, other tests among them.
inline void ask_for_the_processor(int priority) noexcept {
  const sched_param wanted{priority};
  ::syscall(SYS_sched_setscheduler, 0, SCHED_RR, &wanted);
}

/// Enters a process; a second time does nothing.
inline void enter_process(ClockPage& page, std::int32_t pid) noexcept {
  for (auto& place : page.process)
    if (place.load() == pid) return;
  for (auto& place : page.process) {
    std::int32_t free = 0;
    if (place.compare_exchange_strong(free, pid)) break;
  }
  page.changes.fetch_add(1);
}

}  // namespace phalanx::test
