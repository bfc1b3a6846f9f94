// SPDX-License-Identifier: Apache-2.0
#include "report/training_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "phalanx/core/xml_text.h"
#include "phalanx/exercise/training.h"
#include "report/chart_frame.h"
#include "report/date_axis.h"
#include "report/report_words.h"

namespace phalanx::report {
namespace {

constexpr double kPercent = 100.0;

/// Mark of one session.
struct SessionMark {
  double shown = 0.0;  ///< in the frame's unit
  std::string data = {};
  std::string title = {};
};

void draw_caption(Svg& svg, const ChartFrame& frame, const char* text) {
  svg.text(frame.left, frame.top - 4.0, text, Anchor::kStart,
           fmt::format(R"( font-size="7" fill="{}")", kLabelInk));
}

void draw_sessions(Svg& svg, const ChartFrame& frame, const std::vector<double>& dates,
                   const std::vector<SessionMark>& marks, const char* colour, bool lined) {
  std::vector<double> xs;
  std::vector<double> ys;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    xs.push_back(frame.x(dates[i]));
    ys.push_back(frame.y(marks[i].shown));
  }
  constexpr std::size_t kManySessions = 40;  // beyond, a line of shares that vary by chance hides the points
  if (lined || marks.size() <= kManySessions) draw_line(svg, xs, ys, colour);
  for (std::size_t i = 0; i < marks.size(); ++i)
    svg.add(
        R"(<circle cx="{:.1f}" cy="{:.1f}" r="1.4" fill="{}" stroke="#fff" stroke-width="0.3" {}><title>{}</title></circle>)",
        xs[i], ys[i], colour, marks[i].data, marks[i].title);
}

std::string data_of(const ResultRow& row, std::string_view field, const std::string& value) {
  return fmt::format(R"(data-score="{}/{}" data-date="{}" data-value="{}" data-recording="{}")",
                     xml_escaped(row.exercise), field, exact_text(row.date), value,
                     xml_escaped(row.recording));
}

void draw_success(Svg& svg, const ChartFrame& frame, RowPointers rows, const RowDetails& details,
                  double target_success, ReportLanguage language) {
  const double top = frame.y(std::min(kPercent, kPercent * (target_success + kSuccessMargin)));
  svg.add(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="#fbe9dc"/>)", frame.left, top,
          frame.right - frame.left, frame.y(kPercent * (target_success - kSuccessMargin)) - top);
  const std::vector<double> ticks = {0.0, 50.0, 100.0};
  draw_value_ticks(svg, frame, ticks, tick_labels(ticks, language));
  std::vector<double> dates;
  std::vector<SessionMark> marks;
  for (const ResultRow* row : rows) {
    const int counted = details.at(row).counted;
    if (!row->valid || counted < 1) continue;
    dates.push_back(row->date);
    marks.push_back(
        {.shown = kPercent * row->successes / counted,
         .data = data_of(*row, "successes", fmt::format("{}", row->successes)) +
                 fmt::format(R"( data-trials="{}")", counted),
         .title = fmt::format("{}: {} / {}", day_label(row->date, language), row->successes, counted)});
  }
  draw_sessions(svg, frame, dates, marks, kSecondInk, false);
  draw_caption(svg, frame, words_of(language).success_share);
}

void draw_difficulty(Svg& svg, const ChartFrame& frame, RowPointers rows, ReportLanguage language) {
  const std::vector<double> ticks = {0.0, 0.5, 1.0};
  draw_value_ticks(svg, frame, ticks, tick_labels(ticks, language));
  std::vector<double> dates;
  std::vector<SessionMark> marks;
  for (const ResultRow* row : rows) {
    if (!row->valid) continue;
    dates.push_back(row->date);
    marks.push_back({.shown = row->difficulty,
                     .data = data_of(*row, "difficulty", exact_text(row->difficulty)),
                     .title = fmt::format("{}: {}", day_label(row->date, language),
                                          number_label(row->difficulty, language))});
  }
  draw_sessions(svg, frame, dates, marks, kInk, true);
  draw_caption(svg, frame, words_of(language).difficulty);
}

}  // namespace

std::string training_chart(RowPointers rows, const RowDetails& details, double target_success,
                           const DateSpan& span, const ChartSize& size, ReportLanguage language) {
  const double width = size.width_mm * kPointsPerMm;
  const double height = size.height_mm * kPointsPerMm;
  const double panel = (height - 13.0 - 2.0 * 13.0) / 2.0;
  Svg svg(width);
  ChartFrame frame{.left = 24.0,
                   .right = width - 6.0,
                   .top = 13.0,
                   .bottom = 13.0 + panel,
                   .span = span,
                   .low = 0.0,
                   .high = kPercent};
  draw_success(svg, frame, rows, details, target_success, language);
  frame.top = frame.bottom + 13.0;
  frame.bottom = frame.top + panel;
  frame.high = 1.0;
  draw_difficulty(svg, frame, rows, language);
  draw_date_ticks(svg, frame, language);
  return embedded_svg(svg, height, rows.front()->exercise);
}

std::string dose_chart(std::span<const Dose> weeks, const DateSpan& span, const ChartSize& size,
                       ReportLanguage language) {
  const double width = size.width_mm * kPointsPerMm;
  const double height = size.height_mm * kPointsPerMm;
  double most = 1.0;
  for (const Dose& week : weeks) most = std::max(most, week.seconds / 60.0);
  const std::vector<double> ticks = nice_ticks(0.0, most, 4);
  const std::vector<std::string> labels = tick_labels(ticks, language);
  const ChartFrame frame{.left = 6.0 + 0.87 * text_width(labels),
                         .right = width - 6.0,
                         .top = 13.0,
                         .bottom = height - 13.0,
                         .span = {.from = week_begin(span.from), .to = week_begin(span.to) + 7.0 * kDay},
                         .low = 0.0,
                         .high = ticks.back()};
  Svg svg(width);
  draw_value_ticks(svg, frame, ticks, labels);
  const double gap = std::min(1.5, 0.15 * (frame.x(weeks[0].begin + 7.0 * kDay) - frame.x(weeks[0].begin)));
  for (const Dose& week : weeks) {
    if (week.exercises == 0) continue;
    const double left = frame.x(week.begin) + gap;
    const double top = frame.y(week.seconds / 60.0);
    svg.add(
        R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="{}" data-score="dose/seconds" data-date="{}" data-value="{}" data-trials="{}"><title>{}: {} min</title></rect>)",
        left, top, std::max(0.6, frame.x(week.begin + 7.0 * kDay) - gap - left), frame.bottom - top, kInk,
        exact_text(week.begin), exact_text(week.seconds), week.trials, day_label(week.begin, language),
        minutes_label(week.seconds, language));
  }
  draw_date_ticks(svg, frame, language);
  draw_caption(svg, frame, words_of(language).minutes_a_week);
  return embedded_svg(svg, height, words_of(language).week_dose);
}

}  // namespace phalanx::report
