// SPDX-License-Identifier: Apache-2.0
// Small letters as strokes, for labels. Internal to src/figures/picture.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace phalanx::picture {

using Strokes = std::vector<std::pair<Eigen::Vector2f, Eigen::Vector2f>>;

/// Adds the strokes of 'a' .. 'z' or '_' in a box 4 wide, y up. The base line is at 0, small letters are 4
/// high, tall ones 6, and tails go down to -2. It adds nothing for any other character.
void letter_strokes(char letter, Strokes& lines);

/// @returns the distance from one letter's left edge to the next one's; 0 for a character without strokes.
[[nodiscard]] float letter_advance(char letter);

}  // namespace phalanx::picture
