// SPDX-License-Identifier: Apache-2.0
#include "figures/chart/polyline.h"

#include <algorithm>
#include <array>

namespace phalanx {

std::vector<std::size_t> thinned(const std::vector<double>& values, std::size_t columns) {
  std::vector<std::size_t> kept;
  if (values.size() <= 4 * columns) {
    // Of a level range, only the ends are needed.
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool level =
          i > 0 && i + 1 < values.size() && values[i] == values[i - 1] && values[i] == values[i + 1];
      if (!level) kept.push_back(i);
    }
    return kept;
  }
  for (std::size_t column = 0; column < columns; ++column) {
    const std::size_t begin = column * values.size() / columns;
    const std::size_t end = (column + 1) * values.size() / columns;
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = values.begin() + static_cast<std::ptrdiff_t>(end);
    const auto [low, high] = std::minmax_element(first, last);
    std::array<std::size_t, 4> indices = {begin, static_cast<std::size_t>(low - values.begin()),
                                          static_cast<std::size_t>(high - values.begin()), end - 1};
    std::sort(indices.begin(), indices.end());
    kept.insert(kept.end(), indices.begin(), std::unique(indices.begin(), indices.end()));
  }
  return kept;
}

}  // namespace phalanx
