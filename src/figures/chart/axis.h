// SPDX-License-Identifier: Apache-2.0
// Range of an axis or a colour scale, and its ticks.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace phalanx {

/// @returns a value that is not beyond 1e300, either way: the extent of such values and its ticks are finite,
/// and so are their places in a frame.
[[nodiscard]] double drawable(double value) noexcept;

/// Range of the finite values that a chart shows. It begins empty.
struct Range {
  double low = HUGE_VAL;  ///< larger than `high`: no value yet
  double high = -HUGE_VAL;

  /// Includes a value. One that is not finite changes nothing; one beyond 1e300 counts as drawable() returns it.
  void include(double value) noexcept;
  void include(const std::vector<double>& values) noexcept;
  [[nodiscard]] bool empty() const noexcept { return low > high; }
  /// @returns a range with low < high for an axis: this one if it has an extent, 0 to 1 if it is empty, else
  /// from the only value to a tenth of it above (1 above 0).
  [[nodiscard]] Range for_axis() const noexcept;
};

/// @returns round numbers (1, 2 or 5 times a power of ten apart), about `count` of them. They go from the
/// last one at or below `low` to the first at or above `high`. @pre low < high, finite.
[[nodiscard]] std::vector<double> nice_ticks(double low, double high, int count);

/// @returns a tick's label, with as many decimals as the spacing needs and a real minus sign.
[[nodiscard]] std::string tick_label(double value, double spacing);

}  // namespace phalanx
