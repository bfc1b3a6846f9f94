// SPDX-License-Identifier: Apache-2.0
// Pictures of numbers as SVG: curves, bars, heat maps and stability maps, in a form that can go into a paper
// as it is.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace phalanx {

// Every function below gives a whole SVG document, 180 mm wide unless said otherwise, which depends on its
// argument alone: the same bytes for the same numbers. Text is UTF-8 and may hold anything: it is escaped,
// and cut with an ellipsis where it is too long. Colours are told apart by colour-blind readers, and shape or
// hatching repeats what they say. Not real-time.

/// One curve. Where x or y is not finite the line has a gap.
struct ChartSeries {
  std::string name;
  std::vector<double> x;     ///< rising, in the unit that LineChart::x_label names
  std::vector<double> y;     ///< as many, in the unit that ChartPanel::y_label names
  std::vector<double> low;   ///< lower edge of a shaded band, one for each x; or empty
  std::vector<double> high;  ///< upper edge; as many as `low`
  std::vector<bool> at_least =
      {};  ///< one for each x, or empty: the true value may be higher; drawn as an arrow upwards
  bool dashed = false;
};

/// A horizontal line with words: "paper: 0.7".
struct ChartMark {
  double y = 0.0;
  std::string label;
};

/// A shaded stretch of the x axis, in all panels: a bump, a window of evaluation.
struct ChartWindow {
  double from = 0.0;
  double to = 0.0;
  std::string label;  ///< in the topmost panel
};

/// One set of axes. The y axis runs over everything that is drawn.
struct ChartPanel {
  std::string title;
  std::string y_label;  ///< with the unit: "force [N]"
  std::vector<ChartSeries> series;
  std::vector<ChartMark> marks;
  bool from_zero = true;  ///< the y axis includes 0
  double height = 120.0;  ///< of the frame, in points (1/72 inch); more if its legend needs more
  bool legend = true;     ///< off: the panel above has the same curves
};

/// Panels over one x axis. S2 fig. 4: force and position over time; S2 fig. 5: one curve a phalanx.
struct LineChart {
  std::string title;
  std::string subtitle;
  std::string x_label;  ///< with the unit: "time [s]"
  std::vector<ChartPanel> panels;
  std::vector<ChartWindow> windows;
};

inline constexpr std::size_t kMostSeries = 24;  ///< in a panel: eight colours, three kinds of line

/// Curves. Up to 40 points a curve each have a marker; longer curves have a few, and are thinned to what the
/// width can show, keeping every extreme value. Of more than kMostSeries curves in a panel the first are
/// drawn and the legend says how many.
/// @throws std::invalid_argument if there is no panel, or the parts of a series differ in length.
[[nodiscard]] std::string line_chart_svg(const LineChart& chart);

/// Values of one quantity at the crossings of two lists.
struct HeatMap {
  std::string title;
  std::string quantity;  ///< beside the colour scale, with the unit: "k_lim [N/mm]"
  std::string x_label;
  std::string y_label;
  std::vector<std::string> columns;  ///< from the left
  std::vector<std::string> rows;     ///< from the top
  std::vector<double> value;         ///< row after row, rows x columns; what is not finite is hatched
  std::vector<bool> at_least = {};   ///< as `value`, or empty: the true value may be higher; written with >=
  std::optional<double> low = {};    ///< ends of the colour scale; without: of the values
  std::optional<double> high = {};
  double width_mm = 180.0;
};

/// A map from dark blue (low) to yellow (high), its lightness rising evenly; the number in every cell that
/// has room.
/// @throws std::invalid_argument if `value` or `at_least` is not rows x columns long.
[[nodiscard]] std::string heat_map_svg(const HeatMap& map);

/// What was found out about a stiffness.
enum class CellVerdict { kNotChecked, kStable, kUnstable, kInvalid };

/// Stability over stiffness (upwards) for a number of points beside each other.
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

/// Horizontal bars with their numbers, each quantity on its own scale from 0.
/// @throws std::invalid_argument if a quantity does not have as many values as there are names.
[[nodiscard]] std::string bar_chart_svg(const BarChart& chart);

}  // namespace phalanx
