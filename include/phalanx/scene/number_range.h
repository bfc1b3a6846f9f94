// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

namespace phalanx {

/// The allowed values of a number.
struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;  ///< min itself is not allowed
  bool max_open = false;  ///< max itself is not allowed
  bool allows_minus_infinity = false;

  [[nodiscard]] bool contains(double value) const noexcept;
  /// Describes the range: "> 0, <= 15", "any finite number".
  [[nodiscard]] std::string text() const;
};
/// @returns the range min <= value <= max.
[[nodiscard]] constexpr NumberRange between(double min, double max) { return {.min = min, .max = max}; }
/// @returns the range min < value <= max.
[[nodiscard]] constexpr NumberRange above(double min, double max) {
  return {.min = min, .max = max, .min_open = true};
}

}  // namespace phalanx
