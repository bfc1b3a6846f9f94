// SPDX-License-Identifier: Apache-2.0
// How well the loop keeps its deadlines.
#pragma once

#include <algorithm>
#include <cstdint>

#include "phalanx/station/histogram.h"
#include "phalanx/station/pacer.h"

namespace phalanx {

/// What became of every step since the start. About 7 KiB, without pointers: copied to readers by value.
/// A step overran if it ended after the next deadline; ending right on it is in time.
/// Real-time: add() and degraded(); no allocation, lock, throw or I/O.
struct DeadlineStatistics {
  static constexpr double kDegradedFor = 1.0;  ///< after an overrun [s]

  double period = 1e-3;  ///< of the loop [s]
  Histogram lateness{};  ///< waking-up after the deadline: the jitter
  Histogram step{};      ///< from waking up to the end of the step
  std::uint64_t steps = 0;
  std::uint64_t overruns = 0;         ///< steps that ended after the next deadline
  std::uint64_t overruns_in_row = 0;  ///< up to and with the newest step; 0 if that was in time
  std::uint64_t longest_run = 0;      ///< the largest that overruns_in_row ever was
  std::uint64_t skipped = 0;          ///< deadlines left out because the loop was still busy
  double last_overrun = 0.0;          ///< when it ended [s]; of no meaning while overruns is 0

  /// @param wake      what the pacer gave for this step
  /// @param step_end  the same clock when the step's command had been handed over [s]
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

  /// As if the steps of `later` had been made here, after the others, in a loop of its period.
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

  /// Whether a step overran in the last second before `now` [s].
  [[nodiscard]] bool degraded(double now) const noexcept {
    return overruns > 0 && now - last_overrun < kDegradedFor;
  }
};

}  // namespace phalanx
