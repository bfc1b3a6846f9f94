// SPDX-License-Identifier: Apache-2.0
// Chart of one trend: values over dates, with the smallest real difference as a band around the first value.
#pragma once

#include <string>

#include "phalanx/registry/trends.h"
#include "phalanx/report/report.h"

namespace phalanx::report {

/// Dates that the charts of a report share, so that they can be compared.
struct DateSpan {
  double from = 0.0;  ///< UTC [s since 1970]
  double to = 0.0;    ///< larger than `from`
};

/// Size of a chart.
struct ChartSize {
  double width_mm = 88.0;
  double height_mm = 36.0;
};

/// Draws a trend as an <svg> element. Each value is a circle with data-score, data-date, data-value, data-unit and
/// data-recording. @param title  of the element, for screen readers, in the language. @pre the trend has a point; all lie in the span
[[nodiscard]] std::string trend_chart(const Trend& trend, const std::string& title, const DateSpan& span,
                                      const ChartSize& size, ReportLanguage language);

}  // namespace phalanx::report
