// SPDX-License-Identifier: Apache-2.0
// The onset of an oscillation, found in hindsight: the reference for the on-line observer.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

namespace phalanx {

/// Detector of a force that rises and falls, or falls and rises, by more than kSwing within kSwingWithin. The
/// force has to continue so for kSustained: a bounce or a bump ends earlier.
class SwingWatch {
 public:
  static constexpr double kSwing = 0.5;          ///< [N]
  static constexpr double kSwingWithin = 0.125;  ///< a period at 8 Hz [s]
  static constexpr double kSustained = 0.2;      ///< [s]

  /// Adds one value.
  /// @param t  increasing [s]   @param force  [N]
  /// @returns the time from which the force has swung, once it has done so for kSustained; else NaN [s]
  double add(double t, double force) {
    if (!swings(t, force)) {
      since_ = std::numeric_limits<double>::quiet_NaN();
    } else if (std::isnan(since_)) {
      since_ = t;
    }
    return t - since_ >= kSustained ? since_ : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  bool swings(double t, double force) {
    recent_.push_back({t, force});
    while (recent_.front().t < t - kSwingWithin) recent_.pop_front();
    double low = recent_.front().force, high = low, rise = 0.0, fall = 0.0;
    for (const Point& point : recent_) {  // oldest first
      low = std::min(low, point.force);
      high = std::max(high, point.force);
      rise = std::max(rise, point.force - low);
      fall = std::max(fall, high - point.force);
    }
    return rise > kSwing && fall > kSwing;
  }

  struct Point {
    double t, force;
  };
  std::deque<Point> recent_;
  double since_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace phalanx
