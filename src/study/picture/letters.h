// SPDX-License-Identifier: Apache-2.0
// Small letters as strokes, for labels. Internal to src/study/picture.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace phalanx::picture {

using Strokes = std::vector<std::pair<Eigen::Vector2f, Eigen::Vector2f>>;

/// The strokes of 'a' .. 'z' or '_' in a box 4 wide, y up: the base line at 0, small letters 4 high, tall
/// ones 6, tails down to -2. Adds nothing for any other character.
void letter_strokes(char letter, Strokes& lines);

/// From one letter's left edge to the next one's; 0 for what letter_strokes() does not know.
[[nodiscard]] float letter_advance(char letter);

}  // namespace phalanx::picture
