// SPDX-License-Identifier: Apache-2.0
// Waiting for a file descriptor, with a resolution finer than 1 ms.
#pragma once

#include <poll.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace phalanx {

/// Waits at most `seconds` of real time for `events` (POLLIN, POLLOUT) of `descriptor`; a negative descriptor
/// only lets the time pass.
/// @returns the events that have come, errors among them; 0: none, or a signal.
inline short wait_for(int descriptor, short events, double seconds) noexcept {
  const double bounded = std::isfinite(seconds) ? std::clamp(seconds, 0.0, 3600.0) : 0.0;
  // Rounded up: a wait of less than 1 ns would end at once and be repeated without end.
  const auto ns = static_cast<std::int64_t>(std::ceil(bounded * 1e9));
  const timespec time{.tv_sec = ns / 1'000'000'000, .tv_nsec = ns % 1'000'000'000};
  pollfd poll_for{.fd = descriptor, .events = events, .revents = 0};
  return ::ppoll(&poll_for, 1, &time, nullptr) > 0 ? poll_for.revents : short{0};
}

}  // namespace phalanx
