// SPDX-License-Identifier: Apache-2.0
// The clock of a process: monotonic, in seconds since its construction, optionally slower than real time.
#pragma once

#include <time.h>

#include <cstdint>

namespace phalanx {

/// CLOCK_MONOTONIC since construction, divided by `slowdown`. With a slowdown of 10, everything that this
/// clock paces runs ten times slower, time limits included. It serves close observation, and tests on busy
/// machines. Real-time: now() does not enter the kernel; sleep_until() waits.
class Clock {
 public:
  explicit Clock(double slowdown = 1.0) noexcept : slowdown_(slowdown) {
    clock_gettime(CLOCK_MONOTONIC, &begin_);
  }

  /// @returns the time since construction [s].
  [[nodiscard]] double now() const noexcept {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (static_cast<double>(t.tv_sec - begin_.tv_sec) +
            1e-9 * static_cast<double>(t.tv_nsec - begin_.tv_nsec)) /
           slowdown_;
  }
  [[nodiscard]] std::uint64_t now_us() const noexcept { return static_cast<std::uint64_t>(now() * 1e6); }

  /// Sleeps until the clock reads `t` [s]. The time is absolute, so that errors do not add up. It returns
  /// early only if a signal arrives. @returns true if it slept to the end
  bool sleep_until(double t) const noexcept {
    const double real = t * slowdown_;
    timespec until = begin_;
    const auto seconds = static_cast<time_t>(real);
    until.tv_sec += seconds;
    until.tv_nsec += static_cast<long>((real - static_cast<double>(seconds)) * 1e9);
    if (until.tv_nsec >= 1000000000L) {
      until.tv_nsec -= 1000000000L;
      ++until.tv_sec;
    }
    return clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == 0;
  }

  [[nodiscard]] double slowdown() const noexcept { return slowdown_; }

 private:
  double slowdown_;
  timespec begin_{};
};

}  // namespace phalanx
