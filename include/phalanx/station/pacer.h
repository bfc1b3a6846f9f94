// SPDX-License-Identifier: Apache-2.0
// When the loop's steps are due, and sleeping until then.
#pragma once

#include <cstdint>

#include "phalanx/device/clock.h"

namespace phalanx {

/// The deadlines t_k = begin + k period, k = 1, 2, ...  Computed from k and never added up, so that they do
/// not drift. Pure arithmetic. Real-time.
struct DeadlineGrid {
  double begin = 0.0;   ///< [s]
  double period = 1.0;  ///< > 0 [s]

  [[nodiscard]] double at(std::uint64_t k) const noexcept { return begin + static_cast<double>(k) * period; }
  /// The first k > last with t_k >= now: what was missed is left out, and the grid stays where it was.
  [[nodiscard]] std::uint64_t next(std::uint64_t last, double now) const noexcept;
};

/// One waking-up.
struct Wake {
  double deadline = 0.0;      ///< when it was due, on the grid [s]
  double now = 0.0;           ///< when it happened [s]
  double lateness = 0.0;      ///< now - deadline, >= 0 [s]
  std::uint64_t skipped = 0;  ///< deadlines between this one and the last that were missed, and left out
};

/// Paces a loop with absolute deadlines. A loop that overran is not given several steps at once to catch up:
/// to a hand that would be an old motion played back in a burst.
class Pacer {
 public:
  /// The first deadline is one period from now.
  /// @param clock   outlives the pacer
  /// @param period  [s]  @throws std::invalid_argument unless positive and finite
  Pacer(const Clock& clock, double period);

  /// Sleeps until the next deadline that has not passed; a signal does not shorten it.
  /// Real-time: no allocation, lock or throw; it waits, which is its purpose.
  Wake wait() noexcept;

  [[nodiscard]] double period() const noexcept { return grid_.period; }
  [[nodiscard]] const DeadlineGrid& grid() const noexcept { return grid_; }

 private:
  const Clock& clock_;
  DeadlineGrid grid_;
  std::uint64_t last_ = 0;  ///< k of the last deadline that was waited for
};

}  // namespace phalanx
