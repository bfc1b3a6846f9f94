// SPDX-License-Identifier: Apache-2.0
// Statistics of the loop's deadlines: lateness, duration of a step, overruns. The bins of their histograms grow
// with the duration, so that 1 us and 1 s have the same relative error.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>

namespace phalanx {

/// One waking-up of the loop.
struct Wake {
  double deadline = 0.0;      ///< the deadline that was waited for [s]
  double now = 0.0;           ///< time of the waking-up [s]
  double lateness = 0.0;      ///< now - deadline, >= 0 [s]
  std::uint64_t skipped = 0;  ///< missed deadlines between the one before and this one
};

/// Histogram of durations: 16 equal bins in each octave (doubling), from 0.1 us to 13.4 s, in 3.5 KiB.
/// A percentile is the middle of its bin, at most 1/32 of the true value away from it; the largest duration
/// is exact. All durations below 0.1 us share one bin, and all above 13.4 s another.
/// One thread writes it; readers get a copy by value (core/latest.h).
/// Real-time: add() and merge(); no allocation, lock, throw or I/O.
class Histogram {
 public:
  static constexpr std::size_t kPerOctave = 16;
  static constexpr std::size_t kOctaves = 27;
  static constexpr double kFloor = 1e-7;  ///< lower edge of the first ordinary bin [s]

  /// Adds one duration.
  /// @param duration  [s]; a negative one counts as 0, and NaN (not a number) is left out
  void add(double duration) noexcept {
    if (duration != duration) return;
    ++count_[bin(duration)];
    ++total_;
    if (duration > max_) max_ = duration;
  }
  /// Adds everything that was added to `other`.
  void merge(const Histogram& other) noexcept;

  [[nodiscard]] std::uint64_t count() const noexcept { return total_; }
  /// @returns the largest duration, exact [us]; 0 if empty.
  [[nodiscard]] double max_us() const noexcept { return max_ * 1e6; }
  /// @returns the percentile by nearest rank: `percent` of all durations are not longer [us]. 0 if empty.
  /// @param percent  0 (the shortest) .. 100 (the longest, which is exact)
  [[nodiscard]] double percentile_us(double percent) const noexcept;
  /// @returns the count of durations in octave k, which is [0.1 us 2^k, 0.1 us 2^(k+1)).  @pre k < kOctaves
  [[nodiscard]] std::uint64_t in_octave(std::size_t k) const noexcept;
  [[nodiscard]] std::uint64_t below_range() const noexcept { return count_.front(); }
  [[nodiscard]] std::uint64_t above_range() const noexcept { return count_.back(); }

 private:
  static constexpr std::size_t kBins = 1 + kOctaves * kPerOctave + 1;

  /// Finds the bin of a duration. The exponent of a double and the four highest bits of its fraction, read as
  /// one number, count exactly these bins: 16 equally wide ones in each octave.
  [[nodiscard]] static std::size_t bin(double duration) noexcept {
    const double ratio = duration / kFloor;
    if (!(ratio >= 1.0)) return 0;
    const std::uint64_t above_one =
        (std::bit_cast<std::uint64_t>(ratio) >> 48U) - (std::bit_cast<std::uint64_t>(1.0) >> 48U);
    return above_one < kOctaves * kPerOctave ? 1 + static_cast<std::size_t>(above_one) : kBins - 1;
  }
  [[nodiscard]] static double middle(std::size_t bin) noexcept;

  std::array<std::uint64_t, kBins> count_{};
  std::uint64_t total_ = 0;
  double max_ = 0.0;
};

/// Writes a line of percentiles, then one line for each octave from the first to the last that is not empty.
/// For reports only: it allocates.
[[nodiscard]] std::string histogram_text(const Histogram& histogram, const std::string& title);

/// Counts and histograms of all steps since the start, about 7 KiB. It holds no pointers, so that it can be
/// copied to readers by value.
/// A step overran if it ended after the next deadline. A step that ends exactly on the deadline is in time.
/// Real-time: add() and degraded(); no allocation, lock, throw or I/O.
struct DeadlineStatistics {
  static constexpr double kDegradedFor = 1.0;  ///< how long degraded() holds after an overrun [s]

  double period = 1e-3;  ///< period of the loop [s]
  Histogram lateness{};  ///< from the deadline to the waking-up: the jitter
  Histogram step{};      ///< from waking up to the end of the step
  std::uint64_t steps = 0;
  std::uint64_t overruns = 0;         ///< steps that ended after the next deadline
  std::uint64_t overruns_in_row = 0;  ///< overruns up to and with the newest step; 0 if that one was in time
  std::uint64_t longest_run = 0;      ///< the largest value that overruns_in_row ever had
  std::uint64_t skipped = 0;          ///< deadlines left out because the loop was still busy
  double last_overrun = 0.0;          ///< end of the last overrun [s]; without meaning while overruns is 0

  /// Adds one step.
  /// @param wake      the waking-up that began it
  /// @param step_end  time at which the step's command had been handed over, of the same clock [s]
  void add(const Wake& wake, double step_end) noexcept;

  /// Adds the steps of `later`, as if this loop had made them after its own, at the period of `later`.
  void append(const DeadlineStatistics& later) noexcept;

  /// @returns true if a step overran in the last second before `now` [s].
  [[nodiscard]] bool degraded(double now) const noexcept {
    return overruns > 0 && now - last_overrun < kDegradedFor;
  }
};

}  // namespace phalanx
