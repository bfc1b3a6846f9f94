// SPDX-License-Identifier: Apache-2.0
// Curves of a run as an SVG figure, ready for a paper.
#pragma once

#include <string>

#include "phalanx/figures/trace.h"

namespace phalanx {

/// Text of a plot, one line each; a line that is too long for the width is cut with an ellipsis.
struct PlotText {
  std::string title;       ///< bold
  std::string subtitle;    ///< the scene
  std::string parameters;  ///< law, smoothing, limits, rate
};

/// Draws three panels over one time axis, 180 mm wide:
///   forces [N]     of the segments that touched (law dashed, sent solid)
///   torques [Nm]   of the joints that carried any
///   angles [deg]   of the joints that moved most (measured, HCP, dashed; displayed, GDP, solid)
/// Of more than eight curves (angles: six), the largest are drawn and the legend states it. Long runs are
/// thinned to the resolution of the width, keeping every extreme value.
/// @throws std::invalid_argument if `trace` is empty.
[[nodiscard]] std::string plot_svg(const Trace& trace, const PlotText& text);

}  // namespace phalanx
