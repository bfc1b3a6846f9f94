// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/number_range.h"

#include <fmt/format.h>

#include <cmath>

namespace phalanx {

bool NumberRange::contains(double value) const noexcept {
  if (allows_minus_infinity && value == -std::numeric_limits<double>::infinity()) return true;
  if (!std::isfinite(value)) return false;
  return (min_open ? value > min : value >= min) && (max_open ? value < max : value <= max);
}

std::string NumberRange::text() const {
  std::string text;
  if (std::isfinite(min)) text = fmt::format("{} {}", min_open ? ">" : ">=", min);
  if (std::isfinite(max))
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", max_open ? "<" : "<=", max);
  if (text.empty()) text = "any finite number";
  if (allows_minus_infinity) text += ", or -inf";
  return text;
}

}  // namespace phalanx
