// SPDX-License-Identifier: Apache-2.0
#include "study/report/study_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figures/chart/axis.h"
#include "phalanx/figures/chart.h"

namespace phalanx {
namespace {

constexpr std::size_t kMostSlices = 12;      // heat maps of a quantity
constexpr std::size_t kMostCells = 200'000;  // of all maps of a page
constexpr std::size_t kMostBars = 60;
constexpr std::size_t kMostBands = 3;         // more bands hide each other
constexpr std::size_t kColumnsOfHalfMap = 7;  // up to here two maps fit beside each other
constexpr double kHalfWidth = 88.0;           // [mm]
constexpr double kFullWidth = 180.0;

const Dimension& at(const StudyView& view, int dimension) {
  return view.dimensions()[static_cast<std::size_t>(dimension)];
}

double value_of(const PointResult* result, double (*value)(const PointResult&)) {
  return result == nullptr ? PointResult::kNone : value(*result);
}

bool at_least(const PointResult* result, const Quantity& quantity) {
  return is_k_lim(quantity) && result != nullptr && result->at_least;
}

ChartSeries curve(const StudyView& view, const Dimension& axis, const Slice& slice, const Quantity& quantity,
                  bool band) {
  ChartSeries series{.name = slice.text, .x = {}, .y = {}, .low = {}, .high = {}};
  for (const std::size_t i : axis.order) {
    const PointResult* result = view.result(slice.offset + static_cast<int>(i) * axis.stride);
    series.x.push_back(axis.numbers[i]);
    series.y.push_back(value_of(result, quantity.value));
    series.at_least.push_back(at_least(result, quantity));
    if (!band || quantity.largest == nullptr) continue;
    series.low.push_back(series.y.back());
    series.high.push_back(value_of(result, quantity.largest));
  }
  return series;
}

/// Makes charts of about three panels each, so that a figure fits on a page.
std::vector<std::string> curve_charts(const StudyView& view, const Dimension& axis,
                                      const std::vector<Slice>& slices) {
  const std::vector<Quantity> quantities = view.quantities();
  const bool bands = slices.size() <= kMostBands;
  const std::size_t first_half = quantities.size() - 4;
  std::vector<std::string> charts;
  LineChart chart{.title = "", .subtitles = {}, .x_label = axis.label, .panels = {}, .windows = {}};
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    ChartPanel panel{.title = quantities[q].label(),
                     .y_label = quantities[q].unit,
                     .series = {},
                     .marks = {},
                     .height = 96.0,
                     .legend = chart.panels.empty()};
    for (const Slice& slice : slices) panel.series.push_back(curve(view, axis, slice, quantities[q], bands));
    if (std::isfinite(quantities[q].criterion))
      panel.marks.push_back({quantities[q].criterion, "stable up to here"});
    chart.panels.push_back(std::move(panel));
    if (q + 1 != first_half && q + 1 != quantities.size()) continue;
    charts.push_back(line_chart_svg(chart));
    chart.panels.clear();
  }
  return charts;
}

void add_curves(HtmlPage& page, const StudyView& view, int axis) {
  const std::vector<Slice> slices = view.slices({axis});
  page.heading(fmt::format("Over {}", at(view, axis).label));
  if (slices.size() > kMostSeries) {
    page.paragraph(
        fmt::format("{} curves would be too many to tell apart; study.csv has the numbers.", slices.size()));
    return;
  }
  page.figures(
      curve_charts(view, at(view, axis), slices),
      slices.size() <= kMostBands
          ? "Ghost time and energy: the line is the mean over the seeds, the band reaches to the largest."
          : "Ghost time and energy: mean over the seeds.");
}

struct Plane {
  int columns, rows;  // dimensions
};

HeatMap heat_map(const StudyView& view, const Plane& plane, const Slice& slice, const Quantity& quantity) {
  const Dimension& columns = at(view, plane.columns);
  const Dimension& rows = at(view, plane.rows);
  HeatMap map;
  map.quantity = quantity.label();
  map.x_label = columns.label;
  map.y_label = rows.label;
  map.width_mm = columns.names.size() <= kColumnsOfHalfMap ? kHalfWidth : kFullWidth;
  std::vector<std::size_t> downwards = rows.order;
  if (!rows.numbers.empty()) std::reverse(downwards.begin(), downwards.end());  // numbers increase upwards
  for (const std::size_t column : columns.order) map.columns.push_back(columns.names[column]);
  for (const std::size_t row : downwards) {
    map.rows.push_back(rows.names[row]);
    for (const std::size_t column : columns.order) {
      const PointResult* result = view.result(slice.offset + static_cast<int>(row) * rows.stride +
                                              static_cast<int>(column) * columns.stride);
      map.value.push_back(value_of(result, quantity.value));
      map.at_least.push_back(at_least(result, quantity));
    }
  }
  return map;
}

/// Draws maps on one colour scale, so that they can be compared.
std::vector<std::string> on_one_scale(std::vector<HeatMap> maps) {
  Range scale;
  for (const HeatMap& map : maps) scale.include(map.value);
  std::vector<std::string> svgs;
  for (HeatMap& map : maps) {
    if (!scale.empty()) {
      map.low = scale.low;
      map.high = scale.high;
    }
    svgs.push_back(heat_map_svg(map));
  }
  return svgs;
}

void add_heat_maps(HtmlPage& page, const StudyView& view, const Plane& plane) {
  std::vector<Slice> slices = view.slices({plane.columns, plane.rows});
  const std::size_t all = slices.size();
  page.heading(fmt::format("Over {} and {}", at(view, plane.columns).label, at(view, plane.rows).label));
  const std::size_t columns = at(view, plane.columns).names.size();
  const std::size_t rows = at(view, plane.rows).names.size();
  const std::size_t drawn = std::min(kMostSlices, kMostCells / (columns * rows * view.quantities().size()));
  if (drawn == 0) {
    page.paragraph(fmt::format(
        "Maps of {} by {} cells would be too large for a page; study.csv has the numbers.", columns, rows));
    return;
  }
  if (all > drawn) {
    slices.resize(drawn);
    page.paragraph(
        fmt::format("Maps of {} of {} combinations of the other settings are drawn; {} are left out here; "
                    "study.csv has their numbers.",
                    drawn, all, all - drawn));
  }
  std::vector<std::string> of_one_slice;
  for (const Quantity& quantity : view.quantities()) {
    std::vector<HeatMap> maps;
    for (const Slice& slice : slices) {
      maps.push_back(heat_map(view, plane, slice, quantity));
      maps.back().title = slices.size() > 1 ? slice.text : quantity.label();
    }
    const std::vector<std::string> svgs = on_one_scale(std::move(maps));
    if (slices.size() == 1) {
      of_one_slice.push_back(svgs.front());
      continue;
    }
    page.subheading(quantity.label());
    page.figures(svgs, "");
  }
  page.figures(of_one_slice, "");
}

void add_bars(HtmlPage& page, const StudyView& view) {
  const Dimension& dimension = view.dimensions().front();
  page.heading(fmt::format("By {}", dimension.label));
  if (dimension.names.size() > kMostBars) {
    page.paragraph(fmt::format("{} bars would be too many; the table has them.", dimension.names.size()));
    return;
  }
  const std::vector<Quantity> quantities = view.quantities();
  const std::size_t first_half = quantities.size() - 4;
  std::vector<std::string> charts;
  BarChart chart{.title = "", .names = dimension.names, .quantities = {}};
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    BarChart::Quantity bars{.label = quantities[q].label(), .value = {}};
    for (std::size_t i = 0; i < dimension.names.size(); ++i) {
      const PointResult* result = view.result(static_cast<int>(i) * dimension.stride);
      bars.value.push_back(value_of(result, quantities[q].value));
      bars.at_least.push_back(at_least(result, quantities[q]));
    }
    chart.quantities.push_back(std::move(bars));
    if (q + 1 != first_half && q + 1 != quantities.size()) continue;
    charts.push_back(bar_chart_svg(chart));
    chart.quantities.clear();
  }
  page.figures(charts, "Ghost time and energy: mean over the seeds.");
}

