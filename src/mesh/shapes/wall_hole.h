// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Hole in the cells of the wall. In each band the columns `begin`..`end` (unwrapped) are cut out. Bands
/// count from the wall's first row.
struct Hole {
  struct Cut {
    int begin = 0;
    int end = 0;
  };
  std::map<int, Cut> bands;
  std::vector<Triangle> filling;  // between the hole's edge and the tube's end

  [[nodiscard]] bool cuts(int band, int column, int around) const {
    const auto found = bands.find(band);
    if (found == bands.end()) return false;
    const int from_begin = ((column - found->second.begin) % around + around) % around;
    return from_begin < found->second.end - found->second.begin;
  }
  [[nodiscard]] int widest() const {
    int columns = 0;
    for (const auto& [band, cut] : bands) columns = std::max(columns, cut.end - cut.begin);
    return columns;
  }
};

/// Returns the cells under `loop` (columns and rows as real numbers), widened by `margin` cells
/// on every side.
[[nodiscard]] std::optional<Hole> cut_hole(const std::vector<Eigen::Vector2d>& loop, int wall_bands,
                                           double margin);

/// Returns the boundary of a hole as lattice points, counter-clockwise in the (column, row) plane.
[[nodiscard]] std::vector<std::pair<int, int>> boundary(const Hole& hole);

}  // namespace phalanx::mesh
