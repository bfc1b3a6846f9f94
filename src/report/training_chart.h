// SPDX-License-Identifier: Apache-2.0
// Charts of trainings: success and difficulty of each session, and the dose by week.
#pragma once

#include <span>
#include <string>

#include "phalanx/registry/result.h"
#include "phalanx/report/report.h"
#include "report/dose.h"
#include "report/trend_chart.h"

namespace phalanx::report {

/// Draws the share of successful trials of each session of one training, with the range that it steers to, and
/// below it the difficulty. The share is over the trials that were scored (ResultDetail::counted); a session
/// without one has no share, and one that is not valid has no mark. The circles have data-score
/// (EXERCISE/successes or EXERCISE/difficulty), data-value (the row's field), data-date and data-recording; those
/// of successes also data-trials, the scored ones.
/// @param rows  of one training, by date; at least one, each with its detail
/// @param target_success  [-]
[[nodiscard]] std::string training_chart(RowPointers rows, const RowDetails& details, double target_success,
                                         const DateSpan& span, const ChartSize& size,
                                         ReportLanguage language);

/// Draws a bar for each week. The bars have data-score "dose/seconds", data-value, data-date (the week's
/// begin) and data-trials. @pre weeks is not empty
[[nodiscard]] std::string dose_chart(std::span<const Dose> weeks, const DateSpan& span, const ChartSize& size,
                                     ReportLanguage language);

}  // namespace phalanx::report
