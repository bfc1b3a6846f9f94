// SPDX-License-Identifier: Apache-2.0
#include "duration_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

namespace phalanx {

std::string duration_text(double seconds) {
  const auto s = static_cast<long long>(std::llround(seconds));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

double on_all_cores(double processor_seconds) noexcept {
  return std::max(1.0, processor_seconds / std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace phalanx
