// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

namespace phalanx {

/// @returns the shortest text that reads back as the same number: "0.9", "1000000", "1e-06". Set-up only.
[[nodiscard]] inline std::string shortest_text(double number) {
  std::array<char, 32> text;  // the longest is "-2.2250738585072014e-308"
  const double size = std::abs(number);
  const auto format = number == 0.0 || (size >= 1e-4 && size < 1e16) ? std::chars_format::fixed
                                                                     : std::chars_format::scientific;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number, format).ptr};
}

/// The allowed values of a number.
struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;  ///< min itself is not allowed
  bool max_open = false;  ///< max itself is not allowed
  bool allows_minus_infinity = false;

  /// @returns true for an allowed value; false for NaN and infinity
  [[nodiscard]] bool contains(double value) const noexcept {
    if (allows_minus_infinity && value == -std::numeric_limits<double>::infinity()) return true;
    if (!std::isfinite(value)) return false;
    return (min_open ? value > min : value >= min) && (max_open ? value < max : value <= max);
  }

  /// Describes the range: "> 0, <= 15", "any finite number". Set-up only.
  [[nodiscard]] std::string text() const {
    std::string text;
    if (std::isfinite(min)) text = (min_open ? "> " : ">= ") + shortest_text(min);
    if (std::isfinite(max)) {
      if (!text.empty()) text += ", ";
      text += (max_open ? "< " : "<= ") + shortest_text(max);
    }
    if (text.empty()) text = "any finite number";
    if (allows_minus_infinity) text += ", or -inf";
    return text;
  }

  [[nodiscard]] bool operator==(const NumberRange&) const = default;
};

/// @returns the range min <= value <= max.
[[nodiscard]] constexpr NumberRange between(double min, double max) { return {.min = min, .max = max}; }
/// @returns the range min < value <= max.
[[nodiscard]] constexpr NumberRange above(double min, double max) {
  return {.min = min, .max = max, .min_open = true};
}

}  // namespace phalanx
