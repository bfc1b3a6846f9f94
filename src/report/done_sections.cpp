// SPDX-License-Identifier: Apache-2.0
// Chapters of what was done: days, one session, faults, scores without a value, conditions.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "phalanx/core/xml_text.h"
#include "report/date_axis.h"
#include "report/dose.h"
#include "report/report_sections.h"
#include "report/score_names.h"

namespace phalanx::report {
namespace {

std::string state_label(const ResultRow& row, const Words& words) {
  if (!row.valid) return words.not_valid;
  return row.interrupted ? words.interrupted : words.complete;
}

/// @returns a rating from 0 to 10; a dash if it was not asked for
std::string rating_label(int rating) { return rating < 0 ? "\u2013" : fmt::format("{}", rating); }

std::string field_data(const ResultRow& row, const char* field, const std::string& value) {
  return data_attributes({{"score", fmt::format("{}/{}", row.exercise, field)},
                          {"date", exact_text(row.date)},
                          {"value", value},
                          {"recording", row.recording}});
}

/// @returns the trend that has this score of the row; null if it joins none
const Trend* trend_with(const ReportInput& input, const ResultRow& row, const Score& score) {
  const std::string name = fmt::format("{}/{}", row.exercise, score.name);
  for (const Trend& trend : input.trends) {
    if (trend.name != name) continue;
    for (const TrendPoint& point : trend.points)
      if (point.date == row.date && point.recording == row.recording) return &trend;
  }
  return nullptr;
}

/// @returns the value before this row's, with its day
std::string value_before(const ReportContext& context, const ResultRow& row, const Score& score) {
  const Trend* trend = trend_with(context.input, row, score);
  if (trend == nullptr) return {};
  const TrendPoint* before = nullptr;
  for (const TrendPoint& point : trend->points)
    if (point.date < row.date) before = &point;
  if (before == nullptr) return {};
  return fmt::format("{} ({})", value_label(before->value, trend->unit, context.language),
                     day_label(before->date, context.language));
}

/// Adds state, dose, difficulty and ratings of one exercise in one line.
void add_facts(ReportPage& page, const ReportContext& context, const ResultRow& row) {
  const Words& words = context.words;
  std::string html = fmt::format("<b>{}</b>", state_label(row, words));
  const auto add = [&](const char* name, const std::string& shown, const std::string& data) {
    html.append(fmt::format(R"( <span{}>{} <b>{}</b></span>)", data, name, shown));
  };
  add(words.minutes, minutes_label(row.seconds, context.language),
      field_data(row, "seconds", exact_text(row.seconds)));
  const ResultDetail& detail = context.details.at(&row);
  const auto add_integer = [&](const char* name, const char* field, int number) {
    const std::string text = fmt::format("{}", number);
    add(name, text, field_data(row, field, text));
  };
  add_integer(words.trials, "repetitions", row.repetitions);
  if (!row.assessment) {
    add(words.successes, fmt::format(fmt::runtime(words.of_counted), row.successes, detail.counted),
        field_data(row, "successes", fmt::format("{}", row.successes)) +
            data_attributes({{"trials", fmt::format("{}", detail.counted)}}));
    add(words.difficulty, number_label(row.difficulty, context.language),
        field_data(row, "difficulty", exact_text(row.difficulty)));
  }
  if (detail.pain >= 0) add_integer(words.pain, "pain", detail.pain);
  if (detail.fatigue >= 0) add_integer(words.fatigue, "fatigue", detail.fatigue);
  page.raw(fmt::format(R"(<p class="facts">{}</p>)", html));
}

void add_scores_table(ReportPage& page, const ReportContext& context, const ResultRow& row) {
  const Words& words = context.words;
  std::vector<std::vector<Cell>> rows;
  for (const Score& score : row.scores) {
    if (!score.valid()) continue;
    rows.push_back({{.text = score_label(score.name, context.language)},
                    {.text = value_label(score.value, score.unit, context.language),
                     .data = data_attributes({{"score", fmt::format("{}/{}", row.exercise, score.name)},
                                              {"date", exact_text(row.date)},
                                              {"value", exact_text(score.value)},
                                              {"unit", score.unit},
                                              {"recording", row.recording}}),
                     .number = true},
                    {.text = score.origin == ScoreOrigin::kMeasured ? words.measured : words.rendered},
                    {.text = value_before(context, row, score)}});
  }
  std::vector<std::string> header = {words.score, words.value, words.origin, words.value_before};
  if (std::all_of(rows.begin(), rows.end(),
                  [](const std::vector<Cell>& cells) { return cells.back().text.empty(); })) {
    header.pop_back();
    for (std::vector<Cell>& cells : rows) cells.pop_back();
  }
  page.table(header, rows, "scores");
}

/// Adds trials, successes and ratings of a day; a dash for what was not done or not asked.
void add_day_counts(std::vector<Cell>& cells, const Dose& day, const Words& words) {
  const auto data = [&](const char* name, int number) {
    return data_attributes(
        {{"day-of", name}, {"date", exact_text(day.begin)}, {"value", fmt::format("{}", number)}});
  };
  cells.push_back(
      {.text = fmt::format("{}", day.trials), .data = data("trials", day.trials), .number = true});
  if (day.trainings > 0) {
    cells.push_back({.text = fmt::format(fmt::runtime(words.of_counted), day.successes, day.counted),
                     .data = data("successes", day.successes) +
                             data_attributes({{"trials", fmt::format("{}", day.counted)}}),
                     .number = true});
  } else {
    cells.push_back({.text = rating_label(-1), .number = true});
  }
  for (const auto& [name, rating] : {std::pair{"pain", day.pain}, std::pair{"fatigue", day.fatigue}})
    cells.push_back({.text = rating_label(rating),
                     .data = rating < 0 ? std::string() : data(name, rating),
                     .number = true});
}

}  // namespace

void add_days(ReportPage& page, const ReportContext& context) {
  if (context.rows.empty()) return;
  const Words& words = context.words;
  const Dose whole = whole_dose(context.rows, context.details);
  page.heading(words.done);
  page.paragraph(fmt::format("{} {}", words.done_lead, words.done_key), "lead");
  page.raw(R"(<ol class="key">)");
  for (const std::string& name : whole.names) page.element("li", context.title_of(name));
  page.raw("</ol>");
  std::vector<std::string> header = {words.date};
  for (std::size_t i = 1; i <= whole.names.size(); ++i) header.push_back(fmt::format("{}", i));
  for (const char* name :
       {words.minutes, words.trials, words.successes_of_counted, words.pain, words.fatigue})
    header.emplace_back(name);
  std::vector<std::vector<Cell>> rows;
  std::size_t next = 0;
  for (const Dose& day : dose_by_day(context.rows, context.details)) {
    std::map<std::string, std::pair<double, bool>> parts;  // seconds, complete
    for (int i = 0; i < day.exercises; ++i, ++next) {
      auto& [seconds, complete] = parts.try_emplace(context.rows[next]->exercise, 0.0, true).first->second;
      seconds += context.rows[next]->seconds;
      complete = complete && is_complete(*context.rows[next]);
    }
    const std::string begin = exact_text(day.begin);
    std::vector<Cell> cells = {{.text = day_label(day.begin, context.language)}};
    for (const std::string& name : whole.names) {
      const auto part = parts.find(name);
      if (part == parts.end()) {
        cells.push_back({.number = true});
        continue;
      }
      cells.push_back({.text = fmt::format("{}{}", minutes_label(part->second.first, context.language),
                                           part->second.second ? "" : "*"),
                       .data = data_attributes(
                           {{"day-of", name}, {"date", begin}, {"value", exact_text(part->second.first)}}),
                       .number = true});
    }
    cells.push_back(
        {.text = minutes_label(day.seconds, context.language),
         .data = data_attributes({{"day-of", "all"}, {"date", begin}, {"value", exact_text(day.seconds)}}),
         .number = true});
    add_day_counts(cells, day, words);
    rows.push_back(std::move(cells));
  }
  page.table(header, rows, "days");
}

void add_session(ReportPage& page, const ReportContext& context) {
  if (context.rows.empty()) return;
  const Words& words = context.words;
  page.heading(words.done);
  page.paragraph(words.done_lead, "lead");
  for (const ResultRow* row : context.rows) {
    page.raw(
        fmt::format("<h3>{} <small>{}, {}</small></h3>", xml_escaped(context.title_of(row->exercise)),
                    time_label(row->date),
                    fmt::format(fmt::runtime(words.under_conditions), context.letter_of(row->conditions))));
    add_facts(page, context, *row);
    add_scores_table(page, context, *row);
  }
}

void add_faults(ReportPage& page, const ReportContext& context) {
  if (context.rows.empty()) return;
  const Words& words = context.words;
  page.heading(words.faults);
  std::vector<std::vector<Cell>> rows;
  for (const ResultRow* row : context.rows) {
    const std::string remark = fault_remark(*row, context);
    if (is_complete(*row) && remark.empty()) continue;
    rows.push_back(
        {{.text = fmt::format("{} {}", day_label(row->date, context.language), time_label(row->date))},
         {.text = context.title_of(row->exercise)},
         {.text = state_label(*row, words)},
         {.text = remark}});
  }
  page.paragraph(rows.empty() ? words.no_faults : words.faults_lead, "lead");
  page.table({words.date, words.exercise, words.state, words.remark}, rows);
}

void add_not_measured(ReportPage& page, const ReportContext& context) {
  const Words& words = context.words;
  std::map<std::tuple<std::string, std::string, std::string>, int> reasons;
  for (const ResultRow* row : context.rows)
    for (const Score& score : row->scores)
      if (!score.valid()) ++reasons[{row->exercise, score.invalid, score.name}];
  // One line for each exercise and reason, with its scores.
  std::map<std::pair<std::string, std::string>, std::pair<std::vector<std::string>, int>> lines;
  for (const auto& [key, count] : reasons) {
    auto& [scores, most] = lines[{std::get<0>(key), std::get<1>(key)}];
    scores.push_back(score_label(std::get<2>(key), context.language));
    most = std::max(most, count);
  }
  if (lines.empty()) return;
  page.heading(words.not_measured);
  page.paragraph(words.not_measured_lead, "lead");
  std::vector<std::vector<Cell>> rows;
  for (const auto& [key, value] : lines)
    rows.push_back({{.text = context.title_of(key.first)},
                    {.text = fmt::format("{}", fmt::join(value.first, "; "))},
                    {.text = reason_label(key.second, context.language)},
                    {.text = fmt::format("{}", value.second), .number = true}});
  page.table({words.exercise, words.score, words.reason, words.occurrences}, rows);
}

void add_conditions(ReportPage& page, const ReportContext& context) {
  if (context.conditions.empty()) return;
  const Words& words = context.words;
  page.heading(words.conditions);
  page.paragraph(words.conditions_lead, "lead");
  const auto text = [&](const std::string& value) {
    return Cell{.text = value.empty() ? words.not_recorded : value};
  };
  std::vector<std::vector<Cell>> rows;
  for (const ResultConditions& each : context.conditions)
    rows.push_back({{.text = context.letter_of(each)},
                    text(device_label(each.device, context.language)),
                    text(each.serial),
                    text(condition_label(each.calibration_method, context.language)),
                    text(condition_label(each.contact_mode, context.language)),
                    text(condition_label(each.stabiliser, context.language)),
                    text(each.rendering),
                    text(each.protocol)});
  page.table({"", words.device, words.serial, words.method, words.contact, words.stabiliser, words.rendering,
              words.protocol},
             rows);
}

}  // namespace phalanx::report
