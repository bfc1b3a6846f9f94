// SPDX-License-Identifier: Apache-2.0
// One panel of a line chart.
#pragma once

#include <string>
#include <vector>

#include "figures/chart/axis.h"
#include "figures/chart/svg.h"
#include "phalanx/figures/chart.h"

namespace phalanx {

/// The x axis that all panels of a chart share.
struct SharedAxis {
  double left, width;  ///< of the frame [pt]
  double low, high;    ///< in the unit of x
  std::vector<double> ticks;
  [[nodiscard]] double at(double x) const { return left + width * (drawable(x) - low) / (high - low); }
};

inline constexpr std::size_t kMarkedPoints = 40;  ///< a curve with at most this many points has a
                                                  ///< marker on each

inline constexpr double kLegendGap = 12.0;     ///< from the frame to the legend [pt]
inline constexpr double kLegendWidth = 126.0;  ///< [pt]

/// @returns the height of the panel's legend [pt]; 0 if it has none.
[[nodiscard]] double legend_height(const ChartPanel& panel);

/// Draws panel `index` of the chart into the frame whose upper edge is at `top`. The first panel names the
/// windows; the last one has the numbers of the x axis.
void draw_line_panel(Svg& svg, const LineChart& chart, std::size_t index, const SharedAxis& axis, double top,
                     double height);

}  // namespace phalanx
