// SPDX-License-Identifier: Apache-2.0
// Many small pictures on one sheet, each with its name.
#pragma once

#include <string>
#include <vector>

#include "phalanx/figures/picture.h"

namespace phalanx {

/// One picture of a sheet.
struct SheetTile {
  Image image;
  std::string label;  ///< small letters, digits, '_', '.', ' ' and N are drawn; others are left out
};

/// Arranges the tiles row by row from the upper left, `columns` to a row, each with its label below. The
/// background is that of render_picture(). If the last row is not full, it stays empty at its right.
/// @throws std::invalid_argument unless there is a tile, all have the same size and columns is at
/// least 1. Deterministic.
[[nodiscard]] Image contact_sheet(const std::vector<SheetTile>& tiles, int columns);

}  // namespace phalanx
