// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "figures/picture/overlay.h"

namespace phalanx {
namespace {

constexpr std::uint8_t kPaper = 236;

/// Positions of the tiles, with the room around and below them [pixels].
struct Layout {
  int tile_width, tile_height, gap, strip, columns, rows;
  [[nodiscard]] int width() const { return columns * (tile_width + gap) + gap; }
  [[nodiscard]] int height() const { return rows * (tile_height + strip + gap) + gap; }
  [[nodiscard]] int left(int i) const { return gap + i % columns * (tile_width + gap); }
  [[nodiscard]] int top(int i) const { return gap + i / columns * (tile_height + strip + gap); }
};

void paste(Image& sheet, const Image& tile, int left, int top) {
  for (int y = 0; y < tile.height; ++y) {
    const auto from = tile.rgb.begin() + static_cast<std::ptrdiff_t>(3) * y * tile.width;
    std::copy(from, from + static_cast<std::ptrdiff_t>(3) * tile.width,
              sheet.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(top + y) * sheet.width + left));
  }
}

/// Draws the label in dark ink on the background.
Image label_strip(const std::string& text, int width, int height) {
  const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  picture::Canvas canvas{width, height, std::vector<picture::Vec3f>(size, picture::Vec3f::Zero())};
  const float h = static_cast<float>(height);
  draw_text(canvas, 2.0F, 0.72F * h, 0.5F * h, text, picture::Vec3f::Ones());  // coverage, 0 to 1
  Image strip{.width = width, .height = height, .rgb = {}};
  constexpr float kInk = 36.0F;
  for (const picture::Vec3f& cover : canvas.pixel) {
    const float value = static_cast<float>(kPaper) + cover.x() * (kInk - static_cast<float>(kPaper));
    strip.rgb.insert(strip.rgb.end(), 3, static_cast<std::uint8_t>(std::lround(value)));
  }
  return strip;
}

}  // namespace

Image contact_sheet(const std::vector<SheetTile>& tiles, int columns) {
  if (tiles.empty()) throw std::invalid_argument("contact sheet: no tiles; give at least one");
  if (columns < 1)
    throw std::invalid_argument(fmt::format("contact sheet: columns is {}; give at least 1", columns));
  const Image& first = tiles.front().image;
  for (const SheetTile& tile : tiles) {
    if (tile.image.width == first.width && tile.image.height == first.height) continue;
    throw std::invalid_argument(
        fmt::format("contact sheet: the tile '{}' has {} x {} pixels, the first {} x {}; "
                    "render all in one size",
                    tile.label, tile.image.width, tile.image.height, first.width, first.height));
  }
  const int count = static_cast<int>(tiles.size());
  const Layout layout{.tile_width = first.width,
                      .tile_height = first.height,
                      .gap = std::max(2, first.height / 40),
                      .strip = std::max(12, first.height / 9),
                      .columns = std::min(columns, count),
                      .rows = (count + columns - 1) / columns};
  Image sheet{.width = layout.width(), .height = layout.height(), .rgb = {}};
  sheet.rgb.assign(static_cast<std::size_t>(3) * static_cast<std::size_t>(sheet.width) *
                       static_cast<std::size_t>(sheet.height),
                   kPaper);
  for (int i = 0; i < count; ++i) {
    const SheetTile& tile = tiles[static_cast<std::size_t>(i)];
    paste(sheet, tile.image, layout.left(i), layout.top(i));
    paste(sheet, label_strip(tile.label, layout.tile_width, layout.strip), layout.left(i),
          layout.top(i) + layout.tile_height);
  }
  return sheet;
}

}  // namespace phalanx
