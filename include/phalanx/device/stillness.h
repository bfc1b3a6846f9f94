// SPDX-License-Identifier: Apache-2.0
// For how long a measured value has stayed still.
#pragma once

#include <algorithm>
#include <cstddef>

namespace phalanx {

/// Values of one sensor that have stayed within a band since some time. A value outside the band begins again: also
/// a single wrong one ends the hold.
class Stillness {
 public:
  /// @param band  largest difference of two values that count as still, in the values' unit
  explicit Stillness(double band) noexcept : band_(band) {}

  /// Adds a value. Real-time.
  /// @param now  time of the value, not decreasing [s]
  void add(double value, double now) noexcept {
    if (count_ == 0 || std::max(high_, value) - std::min(low_, value) > band_) {
      since_ = now;
      low_ = high_ = value;
      sum_ = 0.0;
      count_ = 0;
    }
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
    sum_ += value;
    ++count_;
    newest_ = now;
  }

  /// @returns true if a value has come. Real-time.
  [[nodiscard]] bool heard() const noexcept { return count_ > 0; }
  /// @returns for how long the values have been still, up to the newest one [s].
  [[nodiscard]] double held_for() const noexcept { return heard() ? newest_ - since_ : 0.0; }
  /// @returns the mean since then.
  /// @pre heard()
  [[nodiscard]] double mean() const noexcept { return sum_ / static_cast<double>(count_); }

 private:
  double band_;
  double since_ = 0.0;   ///< [s]
  double newest_ = 0.0;  ///< [s]
  double low_ = 0.0;
  double high_ = 0.0;
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

}  // namespace phalanx
