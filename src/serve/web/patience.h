// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace phalanx::web {

/// How long a body of so many bytes may take: slower than 16 kB/s is as good as stuck [s].
[[nodiscard]] inline double patience(double idle_timeout, std::size_t bytes) noexcept {
  constexpr double kSlowest = 16e3;  // [bytes/s]
  return idle_timeout + static_cast<double>(bytes) / kSlowest;
}

}  // namespace phalanx::web