/// Chooses the first two axes; if there is one axis, without numbers, that one and the variants. Numbers go
/// along the bottom.
Plane plane_of(const StudyView& view) {
  std::vector<int> axes;
  for (std::size_t d = 0; d < view.dimensions().size(); ++d) {
    if (!view.dimensions()[d].variants) axes.push_back(static_cast<int>(d));
  }
  if (axes.size() == 1) return {axes[0], 0};
  const bool swap = at(view, axes[0]).numbers.empty() && !at(view, axes[1]).numbers.empty();
  return swap ? Plane{axes[1], axes[0]} : Plane{axes[0], axes[1]};
}

}  // namespace

void add_result_pictures(HtmlPage& page, const StudyView& view) {
  const std::vector<Dimension>& dimensions = view.dimensions();
  if (dimensions.empty()) return;  // one point: the table shows everything
  const int axis = view.main_axis();
  if (axis >= 0) add_curves(page, view, axis);
  const std::size_t axes = dimensions.size() - (dimensions.front().variants ? 1 : 0);
  if (axes >= 2 || (axes == 1 && axis < 0 && dimensions.size() == 2)) {
    add_heat_maps(page, view, plane_of(view));
  } else if (axis < 0) {
    add_bars(page, view);
  }
}

}  // namespace phalanx
