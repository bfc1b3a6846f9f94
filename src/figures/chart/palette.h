// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace phalanx {

/// Style of a curve. Curves can be told apart also by colour-blind readers and on a grey copy.
struct CurveStyle {
  const char* colour;  ///< #RRGGBB
  const char* marker;  ///< path around the origin
  const char* dashes;  ///< value of stroke-dasharray; "none": solid
};
/// @returns the style of curve number `index` of a panel: eight colours, each with its marker. From the ninth
/// curve on it is dashed, from the 17th on dotted; then the styles repeat.
[[nodiscard]] CurveStyle curve_style(std::size_t index) noexcept;

/// Colour of a scale, and of text on it.
struct ScaleColour {
  std::string fill;  ///< #RRGGBB
  const char* text;  ///< readable on `fill`
};
/// @returns the colour for `share` of a scale, 0 (dark blue) to 1 (yellow), clamped outside. In CIE L*a*b*,
/// lightness rises uniformly from 20 to 90 and the hue turns uniformly. Equal steps of the value
/// therefore look equal.
[[nodiscard]] ScaleColour scale_colour(double share);

}  // namespace phalanx
