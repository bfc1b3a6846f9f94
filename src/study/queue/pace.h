// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cmath>
#include <deque>
#include <utility>

namespace phalanx {

/// Pace of the finished points over the last minute.
class Pace {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// @param done  number of finished points at `now`
  void add(Time now, int done) {
    constexpr auto kWindow = std::chrono::minutes(1);
    seen_.emplace_back(now, done);
    while (seen_.size() > 2 && now - seen_.front().first > kWindow) seen_.pop_front();
  }
  /// @returns points a second; NaN if none was finished in the window.
  [[nodiscard]] double per_s() const {
    if (seen_.empty()) return std::nan("");
    const int points = seen_.back().second - seen_.front().second;
    const double seconds = std::chrono::duration<double>(seen_.back().first - seen_.front().first).count();
    return points > 0 && seconds > 0.0 ? points / seconds : std::nan("");
  }

 private:
  std::deque<std::pair<Time, int>> seen_;
};

}  // namespace phalanx
