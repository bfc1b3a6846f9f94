// SPDX-License-Identifier: Apache-2.0
// One panel of a plot: axes, grid, curves, and a legend to its right. Lengths are in points (1/72 inch).
#pragma once

#include <string>
#include <vector>

namespace phalanx {

/// A curve, perhaps with a dashed companion.
struct Curve {
  std::string label;
  std::vector<double> solid;   ///< one value for each time
  std::vector<double> dashed;  ///< one value for each time, or empty
};

/// Content of a panel.
struct Panel {
  std::string title;
  std::string y_label;
  std::string solid_means;  ///< legend text for solid lines, used only if there are dashed curves
  std::string dashed_means;
  std::string note;   ///< last line of the legend: "8 of 14 shown"
  std::string empty;  ///< text in the middle if there are no curves
  std::vector<Curve> curves;
  bool clip_dashed = false;  ///< scale to the solid curves if the dashed ones are much larger
};

/// Geometry and time axis of a panel.
struct PanelFrame {
  double x, y, width, height;
  double legend_x;
  double time_low, time_high;
  std::vector<double> time_ticks;
  bool time_labels;  ///< draw numbers under the axis
};

inline constexpr std::size_t kMostCurves = 8;  ///< the number of colours

/// Draws the panel as SVG elements. `clip_id` names its clip path in the document.
[[nodiscard]] std::string draw_panel(const Panel& panel, const PanelFrame& frame,
                                     const std::vector<double>& time, const std::string& clip_id);

/// @returns `text` with &, <, > and " as entities; control characters become spaces.
[[nodiscard]] std::string xml_escaped(const std::string& text);

}  // namespace phalanx
