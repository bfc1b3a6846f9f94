// SPDX-License-Identifier: Apache-2.0
// Frame of the report's charts: dates from left to right, a number upwards. Lengths are in points.
#pragma once

#include <string>
#include <vector>

#include "figures/chart/axis.h"
#include "figures/chart/svg.h"
#include "report/trend_chart.h"

namespace phalanx::report {

/// Colours of all charts. The blue and the vermilion are of Okabe and Ito's palette, which colour-blind readers
/// can tell apart; shape and text repeat what a colour states.
inline constexpr const char* kInk = "#0b5d8f";
inline constexpr const char* kSecondInk = "#c2500a";
inline constexpr const char* kBandFill = "#e2eef5";
inline constexpr const char* kGridInk = "#dde3e8";
inline constexpr const char* kLabelInk = "#5b6770";

/// Frame with two scales.
struct ChartFrame {
  double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;  ///< edges [pt]
  DateSpan span = {};
  double low = 0.0, high = 1.0;  ///< of the number

  [[nodiscard]] double x(double utc) const {
    return left + (right - left) * (utc - span.from) / (span.to - span.from);
  }
  [[nodiscard]] double y(double value) const {
    return bottom - (bottom - top) * (drawable(value) - low) / (high - low);
  }
};

/// Draws the lines and numbers of the number's ticks. @param labels  one for each tick
void draw_value_ticks(Svg& svg, const ChartFrame& frame, const std::vector<double>& ticks,
                      const std::vector<std::string>& labels);
/// Draws the axis of dates with its labels.
void draw_date_ticks(Svg& svg, const ChartFrame& frame, ReportLanguage language);
/// Draws a line through points. @param ys  one for each of `xs`
void draw_line(Svg& svg, const std::vector<double>& xs, const std::vector<double>& ys, const char* colour);
/// @returns tick labels in the language
[[nodiscard]] std::vector<std::string> tick_labels(const std::vector<double>& ticks, ReportLanguage language);
/// @returns the document as an <svg> element within HTML, as wide as its column
[[nodiscard]] std::string embedded_svg(const Svg& svg, double height, const std::string& title);

}  // namespace phalanx::report
