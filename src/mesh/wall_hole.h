// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// The cells of the wall: columns `begin`..`end` (unwrapped) are cut out of each band; bands counted from the
/// wall's first row.
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

/// Cells under `loop` (columns and rows as real numbers), which is first widened by `margin` cells on every
/// side.
[[nodiscard]] std::optional<Hole> cut_hole(const std::vector<Eigen::Vector2d>& loop, int wall_bands,
                                           double margin);

/// The boundary of a hole, counter-clockwise in the (column, row) plane: lattice points.
[[nodiscard]] std::vector<std::pair<int, int>> boundary(const Hole& hole);

}  // namespace phalanx::mesh
