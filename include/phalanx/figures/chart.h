// SPDX-License-Identifier: Apache-2.0
// Charts as SVG: curves, bars, heat maps and stability maps, ready for a paper.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace phalanx {

// Every function below returns a whole SVG document, 180 mm wide unless stated otherwise. It depends on its
// argument alone: equal numbers give equal bytes. Text is UTF-8 and may contain anything: it is escaped, and
// cut with an ellipsis if it is too long. Colour-blind readers can distinguish the colours, and shape or
// hatching repeats the information. Not real-time.

/// One curve. The line has a gap where x or y is not finite.
struct ChartSeries {
  std::string name;
  std::vector<double> x;     ///< increasing, in the unit that LineChart::x_label names
  std::vector<double> y;     ///< one for each x, in the unit that ChartPanel::y_label names
  std::vector<double> low;   ///< lower edge of a shaded band, one for each x; or empty
  std::vector<double> high;  ///< upper edge; as many as `low`
  std::vector<bool> at_least =
      {};  ///< one for each x, or empty: the true value may be higher; drawn as an arrow upwards
  std::vector<double> companion = {};  ///< one for each x, or empty: a dashed curve in the same colour
};

/// A horizontal line with a label: "paper: 0.7".
struct ChartMark {
  double y = 0.0;
  std::string label;
};

/// A shaded range of the x axis, in all panels: a bump, or a window of evaluation.
struct ChartWindow {
  double from = 0.0;
  double to = 0.0;
  std::string label;  ///< drawn in the topmost panel
};

/// One set of axes. The y axis covers everything that is drawn, but for cut companions.
struct ChartPanel {
  std::string title;
  std::string y_label;  ///< with the unit: "force [N]"
  std::vector<ChartSeries> series;
  std::vector<ChartMark> marks;
  bool from_zero = true;  ///< the y axis includes 0
  /// Height of the frame in points (1/72 inch). The next panel begins lower if the legend needs more.
  double height = 120.0;
  bool legend = true;             ///< false: the panel above has the same curves
  std::string solid_means = {};   ///< legend's text for the curves; used if there are companions
  std::string dashed_means = {};  ///< legend's text for the companions
  /// The y axis follows the curves if the companions reach more than 2.5 times as high. These are then cut at
  /// the frame, and the legend states how high they reach.
  bool clip_companions = false;
  std::string note = {};           ///< last line of the legend: "8 of 14 shown"
  std::string empty = "no value";  ///< text in the middle if no value is finite
};

/// Panels over one x axis. S2 fig. 4: force and position over time; S2 fig. 5: one curve a phalanx.
struct LineChart {
  std::string title;
  std::vector<std::string> subtitles;  ///< one line each
  std::string x_label;                 ///< with the unit: "time [s]"
  std::vector<ChartPanel> panels;
  std::vector<ChartWindow> windows;
  std::vector<double> x_covers = {};  ///< x that the axis covers beside those of the curves
};

inline constexpr std::size_t kCurveColours = 8;                ///< that readers can tell apart
inline constexpr std::size_t kMostSeries = 3 * kCurveColours;  ///< in a panel: three kinds of line

/// Draws curves. Curves of up to 40 points have a marker on each; longer ones have a few, none at y = 0. They
/// are thinned to the resolution of the width, keeping every extreme value. Of more than kMostSeries curves in
/// a panel, the first are drawn and the legend states the number.
/// @throws std::invalid_argument if there is no panel, or the parts of a series differ in length.
[[nodiscard]] std::string line_chart_svg(const LineChart& chart);

/// Values of one quantity over two lists, as rows and columns.
struct HeatMap {
  std::string title;
  std::string quantity;  ///< label of the colour scale, with the unit: "k_lim [N/mm]"
  std::string x_label;
  std::string y_label;
  std::vector<std::string> columns;  ///< from the left
  std::vector<std::string> rows;     ///< from the top
  std::vector<double> value;         ///< row after row, rows x columns; a value that is not finite is hatched
  std::vector<bool> at_least = {};   ///< as `value`, or empty: the true value may be higher; written with >=
  std::optional<double> low = {};    ///< end of the colour scale; none: of the values
  std::optional<double> high = {};   ///< end of the colour scale; none: of the values
  double width_mm = 180.0;
};

/// Draws a map from dark blue (low) to yellow (high) with uniformly increasing lightness. Each cell that has
/// room shows its number.
/// @throws std::invalid_argument if `value` or `at_least` is not rows x columns long.
[[nodiscard]] std::string heat_map_svg(const HeatMap& map);

/// Result for a stiffness. kSomeStable: the seeds that ran are stable, and others did not run.
enum class CellVerdict { kNotChecked, kStable, kSomeStable, kUnstable, kInvalid };

/// Stability over stiffness (upwards) for several points beside each other.
struct VerdictMap {
  struct Column {
    std::string name;
    std::vector<CellVerdict> cell;                            ///< one for each stiffness
    double k_lim = std::numeric_limits<double>::quiet_NaN();  ///< [N/mm]; 0: below the grid; NaN: none
    bool at_least = false;
  };
  std::string title;
  std::string x_label;
  std::vector<double> stiffness;  ///< the grid, rising [N/mm]
  std::vector<Column> columns;
  double width_mm = 180.0;
};

/// Draws a stability map.
/// @throws std::invalid_argument if a column does not have as many cells as there are stiffnesses.
[[nodiscard]] std::string verdict_map_svg(const VerdictMap& map);

/// Bars of several quantities for the same list of names, side by side.
struct BarChart {
  struct Quantity {
    std::string label;          ///< with the unit
    std::vector<double> value;  ///< one for each name, >= 0; NaN: none
    std::vector<bool> at_least = {};
  };
  std::string title;
  std::vector<std::string> names;  ///< from the top
  std::vector<Quantity> quantities;
};

/// Draws horizontal bars with their numbers, each quantity on its own scale from 0.
/// @throws std::invalid_argument if a quantity does not have as many values as there are names.
[[nodiscard]] std::string bar_chart_svg(const BarChart& chart);

}  // namespace phalanx
