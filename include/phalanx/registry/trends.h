// SPDX-License-Identifier: Apache-2.0
// Trends over assessments and entered tests, with a verdict in words.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "phalanx/registry/result.h"

namespace phalanx {

/// One value of a trend.
struct TrendPoint {
  double date = 0.0;  ///< UTC [s since 1970]
  double value = 0.0;
  std::string recording;  ///< its recording; empty for an entered test
};

/// Values over time that may be compared with each other.
struct Trend {
  std::string name;   ///< "press_and_hold/mean_n", or an entered test's "grip/more_affected"
  std::string title;  ///< for people
  std::string unit;
  std::optional<ScoreOrigin> origin;  ///< none: an entered test
  ResultConditions conditions;        ///< equal for all points; empty for an entered test
  std::vector<TrendPoint> points;     ///< by date; at least one
  std::optional<double> smallest_real_difference;
  bool proven =
      false;  ///< the change from the first to the last point is at least the smallest real difference
  /// "change not proven: ...", or "improved by 6 blocks/min from 2026-05-04 to 2026-06-01 (smallest real
  /// difference 5.5, ...)"
  std::string verdict;
};

/// Joins results to trends. Only valid scores of valid, uninterrupted assessments count. Values join if
/// exercise, score, unit, origin and all conditions are equal. Two results of one name but with other
/// conditions make two trends; the later one's verdict names what differs. Entered tests join by kind and
/// side. Sorted by name, then by first date.
[[nodiscard]] std::vector<Trend> make_trends(std::span<const ResultRow> results,
                                             std::span<const EnteredTest> tests);

}  // namespace phalanx
