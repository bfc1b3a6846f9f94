// SPDX-License-Identifier: Apache-2.0
// Lines, letters and the colour scale over a rendered image.
#pragma once

#include <string_view>
#include <vector>

#include "figures/picture/render_mesh.h"

namespace phalanx::picture {

/// Image in linear-light colours, rows from top to bottom.
struct Canvas {
  int width;
  int height;
  std::vector<Vec3f> pixel;
};

/// @returns a segment's colour at `share` (0..1) of the full force: bone, gold, vermilion.
[[nodiscard]] Vec3f force_colour(float share);

/// Draws a round-ended stroke of full `width` [pixels], anti-aliased.
void draw_stroke(Canvas& canvas, const Eigen::Vector2f& a, const Eigen::Vector2f& b, float width,
                 const Vec3f& colour);

/// Draws digits, small letters, '_', '.', ' ' and the letter N as strokes. (x, y) is the left end of the base
/// line, and `size` is a digit's height [pixels].
/// @returns the text's width
float draw_text(Canvas& canvas, float x, float y, float size, std::string_view text, const Vec3f& colour);

/// Draws a vertical bar at the left edge from 0 to `full_force` [N].
void draw_force_scale(Canvas& canvas, double full_force);

}  // namespace phalanx::picture
