// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace phalanx {

/// How curve number `index` of a panel is told from the others, also by colour-blind readers and on a grey
/// copy.
struct CurveStyle {
  const char* colour;  ///< #RRGGBB
  const char* marker;  ///< path around the origin
  const char* dashes;  ///< of stroke-dasharray; "none"
};
/// Eight colours, each with its marker; from the ninth curve on dashed, from the 17th on dotted, then from
/// the beginning.
[[nodiscard]] CurveStyle curve_style(std::size_t index) noexcept;

struct ScaleColour {
  std::string fill;  ///< #RRGGBB
  const char* text;  ///< readable upon it
};
/// Colour for `share` of a scale, 0 (dark blue) to 1 (yellow); what is outside is clamped. In CIE L*a*b* the
/// lightness rises evenly from 20 to 90 and the hue turns evenly, so that equal steps of the value look like
/// equal steps.
[[nodiscard]] ScaleColour scale_colour(double share);

}  // namespace phalanx
