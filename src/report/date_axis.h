// SPDX-License-Identifier: Apache-2.0
// Dates of a report: as text, and as ticks of an axis. All are of UTC.
#pragma once

#include <string>
#include <vector>

#include "phalanx/report/report.h"

namespace phalanx::report {

inline constexpr double kDay = 86400.0;  ///< [s]

/// @returns "2026-05-04" of a time [s since 1970]
[[nodiscard]] std::string iso_day(double utc);
/// @returns a day for people: "4 May 2026", "04.05.2026"
[[nodiscard]] std::string day_label(double utc, ReportLanguage language);
/// @returns the same for a date "2026-05-04"; another text as it is
[[nodiscard]] std::string day_label(const std::string& day, ReportLanguage language);
/// @returns "09:30" of a time, UTC
[[nodiscard]] std::string time_label(double utc);
/// @returns the begin of the week's Monday [s since 1970]
[[nodiscard]] double week_begin(double utc);

/// Tick of an axis of dates.
struct DateTick {
  double utc = 0.0;  ///< [s since 1970]
  std::string label = {};
};
/// @returns ticks within the range, at most about `most`: days, Mondays, or first days of months. The label of
/// a month has the year at the first tick and in January
/// @pre from < to
[[nodiscard]] std::vector<DateTick> date_ticks(double from, double to, int most, ReportLanguage language);

}  // namespace phalanx::report
