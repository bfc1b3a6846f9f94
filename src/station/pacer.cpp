// SPDX-License-Identifier: Apache-2.0
#include "station/pacer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace phalanx {

std::uint64_t DeadlineGrid::next(std::uint64_t last, double now) const noexcept {
  if (now <= at(last + 1)) return last + 1;
  auto k = static_cast<std::uint64_t>((now - begin) / period);
  // The division rounds. at() decides, so that a deadline that is met exactly counts as met.
  while (at(k) < now) ++k;
  while (k > last + 1 && at(k - 1) >= now) --k;
  return k;
}

Pacer::Pacer(const Clock& clock, double period)
    : clock_(clock), grid_{.begin = clock.now(), .period = period} {
  if (std::isfinite(period) && period > 0.0) return;
  throw std::invalid_argument(
      fmt::format("pacer: a period of {} s; give one above 0, such as 0.001 for 1 kHz", period));
}

Wake Pacer::wait() noexcept {
  const std::uint64_t k = grid_.next(last_, clock_.now());
  const double deadline = grid_.at(k);
  while (!clock_.sleep_until(deadline) && clock_.now() < deadline) {
  }
  // The kernel counts whole nanoseconds: it may return a fraction of one before the deadline.
  const double now = std::max(clock_.now(), deadline);
  const Wake wake{.deadline = deadline, .now = now, .lateness = now - deadline, .skipped = k - last_ - 1};
  last_ = k;
  return wake;
}

}  // namespace phalanx
