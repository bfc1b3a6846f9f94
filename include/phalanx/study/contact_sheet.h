// SPDX-License-Identifier: Apache-2.0
// Many small pictures on one sheet, each with its name.
#pragma once

#include <string>
#include <vector>

#include "phalanx/study/picture.h"

namespace phalanx {

struct SheetTile {
  Image image;
  std::string label;  ///< small letters, digits, '_', '.', ' ' and N are drawn, anything else is left out
};

/// The tiles row by row from the upper left, `columns` to a row, each with its label below, on the background
/// of render_picture(). A last row that is not full stays empty at its right.
/// @throws std::invalid_argument unless there is a tile, all have the same size and columns is at least 1.
/// Deterministic.
[[nodiscard]] Image contact_sheet(const std::vector<SheetTile>& tiles, int columns);

}  // namespace phalanx
