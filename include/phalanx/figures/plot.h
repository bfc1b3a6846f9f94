// SPDX-License-Identifier: Apache-2.0
// Curves of a run as an SVG figure, ready for a paper.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "phalanx/step/snapshot.h"

namespace phalanx {

/// Values of one tick that a plot needs.
struct TraceTick {
  double time_s = 0.0;
  std::array<double, kSegments> force_raw{};  ///< of the force law, on each segment [N]
  std::array<double, kSegments> force{};      ///< sent, on each segment [N]
  JointArray torque{};                        ///< [Nm]
  JointArray hcp_angle{};                     ///< [rad]
  JointArray gdp_angle{};                     ///< [rad]
  AngleOrigins angle_origin{};                ///< of hcp_angle
};

/// Curves of a run, in the order of its ticks. They grow by 0.8 kB a tick. Not real-time.
using Trace = std::vector<TraceTick>;

/// Copies from a snapshot what a plot needs.
[[nodiscard]] TraceTick trace_tick(const Snapshot& snapshot);

/// Text of a plot, one line each; a line that is too long for the width is cut with an ellipsis.
struct PlotText {
  std::string title;       ///< bold
  std::string subtitle;    ///< the scene
  std::string parameters;  ///< law, smoothing, limits, rate
};

/// Draws three panels over one time axis, 180 mm wide:
///   forces [N]     of the segments that touched (law dashed, sent solid)
///   torques [Nm]   of the joints that carried any
///   angles [deg]   of the joints that moved most (measured, HCP, dashed; displayed, GDP, solid). The legend
///                  marks joints that are completed, by the origin in the last tick.
/// Of more than eight curves (angles: six), the largest are drawn and the legend states it. Long runs are
/// thinned to the resolution of the width, keeping every extreme value.
/// @throws std::invalid_argument if `trace` is empty.
[[nodiscard]] std::string plot_svg(const Trace& trace, const PlotText& text);

}  // namespace phalanx
