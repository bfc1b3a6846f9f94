// SPDX-License-Identifier: Apache-2.0
#include "figures/picture/letters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace phalanx {
namespace {

TEST(Letters, AreAllDrawnWithinTheirWidthAndNoTwoAlike) {
  std::set<std::vector<float>> shapes;
  for (const char c : std::string("0123456789Nabcdefghijklmnopqrstuvwxyz_.")) {
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
  for (const char c : std::string(" #A")) picture::letter_strokes(c, none);
  EXPECT_TRUE(none.empty());
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
