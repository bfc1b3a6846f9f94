// SPDX-License-Identifier: Apache-2.0
// The chapters of a report. Each adds itself to the page, or nothing if it has no content.
#pragma once

#include <string>
#include <vector>

#include "phalanx/report/report.h"
#include "report/dose.h"
#include "report/report_page.h"
#include "report/report_words.h"
#include "report/trend_chart.h"

namespace phalanx::report {

/// What all chapters of one report need.
struct ReportContext {
  const ReportInput& input;
  ReportLanguage language = ReportLanguage::kEnglish;
  const Words& words;
  std::vector<const ResultRow*> rows = {};        ///< that the report is about, by date
  RowDetails details = {};                        ///< of these
  std::vector<const EnteredTest*> tests = {};     ///< likewise
  std::vector<const PatientNote*> notes = {};     ///< likewise
  DateSpan span = {};                             ///< of all rows and tests
  std::vector<ResultConditions> conditions = {};  ///< of the rows, in the order of their first row

  /// @returns the exercise's title in the language
  [[nodiscard]] std::string title_of(const std::string& exercise) const;
  /// @returns "A", "B", ... of the conditions
  [[nodiscard]] std::string letter_of(const ResultConditions& conditions) const;
  [[nodiscard]] const ReportedExercise* find_exercise(const std::string& name) const;
  /// @returns true if a simulated participant did what the row states, or all that the patient has
  [[nodiscard]] bool is_simulated(const ResultConditions& conditions) const;
  [[nodiscard]] bool of_one_day() const noexcept { return !input.day.empty(); }
};

/// Chooses what a report is about. @throws std::invalid_argument as report_html()
[[nodiscard]] ReportContext report_context(const ReportInput& input, ReportLanguage language);

/// @returns the remark on a row's end and on trials that were not scored; empty if there is nothing to state
[[nodiscard]] std::string fault_remark(const ResultRow& row, const ReportContext& context);
/// @returns the judgement of a training's success in words; empty if there is none
[[nodiscard]] std::string success_words(const ReportedExercise& exercise, ReportLanguage language);
/// @returns true if the last value of an entered test is better than the first
[[nodiscard]] bool is_better(const Trend& trend);
/// @returns the change of a trend in words, with its verdict
[[nodiscard]] std::string trend_verdict(const Trend& trend, const ReportContext& context);

void add_tests(ReportPage& page, const ReportContext& context);        ///< entered tests, with their trends
void add_assessments(ReportPage& page, const ReportContext& context);  ///< trends of assessments
void add_trainings(ReportPage& page,
                   const ReportContext& context);               ///< success and difficulty; the dose by week
void add_days(ReportPage& page, const ReportContext& context);  ///< what was done on each day
void add_session(ReportPage& page, const ReportContext& context);  ///< all exercises of one day, all scores
void add_faults(ReportPage& page, const ReportContext& context);
void add_not_measured(ReportPage& page, const ReportContext& context);
void add_conditions(ReportPage& page, const ReportContext& context);

}  // namespace phalanx::report
