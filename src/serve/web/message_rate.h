// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

namespace phalanx::web {

/// Whether no more than so many came in any one second.
class MessageRate {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// @param per_second  >= 1
  explicit MessageRate(std::size_t per_second) : last_(per_second, Time::min()) {}

  [[nodiscard]] bool allows_one(Time now) noexcept {
    // The ring's oldest came per_second messages ago.
    Time& oldest = last_[next_];
    const bool allowed = oldest == Time::min() || now - oldest >= std::chrono::seconds(1);
    oldest = now;
    next_ = (next_ + 1) % last_.size();
    return allowed;
  }

 private:
  std::vector<Time> last_;
  std::size_t next_ = 0;
};

}  // namespace phalanx::web
