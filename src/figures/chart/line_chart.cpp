// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "figures/chart/axis.h"
#include "figures/chart/line_panel.h"
#include "figures/chart/svg.h"
#include "phalanx/figures/chart.h"

namespace phalanx {
namespace {

constexpr double kChartWidth = 180.0 * kPointsPerMm;
constexpr double kChartLeft = 46.0;
constexpr double kChartRight = 14.0;

void check(const LineChart& chart) {
  if (chart.panels.empty()) throw std::invalid_argument("line chart: no panel; give at least one");
  for (const ChartPanel& panel : chart.panels) {
    for (const ChartSeries& series : panel.series) {
      const std::size_t size = series.x.size();
      const bool band = !series.low.empty() || !series.high.empty();
      if (series.y.size() != size || (band && (series.low.size() != size || series.high.size() != size)) ||
          (!series.at_least.empty() && series.at_least.size() != size) ||
          (!series.companion.empty() && series.companion.size() != size))
        throw std::invalid_argument(
            fmt::format("line chart: series '{}': x has {} values; y, low, high, at_least and companion must "
                        "have as many "
                        "(the last four may be empty)",
                        series.name, size));
    }
  }
}

bool has_legend(const LineChart& chart) {
  return std::any_of(chart.panels.begin(), chart.panels.end(),
                     [](const ChartPanel& panel) { return legend_height(panel) > 0.0; });
}

SharedAxis shared_axis(const LineChart& chart) {
  Range values;
  values.include(chart.x_covers);
  bool marked = true;
  for (const ChartPanel& panel : chart.panels) {
    for (const ChartSeries& series : panel.series) {
      marked = marked && series.x.size() <= kMarkedPoints;
      values.include(series.x);
    }
  }
  auto [low, high] = values.for_axis();
  if (values.low == values.high) low -= high - low;  // the only value in the middle
  // Markers on the first and the last value need room inside the frame.
  const double margin = marked ? 0.025 * (high - low) : 0.0;
  SharedAxis axis{
      .left = kChartLeft,
      .width = kChartWidth - kChartLeft - (has_legend(chart) ? kLegendGap + kLegendWidth : kChartRight),
      .low = low - margin,
      .high = high + margin,
      .ticks = {}};
  for (const double tick : nice_ticks(low, high, 8)) {
    const double rounding = 1e-9 * (high - low);
    if (tick >= axis.low - rounding && tick <= axis.high + rounding) axis.ticks.push_back(tick);
  }
  return axis;
}

}  // namespace

std::string line_chart_svg(const LineChart& chart) {
  check(chart);
  Svg svg(kChartWidth);
  const SharedAxis axis = shared_axis(chart);
  double y = svg.heading(chart.title, chart.subtitles);
  double bottom = y;
  for (std::size_t i = 0; i < chart.panels.size(); ++i) {
    const ChartPanel& panel = chart.panels[i];
    y += i == 0 && !chart.windows.empty() ? 24.0 : 18.0;
    draw_line_panel(svg, chart, i, axis, y, panel.height);
    const double legend_end = y + legend_height(panel);
    y += panel.height;
    bottom = std::max({bottom, y, legend_end});
    // A long legend may extend below its panel only if the next panel has none.
    if (i + 1 < chart.panels.size() && chart.panels[i + 1].legend) y = std::max(y, legend_end);
  }
  svg.text(axis.left + axis.width / 2, y + 25, cut_to(chart.x_label, axis.width + 40), Anchor::kMiddle);
  return svg.document(std::max(bottom + 6, y + 31), chart.title);
}

}  // namespace phalanx
