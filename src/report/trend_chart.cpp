// SPDX-License-Identifier: Apache-2.0
#include "report/trend_chart.h"

#include <fmt/format.h>

#include <algorithm>

#include "phalanx/core/xml_text.h"
#include "report/chart_frame.h"
#include "report/date_axis.h"
#include "report/report_words.h"

namespace phalanx::report {
namespace {

constexpr std::size_t kManyPoints = 40;

/// @returns the range of values and band, with a margin
Range shown_range(const Trend& trend) {
  Range range;
  for (const TrendPoint& point : trend.points) range.include(point.value);
  if (trend.smallest_real_difference) {
    range.include(trend.points.front().value - *trend.smallest_real_difference);
    range.include(trend.points.front().value + *trend.smallest_real_difference);
  }
  range = range.for_axis();
  const double margin = 0.08 * (range.high - range.low);
  return {.low = range.low - margin, .high = range.high + margin};
}

void draw_band(Svg& svg, const ChartFrame& frame, double first, double difference) {
  const double top = frame.y(first + difference);
  svg.add(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="{}"/>)", frame.left, top,
          frame.right - frame.left, frame.y(first - difference) - top, kBandFill);
  svg.add(R"(<path d="M{:.1f},{:.1f}H{:.1f}" stroke="{}" stroke-width="0.6" stroke-dasharray="2 2"/>)",
          frame.left, frame.y(first), frame.right, kInk);
}

void draw_points(Svg& svg, const ChartFrame& frame, const Trend& trend, ReportLanguage language) {
  const bool many = trend.points.size() > kManyPoints;
  for (const TrendPoint& point : trend.points)
    svg.add(
        R"(<circle cx="{:.1f}" cy="{:.1f}" r="{}" fill="{}" stroke="#fff" stroke-width="{}" data-score="{}" data-date="{}" data-value="{}" data-unit="{}" data-recording="{}"><title>{}: {}</title></circle>)",
        frame.x(point.date), frame.y(point.value), many ? "1.3" : "2.1", kInk, many ? "0.3" : "0.6",
        xml_escaped(trend.name), exact_text(point.date), exact_text(point.value), xml_escaped(trend.unit),
        xml_escaped(point.recording), day_label(point.date, language),
        xml_escaped(value_label(point.value, trend.unit, language)));
}

}  // namespace

std::string trend_chart(const Trend& trend, const std::string& title, const DateSpan& span,
                        const ChartSize& size, ReportLanguage language) {
  const double width = size.width_mm * kPointsPerMm;
  const double height = size.height_mm * kPointsPerMm;
  const Range range = shown_range(trend);
  const std::vector<double> ticks = nice_ticks(range.low, range.high, 5);
  const std::vector<std::string> labels = tick_labels(ticks, language);
  ChartFrame frame{.left = 6.0 + 0.87 * text_width(labels),
                   .right = width - 30.0,
                   .top = 6.0,
                   .bottom = height - 13.0,
                   .span = span,
                   .low = range.low,
                   .high = range.high};
  Svg svg(width);
  if (trend.smallest_real_difference)
    draw_band(svg, frame, trend.points.front().value, *trend.smallest_real_difference);
  draw_value_ticks(svg, frame, ticks, labels);
  draw_date_ticks(svg, frame, language);
  std::vector<double> xs;
  std::vector<double> ys;
  for (const TrendPoint& point : trend.points) {
    xs.push_back(frame.x(point.date));
    ys.push_back(frame.y(point.value));
  }
  draw_line(svg, xs, ys, kInk);
  draw_points(svg, frame, trend, language);
  svg.text(std::min(xs.back() + 4.5, frame.right + 4.0), ys.back() + 2.6,
           number_label(trend.points.back().value, language), Anchor::kStart,
           fmt::format(R"( font-size="7.5" font-weight="bold" fill="{}")", kInk));
  return embedded_svg(svg, height, title);
}

}  // namespace phalanx::report
