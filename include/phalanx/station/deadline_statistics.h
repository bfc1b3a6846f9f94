// SPDX-License-Identifier: Apache-2.0
// Statistics of the loop's deadlines: lateness, duration of a step, overruns.
#pragma once

#include <algorithm>
#include <cstdint>

#include "phalanx/station/histogram.h"
#include "phalanx/station/pacer.h"

namespace phalanx {

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
  /// @param wake      what the pacer returned for this step
  /// @param step_end  time at which the step's command had been handed over, of the same clock [s]
  void add(const Wake& wake, double step_end) noexcept {
    ++steps;
    skipped += wake.skipped;
    lateness.add(wake.lateness);
    step.add(step_end - wake.now);
    if (step_end <= wake.deadline + period) {
      overruns_in_row = 0;
      return;
    }
    ++overruns;
    ++overruns_in_row;
    longest_run = std::max(longest_run, overruns_in_row);
    last_overrun = step_end;
  }

  /// Adds the steps of `later`, as if this loop had made them after its own, at the period of `later`.
  void append(const DeadlineStatistics& later) noexcept {
    period = later.period;
    lateness.merge(later.lateness);
    step.merge(later.step);
    steps += later.steps;
    overruns += later.overruns;
    overruns_in_row = later.overruns_in_row;
    longest_run = std::max(longest_run, later.longest_run);
    skipped += later.skipped;
    if (later.overruns > 0) last_overrun = later.last_overrun;
  }

  /// @returns true if a step overran in the last second before `now` [s].
  [[nodiscard]] bool degraded(double now) const noexcept {
    return overruns > 0 && now - last_overrun < kDegradedFor;
  }
};

}  // namespace phalanx
