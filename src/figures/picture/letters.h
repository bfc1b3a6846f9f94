// SPDX-License-Identifier: Apache-2.0
// The stroke font for text in images: digits, small letters, 'N', '.' and '_'.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace phalanx::picture {

using Strokes = std::vector<std::pair<Eigen::Vector2f, Eigen::Vector2f>>;

/// Adds the strokes of a character, y up. The base line is at 0; small letters are 4 high, digits, 'N' and
/// tall letters 6, and tails go down to -2. Most are 4 wide. Any other character has no stroke.
void letter_strokes(char letter, Strokes& lines);

/// @returns the distance from one character's left edge to the next one's.
[[nodiscard]] float letter_advance(char letter);

}  // namespace phalanx::picture
