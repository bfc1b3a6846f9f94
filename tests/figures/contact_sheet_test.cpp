// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/contact_sheet.h"

#include <gmock/gmock.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace phalanx {
namespace {

using Pixel = std::array<int, 3>;

SheetTile tile(int width, int height, Pixel colour, std::string label) {
  SheetTile tile{.image = {.width = width, .height = height, .rgb = {}}, .label = std::move(label)};
  for (int i = 0; i < width * height; ++i)
    for (const int channel : colour) tile.image.rgb.push_back(static_cast<std::uint8_t>(channel));
  return tile;
}

Pixel at(const Image& image, int x, int y) {
  const auto i =
      static_cast<std::size_t>(3) *
      (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  return {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
}

int count(const Image& image, const Pixel& colour) {
  int n = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) n += at(image, x, y) == colour ? 1 : 0;
  return n;
}

constexpr Pixel kRed{200, 10, 10};
constexpr Pixel kGreen{10, 200, 10};
constexpr Pixel kBlue{10, 10, 200};

TEST(ContactSheet, ShowsEveryTileWholeRowByRow) {
  const Image sheet = contact_sheet(
      {tile(40, 30, kRed, "one"), tile(40, 30, kGreen, "two"), tile(40, 30, kBlue, "three")}, 2);
  ASSERT_EQ(sheet.rgb.size(), static_cast<std::size_t>(3) * static_cast<std::size_t>(sheet.width) *
                                  static_cast<std::size_t>(sheet.height));
  for (const Pixel& colour : {kRed, kGreen, kBlue}) EXPECT_EQ(count(sheet, colour), 40 * 30);
  EXPECT_EQ(at(sheet, sheet.width / 4, 10), kRed);
  EXPECT_EQ(at(sheet, 3 * sheet.width / 4, 10), kGreen);
  EXPECT_EQ(at(sheet, sheet.width / 4, sheet.height / 2 + 10), kBlue);
}

TEST(ContactSheet, WritesTheLabelBelowItsTile) {
  const Image plain = contact_sheet({tile(160, 120, kRed, "")}, 1);
  const Image labelled = contact_sheet({tile(160, 120, kRed, "grasp_mug 1.7 N")}, 1);
  EXPECT_EQ(plain.height, labelled.height);
  const auto dark = [](const Image& image) {
    int n = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const Pixel p = at(image, x, y);
        n += p[0] < 120 && p[0] == p[1] && p[1] == p[2] ? 1 : 0;
      }
    return n;
  };
  EXPECT_EQ(dark(plain), 0);
  EXPECT_GT(dark(labelled), 50);
  EXPECT_EQ(count(labelled, kRed), 160 * 120);
}

TEST(ContactSheet, RefusesNoTilesUnequalTilesAndNoColumns) {
  EXPECT_THROW((void)contact_sheet({}, 3), std::invalid_argument);
  EXPECT_THROW((void)contact_sheet({tile(40, 30, kRed, "a")}, 0), std::invalid_argument);
  try {
    (void)contact_sheet({tile(40, 30, kRed, "a"), tile(41, 30, kRed, "odd")}, 2);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("'odd' has 41 x 30"));
  }
}

}  // namespace
}  // namespace phalanx
