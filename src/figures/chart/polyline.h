// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace phalanx {

/// @returns the indices of the points that a curve of `values` keeps if its x axis has `columns`
/// distinguishable columns: per column the first, the smallest, the largest and the last, in order. If there
/// are few points, it keeps all but the inner points of level ranges.
[[nodiscard]] std::vector<std::size_t> thinned(const std::vector<double>& values, std::size_t columns);

}  // namespace phalanx
