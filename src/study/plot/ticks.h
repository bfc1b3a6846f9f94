// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace phalanx {

/// Round numbers (1, 2 or 5 times a power of ten apart) from the last one at or below `low` to the first at
/// or above `high`, about `count` of them. @pre low < high, finite.
[[nodiscard]] std::vector<double> nice_ticks(double low, double high, int count);

/// A tick's label: as many decimals as the spacing needs, a real minus sign.
[[nodiscard]] std::string tick_label(double value, double spacing);

}  // namespace phalanx
