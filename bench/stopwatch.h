// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace phalanx::bench {

/// Wall time since it was made. Reading it costs about 0.03 us, which the times contain.
class Stopwatch {
 public:
  [[nodiscard]] double us() const {
    return std::chrono::duration<double, std::micro>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace phalanx::bench
