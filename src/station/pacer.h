// SPDX-License-Identifier: Apache-2.0
// Deadlines of the loop's steps, and sleeping until the next one.
#pragma once

#include <cstdint>

#include "phalanx/device/clock.h"
#include "phalanx/station/deadline_statistics.h"

namespace phalanx {

/// The deadlines t_k = begin + k period, k = 1, 2, ...  Each is computed from k, not from the one before, so
/// that rounding errors do not add up. Real-time.
struct DeadlineGrid {
  double begin = 0.0;   ///< t_0 [s]
  double period = 1.0;  ///< time between two deadlines, > 0 [s]

  [[nodiscard]] double at(std::uint64_t k) const noexcept { return begin + static_cast<double>(k) * period; }
  /// @returns the first k > last with t_k >= now. Missed deadlines are left out; the grid does not move.
  [[nodiscard]] std::uint64_t next(std::uint64_t last, double now) const noexcept;
};

/// Pacer of a loop with absolute deadlines. A loop that overran does not catch up with several steps at once:
/// the hand would feel an old motion, replayed in a burst.
class Pacer {
 public:
  /// Begins the grid now; the first deadline is one period later.
  /// @param clock   outlives the pacer
  /// @param period  [s]  @throws std::invalid_argument unless positive and finite
  Pacer(const Clock& clock, double period);

  /// Sleeps until the next deadline that has not passed; a signal does not shorten it.
  /// Real-time: no allocation, lock or throw. Waiting is its purpose.
  Wake wait() noexcept;

  [[nodiscard]] double period() const noexcept { return grid_.period; }
  [[nodiscard]] const DeadlineGrid& grid() const noexcept { return grid_; }

 private:
  const Clock& clock_;
  DeadlineGrid grid_;
  std::uint64_t last_ = 0;  ///< k of the last deadline that was waited for
};

}  // namespace phalanx
