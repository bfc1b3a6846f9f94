// SPDX-License-Identifier: Apache-2.0
// A monotonic clock that a test holds: programs with threads, sockets and time limits run as if the computer
// were infinitely fast.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "support/held_clock/page.h"

namespace phalanx::test {

/// The time of all programs that attach to one ClockPage. It stands still while any of their threads runs,
/// and moves to the next moment that one of them waits for once all sleep in the kernel: nothing that they do
/// takes time, and a busy computer changes nothing. A thread that asks for the time a thousand times without
/// waiting makes it pass by 1 us each time. Processes that are stopped (SIGSTOP) are not waited for. A
/// thread that SIGKILL ends in its sleep counts as asleep: who kills a program waits for its end before time
/// goes on. What is written to a terminal arrives before time goes on if its reader waits in poll() and its
/// writer waits for a time afterwards. The holder needs the right to read /proc/PID/syscall of the programs,
/// as their ancestor or root has; without it, a thread that is preempted while it falls asleep may count as
/// asleep. One thread at a time.
class HeldClock {
 public:
  /// A page of its own, in memory. @throws std::runtime_error
  HeldClock();
  /// The page of a file, which is made if it is not there. @throws std::runtime_error
  explicit HeldClock(const std::string& file);
  ~HeldClock();
  HeldClock(const HeldClock&) = delete;
  HeldClock& operator=(const HeldClock&) = delete;

  /// "NAME=VALUE" for the environment of a program that is to be under this clock.
  /// @param library  path of libheld_clock.so
  [[nodiscard]] std::vector<std::string> environment(const std::string& library) const;
  [[nodiscard]] ClockPage& page() noexcept { return *page_; }

  /// Since the clock was made [s].
  [[nodiscard]] double now() const noexcept;
  /// Whether a program has attached to this clock.
  [[nodiscard]] bool holds(std::int32_t pid) const noexcept;
  /// A thread of this process whose work takes no time either, such as one that passes packets on.
  /// @param tid  as of gettid()
  void watch_thread(std::int32_t tid);
  /// A thread of this process that is not waited for, although the process is attached.
  void ignore_thread(std::int32_t tid);

  /// From here on the loops of stations wake up so much later than they ask, as on an overloaded computer.
  void delay_loop(double seconds) noexcept;

  /// Lets time pass until `t`, and what is due then be done. @throws std::runtime_error if a thread runs for
  /// two minutes
  void advance_to(double t);
  void advance(double seconds) { advance_to(now() + seconds); }
  /// Lets time pass for ever, until `ended`.
  /// @param pace  gives how many times as fast as real time at most, from then on; null or 0: as fast as it can
  void run(const std::function<bool()>& ended, const std::function<double()>& pace = nullptr);

 private:
  struct Threads;
  [[nodiscard]] std::optional<std::int64_t> next_wait();
  void move_to(std::int64_t t);
  void wake_due(std::int64_t now);
  [[nodiscard]] bool all_sleep();
  bool look_at_terminals();
  [[nodiscard]] bool look_again_before(std::int64_t t);

  int descriptor_ = -1;
  std::string file_;
  ClockPage* page_ = nullptr;
  std::unique_ptr<Threads> threads_;
  bool looked_again_ = false;     ///< since a thread was last seen at work, or time has moved
  std::uint32_t waits_seen_ = 0;  ///< ClockPage::waits at the last look_at_terminals()
};

}  // namespace phalanx::test
