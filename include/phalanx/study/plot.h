// SPDX-License-Identifier: Apache-2.0
// Curves of a run as an SVG that can go into a paper as it is.
#pragma once

#include <string>

#include "phalanx/study/trace.h"

namespace phalanx {

/// One line each; what is too long for the width is cut with an ellipsis.
struct PlotText {
  std::string title;       ///< bold
  std::string subtitle;    ///< what the scene is
  std::string parameters;  ///< law, smoothing, limits, rate
};

/// Three panels over one time axis, 180 mm wide: forces [N] of the segments that touched (law dashed, sent
/// solid), torques [Nm] of the joints that carried any, angles [deg] of the joints that moved most (measured,
/// HCP, dashed; shown, GDP, solid). Of more than eight (angles: six) curves the largest are drawn and the
/// legend says so. Long runs are thinned to what the width can show, keeping every extreme value.
/// @throws std::invalid_argument if `trace` is empty.
[[nodiscard]] std::string plot_svg(const Trace& trace, const PlotText& text);

}  // namespace phalanx
