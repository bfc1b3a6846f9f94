// SPDX-License-Identifier: Apache-2.0
// The choice of what a report is about.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "registry/field_checks.h"
#include "report/date_axis.h"
#include "report/report_sections.h"
#include "report/score_names.h"

namespace phalanx {

void check_report_day(const std::string& day) {
  if (day.empty()) return;
  const double utc = registry::utc_of_day(day);
  if (utc == 0.0 || report::iso_day(utc) != day)
    throw std::invalid_argument(fmt::format("day={}: write a date such as 2026-05-04", day));
}

namespace report {

std::string ReportContext::title_of(const std::string& exercise) const {
  const ReportedExercise* known = find_exercise(exercise);
  if (known == nullptr) return exercise;
  if (language == ReportLanguage::kGerman && !known->title_de.empty()) return known->title_de;
  return known->title.empty() ? exercise : known->title;
}

std::string ReportContext::letter_of(const ResultConditions& wanted) const {
  const auto found = std::find(conditions.begin(), conditions.end(), wanted);
  if (found == conditions.end()) return "\u2013";
  constexpr std::size_t kLetters = 26;
  const auto index = static_cast<std::size_t>(found - conditions.begin());
  std::string letter(1, static_cast<char>('A' + index % kLetters));
  if (index >= kLetters) letter.append(fmt::format("{}", index / kLetters));
  return letter;
}

const ReportedExercise* ReportContext::find_exercise(const std::string& name) const {
  const auto found = std::find_if(input.exercises.begin(), input.exercises.end(),
                                  [&](const ReportedExercise& each) { return each.name == name; });
  return found == input.exercises.end() ? nullptr : &*found;
}

bool ReportContext::is_simulated(const ResultConditions& of) const {
  return input.patient.code.starts_with(kSimulatedCode) || of.device.ends_with(kSimulatedDevice);
}

std::string fault_remark(const ResultRow& row, const ReportContext& context) {
  const ResultDetail& detail = context.details.at(&row);
  const auto label = [&](const std::string& reason) { return reason_label(reason, context.language); };
  std::vector<std::string> parts;
  if (!row.invalid.empty()) parts.push_back(label(row.invalid));
  if (row.valid && row.interrupted && !detail.ended.empty()) parts.push_back(label(detail.ended));
  if (detail.invalid_trials > 0) {
    std::vector<std::string> reasons;
    for (const UnscoredTrials& each : detail.reasons) reasons.push_back(label(each.reason));
    parts.push_back(fmt::format("{} ({})",
                                fmt::format(fmt::runtime(context.words.trial_invalid), detail.invalid_trials),
                                fmt::join(reasons, "; ")));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

ReportContext report_context(const ReportInput& input, ReportLanguage language) {
  check_report_day(input.day);
  ReportContext context{.input = input, .language = language, .words = words_of(language)};
  const auto chosen = [&](const std::string& day) { return input.day.empty() || day == input.day; };
  std::vector<double> dates;
  for (const ResultRow& row : input.results) {
    if (!chosen(iso_day(row.date))) continue;
    context.rows.push_back(&row);
    context.details.emplace(&row, result_detail(row));
    dates.push_back(row.date);
    if (std::find(context.conditions.begin(), context.conditions.end(), row.conditions) ==
        context.conditions.end())
      context.conditions.push_back(row.conditions);
  }
  for (const EnteredTest& test : input.tests) {
    if (!chosen(test.date)) continue;
    context.tests.push_back(&test);
    dates.push_back(registry::utc_of_day(test.date));
  }
  for (const PatientNote& note : input.notes)
    if (chosen(iso_day(note.date))) context.notes.push_back(&note);
  std::stable_sort(context.tests.begin(), context.tests.end(),
                   [](const EnteredTest* a, const EnteredTest* b) { return a->date < b->date; });
  if (!input.day.empty() && dates.empty() && context.notes.empty())
    throw std::invalid_argument(
        fmt::format("day={}: nothing was done or entered on this day (UTC); leave the day out for a "
                    "report of all days",
                    input.day));
  if (!dates.empty()) {
    const auto [first, last] = std::minmax_element(dates.begin(), dates.end());
    const double margin = std::max(kDay / 2.0, 0.01 * (*last - *first));
    context.span = {.from = *first - margin, .to = *last + margin};
  }
  return context;
}

}  // namespace report
}  // namespace phalanx
