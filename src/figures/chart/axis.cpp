// SPDX-License-Identifier: Apache-2.0
#include "figures/chart/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace phalanx {

double drawable(double value) noexcept { return std::clamp(value, -1e300, 1e300); }

void Range::include(double value) noexcept {
  if (!std::isfinite(value)) return;
  low = std::min(low, drawable(value));
  high = std::max(high, drawable(value));
}

void Range::include(const std::vector<double>& values) noexcept {
  for (const double value : values) include(value);
}

Range Range::for_axis() const noexcept {
  if (empty()) return {.low = 0.0, .high = 1.0};
  if (high > low) return *this;
  return {.low = low, .high = low + (low == 0.0 ? 1.0 : std::max(1e-12, 0.1 * std::abs(low)))};
}

std::vector<double> nice_ticks(double low, double high, int count) {
  const double rough = (high - low) / std::max(1, count - 1);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double spacing = 10.0 * power;
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= rough * (1.0 - 1e-9)) {
      spacing = step * power;
      break;
    }
  }
  // A low that is a tick but for rounding is not moved one tick further out.
  const auto first = static_cast<long>(std::floor(low / spacing + 1e-9));
  const auto last = static_cast<long>(std::ceil(high / spacing - 1e-9));
  std::vector<double> ticks;
  for (long i = first; i <= last; ++i) ticks.push_back(static_cast<double>(i) * spacing);
  return ticks;
}

std::string tick_label(double value, double spacing) {
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(spacing) - 1e-9)));
  if (std::abs(value) < 0.5 * std::pow(10.0, -decimals)) return "0";
  const std::string number = fmt::format("{:.{}f}", std::abs(value), decimals);
  return value < 0.0 ? "\u2212" + number : number;
}

}  // namespace phalanx
