// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace phalanx {

/// @returns round numbers (1, 2 or 5 times a power of ten apart), about `count` of them. They go from the
/// last one at or below `low` to the first at or above `high`. @pre low < high, finite.
[[nodiscard]] std::vector<double> nice_ticks(double low, double high, int count);

/// @returns a tick's label, with as many decimals as the spacing needs and a real minus sign.
[[nodiscard]] std::string tick_label(double value, double spacing);

}  // namespace phalanx
