// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/contact_sheet.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>

#include "figures/picture/letters.h"

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

TEST(Letters, AreAllDrawnWithinTheirWidthAndNoTwoAlike) {
  std::set<std::vector<float>> shapes;
  for (const char c : std::string("abcdefghijklmnopqrstuvwxyz_")) {
    picture::Strokes lines;
    picture::letter_strokes(c, lines);
    ASSERT_FALSE(lines.empty()) << c;
    std::vector<float> shape;
    for (const auto& [a, b] : lines) {
      for (const Eigen::Vector2f& p : {a, b}) {
        EXPECT_GE(p.x(), -0.7F) << c;
        EXPECT_LT(p.x(), picture::letter_advance(c)) << c;
        EXPECT_GE(p.y(), -2.01F) << c;
        EXPECT_LE(p.y(), 6.01F) << c;
        shape.insert(shape.end(), {p.x(), p.y()});
      }
    }
    EXPECT_TRUE(shapes.insert(shape).second) << c;
  }
  picture::Strokes none;
  picture::letter_strokes('5', none);
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(picture::letter_advance('5'), 0.0F);
}

/// Whether a stroke passes within 0.45 of the point.
bool inked(const picture::Strokes& lines, const Eigen::Vector2f& p) {
  return std::ranges::any_of(lines, [&](const auto& stroke) {
    const Eigen::Vector2f along = stroke.second - stroke.first;
    const float t = std::clamp((p - stroke.first).dot(along) / along.squaredNorm(), 0.0F, 1.0F);
    return (p - stroke.first - t * along).norm() < 0.45F;
  });
}

// As read by eye: a row for each height from 6 to -2, a column each 0.85, seven of them for m and w, five for
// the others, and two blank ones behind each letter.
TEST(Letters, LookLikeLetters) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> bands = {
      {"abcdefghi",
       {"       #                 #           ##          #       #     ",
        "       #                 #          #            #             ",
        " ####  ####    ###    ####   ###   ####    ####  ####    #     ",
        "#   #  #   #  #      #   #  #   #   #     #   #  #   #   #     ",
        "#   #  #   #  #      #   #  #####   #     #   #  #   #   #     ",
        "#   #  #   #  #      #   #  #       #     #   #  #   #   #     ",
        " ####  ####    ###    ####   ###    #      ####  #   #   #     ",
        "                                              #                ",
        "                                           ###                 "}},
      {"jklmnopqr",
       {"  #    #       #                                                 ",
        "       #       #                                                 ",
        "  #    #  #    #     ### ##   ####    ###   ####    ####  ####   ",
        "  #    # #     #     #  #  #  #   #  #   #  #   #  #   #  ##     ",
        "  #    ###     #     #  #  #  #   #  #   #  #   #  #   #  #      ",
        "  #    #  #    #     #  #  #  #   #  #   #  #   #  #   #  #      ",
        "  #    #  ##   #     #  #  #  #   #   ###   ####    ####  #      ",
        "  #                                         #          #         ",
        "##                                          #          #         "}},
      {"stuvwxyz_",
       {"                                                                 ",
        "        #                                                        ",
        " ###   ####   #   #  #   #  #  #  #  #   #  #   #  #####         ",
        "#       #     #   #  ## ##  #  #  #   # #   ## ##     #          ",
        " ###    #     #   #   # #    ## ##     #     # #     #           ",
        "   ##   #     #   #   ###    ## ##    # #    ###    #            ",
        " ###     ##    ####    #     ##  #   #   #    #    #####         ",
        "                                             ##           #####  ",
        "                                             #                   "}}};
  for (const auto& [letters, rows] : bands) {
    for (int row = 0; row < 9; ++row) {
      std::string drawn;
      for (const char c : letters) {
        picture::Strokes lines;
        picture::letter_strokes(c, lines);
        for (int column = 0; column < (c == 'm' || c == 'w' ? 7 : 5); ++column)
          drawn +=
              inked(lines, {0.85F * static_cast<float>(column), static_cast<float>(6 - row)}) ? '#' : ' ';
        drawn += "  ";
      }
      EXPECT_EQ(drawn, rows.at(static_cast<std::size_t>(row))) << letters << ", row " << row;
    }
  }
}

/// Whether the strokes meet, but for the rounding of their ends.
bool meet(const std::pair<Eigen::Vector2f, Eigen::Vector2f>& one,
          const std::pair<Eigen::Vector2f, Eigen::Vector2f>& other) {
  const Eigen::Vector2f along = other.second - other.first;
  for (int i = 0; i <= 100; ++i) {
    const Eigen::Vector2f p = one.first + (static_cast<float>(i) / 100.0F) * (one.second - one.first);
    const float t = std::clamp((p - other.first).dot(along) / along.squaredNorm(), 0.0F, 1.0F);
    if ((p - other.first - t * along).norm() < 0.1F) return true;
  }
  return false;
}

// Each letter is of one piece; an i and a j have their dot.
TEST(Letters, HangTogether) {
  for (const char c : std::string("abcdefghijklmnopqrstuvwxyz")) {
    picture::Strokes left;
    picture::letter_strokes(c, left);
    int pieces = 0;
    while (!left.empty()) {
      ++pieces;
      picture::Strokes piece{left.back()};
      left.pop_back();
      for (std::size_t k = 0; k < piece.size(); ++k) {
        const auto of_piece = [&](const auto& stroke) {
          return meet(stroke, piece[k]) || meet(piece[k], stroke);
        };
        const auto rest =
            std::partition(left.begin(), left.end(), [&](const auto& stroke) { return !of_piece(stroke); });
        piece.insert(piece.end(), rest, left.end());
        left.erase(rest, left.end());
      }
    }
    EXPECT_EQ(pieces, c == 'i' || c == 'j' ? 2 : 1) << c;
  }
}

}  // namespace
}  // namespace phalanx
