// SPDX-License-Identifier: Apache-2.0
// One panel of a plot: axes, grid, curves, and a legend to its right. Lengths in points (1/72 inch).
#pragma once

#include <string>
#include <vector>

namespace phalanx {

struct Curve {
  std::string label;
  std::vector<double> solid;   ///< one value per time
  std::vector<double> dashed;  ///< the same, or empty
};

struct Panel {
  std::string title;
  std::string y_label;
  std::string solid_means;  ///< legend line for solid, only if there are dashed curves
  std::string dashed_means;
  std::string note;   ///< last line of the legend: "8 of 14 shown"
  std::string empty;  ///< said in the middle if there are no curves
  std::vector<Curve> curves;
  bool clip_dashed = false;  ///< scale to the solid curves where the dashed ones would dwarf them
};

struct PanelFrame {
  double x, y, width, height;
  double legend_x;
  double time_low, time_high;
  std::vector<double> time_ticks;
  bool time_labels;  ///< numbers under the axis
};

inline constexpr std::size_t kMostCurves = 8;  ///< as many as there are colours

/// SVG elements of the panel. `clip_id` names its clip path in the document.
[[nodiscard]] std::string draw_panel(const Panel& panel, const PanelFrame& frame,
                                     const std::vector<double>& time, const std::string& clip_id);

/// `text` with &, <, > and " as entities; control characters become spaces.
[[nodiscard]] std::string xml_escaped(const std::string& text);

}  // namespace phalanx
