// SPDX-License-Identifier: Apache-2.0
// Chapters with trends: entered tests, assessments, trainings.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "phalanx/core/xml_text.h"
#include "phalanx/exercise/training.h"
#include "report/date_axis.h"
#include "report/report_sections.h"
#include "report/score_names.h"
#include "report/training_chart.h"

namespace phalanx::report {
namespace {

/// Trends of one exercise under one set of conditions and of one origin.
struct TrendGroup {
  const Trend* first = nullptr;
  std::vector<const Trend*> charted = {};
  std::vector<const Trend*> single = {};  ///< with one value only
};

std::string_view exercise_of(const Trend& trend) {
  return std::string_view(trend.name).substr(0, trend.name.find('/'));
}
std::string_view score_of(const Trend& trend) {
  return std::string_view(trend.name).substr(trend.name.find('/') + 1);
}

/// @returns true if an earlier trend has the same name: its conditions were others
bool has_earlier(const Trend& trend, const ReportContext& context) {
  return std::any_of(context.input.trends.begin(), context.input.trends.end(), [&](const Trend& other) {
    return other.name == trend.name && other.points.front().date < trend.points.front().date;
  });
}

void add_chart(ReportPage& page, const ReportContext& context, const std::string& title, const Trend& trend,
               const ChartSize& size) {
  page.raw("<figure>");
  page.element("h4", title);
  page.raw(trend_chart(trend, title, context.span, size, context.language));
  page.paragraph(trend_verdict(trend, context));
  if (trend.smallest_real_difference)
    page.paragraph(fmt::format(fmt::runtime(context.words.band_is),
                               value_label(*trend.smallest_real_difference, trend.unit, context.language)));
  page.raw("</figure>");
}

std::string title_with_unit(const std::string& label, const std::string& unit) {
  const std::string named = unit_label(unit);
  return named.empty() ? label : fmt::format("{} [{}]", label, named);
}

std::string data_of_point(const Trend& trend, const TrendPoint& point) {
  return data_attributes({{"score", trend.name},
                          {"date", exact_text(point.date)},
                          {"value", exact_text(point.value)},
                          {"unit", trend.unit},
                          {"recording", point.recording}});
}

std::vector<TrendGroup> groups_of(const ReportContext& context) {
  std::vector<TrendGroup> groups;
  for (const Trend& trend : context.input.trends) {
    if (!trend.origin) continue;
    auto found = std::find_if(groups.begin(), groups.end(), [&](const TrendGroup& group) {
      return exercise_of(*group.first) == exercise_of(trend) && group.first->origin == trend.origin &&
             group.first->conditions == trend.conditions;
    });
    if (found == groups.end()) found = groups.insert(groups.end(), TrendGroup{.first = &trend});
    (trend.points.size() > 1 ? found->charted : found->single).push_back(&trend);
  }
  std::stable_sort(groups.begin(), groups.end(), [](const TrendGroup& a, const TrendGroup& b) {
    return exercise_of(*a.first) < exercise_of(*b.first);
  });
  return groups;
}

void add_group(ReportPage& page, const ReportContext& context, const TrendGroup& group) {
  const Words& words = context.words;
  std::string under = fmt::format(
      "{}, {}", group.first->origin == ScoreOrigin::kMeasured ? words.measured : words.rendered,
      fmt::format(fmt::runtime(words.under_conditions), context.letter_of(group.first->conditions)));
  if (has_earlier(*group.first, context)) under.append(fmt::format("; {}", words.other_conditions));
  page.raw(fmt::format("<h3>{} <small>{}</small></h3>",
                       xml_escaped(context.title_of(std::string(exercise_of(*group.first)))), under));
  if (!group.charted.empty()) {
    constexpr std::size_t kFew = 4;
    const bool few = group.charted.size() <= kFew;
    const ChartSize size =
        few ? ChartSize{.width_mm = 89.0, .height_mm = 33.0} : ChartSize{.width_mm = 58.0, .height_mm = 28.0};
    page.raw(fmt::format(R"(<div class="charts {}">)", few ? "two" : "three"));
    for (const Trend* trend : group.charted)
      add_chart(page, context, title_with_unit(score_label(score_of(*trend), context.language), trend->unit),
                *trend, size);
    page.raw("</div>");
  }
  std::vector<std::vector<Cell>> rows;
  for (const Trend* trend : group.single)
    rows.push_back({{.text = score_label(score_of(*trend), context.language)},
                    {.text = value_label(trend->points[0].value, trend->unit, context.language),
                     .data = data_of_point(*trend, trend->points[0]),
                     .number = true},
                    {.text = day_label(trend->points[0].date, context.language)},
                    {.text = trend_verdict(*trend, context)}});
  page.table({words.score, words.value, words.date, words.verdict}, rows);
}

std::string side_label(TestSide side, const Words& words) {
  return side == TestSide::kMoreAffected ? words.more_affected : words.less_affected;
}

/// @returns the kind and side of a test's trend, as "Box and Block Test, more affected"
std::string test_title(const Trend& trend, const ReportContext& context) {
  const TestKindInfo& kind = test_kind(exercise_of(trend));
  const TestSide side = score_of(trend) == test_side_name(TestSide::kMoreAffected) ? TestSide::kMoreAffected
                                                                                   : TestSide::kLessAffected;
  return fmt::format("{}, {} [{}]", test_label(kind.kind, context.language), side_label(side, context.words),
                     kind.unit);
}

}  // namespace

bool is_better(const Trend& trend) {
  const double change = trend.points.back().value - trend.points.front().value;
  return !trend.origin && (change > 0.0) == test_kind(exercise_of(trend)).larger_is_better;
}

std::string trend_verdict(const Trend& trend, const ReportContext& context) {
  const Words& words = context.words;
  std::string text;
  if (trend.points.size() < 2) {
    text = fmt::format("{}: {}", words.not_proven, words.one_value);
  } else {
    const double change = trend.points.back().value - trend.points.front().value;
    const std::string changed = change_label(change, trend.unit, context.language);
    if (!trend.smallest_real_difference) {
      text = fmt::format("{}; {}: {}", changed, words.not_proven, words.no_difference);
    } else {
      const std::string difference =
          value_label(*trend.smallest_real_difference, trend.unit, context.language);
      text = trend.proven ? fmt::format("{}: {}, {}", is_better(trend) ? words.improved : words.worse,
                                        changed, fmt::format(fmt::runtime(words.beyond), difference))
                          : fmt::format("{}: {}, {}", words.not_proven, changed,
                                        fmt::format(fmt::runtime(words.within), difference));
    }
  }
  return text;
}

void add_tests(ReportPage& page, const ReportContext& context) {
  if (context.tests.empty()) return;
  const Words& words = context.words;
  page.heading(words.tests);
  page.paragraph(words.tests_lead, "lead");
  const bool charted =
      !context.of_one_day() &&
      std::any_of(context.input.trends.begin(), context.input.trends.end(),
                  [](const Trend& trend) { return !trend.origin && trend.points.size() > 1; });
  if (charted) {
    page.raw(R"(<div class="charts two">)");
    for (const Trend& trend : context.input.trends) {
      if (trend.origin || trend.points.size() < 2) continue;
      add_chart(page, context, test_title(trend, context), trend, {.width_mm = 89.0, .height_mm = 38.0});
    }
    page.raw("</div>");
  }
  std::vector<std::vector<Cell>> rows;
  for (const EnteredTest* test : context.tests) {
    const TestKindInfo& kind = test_kind(test->kind);
    rows.push_back({{.text = day_label(test->date, context.language)},
                    {.text = test_label(test->kind, context.language)},
                    {.text = value_label(test->value, kind.unit, context.language),
                     .data = data_attributes({{"test", std::string(kind.name)},
                                              {"side", std::string(test_side_name(test->side))},
                                              {"day", test->date},
                                              {"value", exact_text(test->value)},
                                              {"unit", std::string(kind.unit)}}),
                     .number = true},
                    {.text = side_label(test->side, words)},
                    {.text = test->rater},
                    {.text = test->note}});
  }
  page.table({words.date, words.test, words.value, words.side, words.rater, words.note}, rows);
}

void add_assessments(ReportPage& page, const ReportContext& context) {
  const std::vector<TrendGroup> groups = groups_of(context);
  if (groups.empty()) return;
  page.heading(context.words.assessments);
  page.paragraph(context.words.assessments_lead, "lead");
  for (const TrendGroup& group : groups) add_group(page, context, group);
}

void add_trainings(ReportPage& page, const ReportContext& context) {
  const Words& words = context.words;
  std::map<std::string, std::vector<const ResultRow*>> trainings;
  for (const ResultRow* row : context.rows)
    if (!row->assessment) trainings[row->exercise].push_back(row);
  if (!trainings.empty()) {
    page.heading(words.trainings);
    page.paragraph(words.trainings_lead, "lead");
    page.raw(R"(<div class="charts two">)");
    for (const auto& [name, rows] : trainings) {
      const ReportedExercise* exercise = context.find_exercise(name);
      page.raw("<figure>");
      page.element("h4", context.title_of(name));
      const double target = exercise == nullptr ? Difficulty{}.target_success : exercise->target_success;
      page.raw(training_chart(rows, context.details, target, context.span,
                              {.width_mm = 89.0, .height_mm = 46.0}, context.language));
      page.paragraph(fmt::format("{}: {} \u2013 {} %", words.target_range,
                                 number_label(100.0 * (target - kSuccessMargin), context.language),
                                 number_label(100.0 * (target + kSuccessMargin), context.language)));
      if (exercise != nullptr && exercise->success)
        page.paragraph(success_words(*exercise, context.language));
      page.raw("</figure>");
    }
    page.raw("</div>");
  }
  const std::vector<Dose> weeks = dose_by_week(context.rows, context.details);
  if (weeks.empty()) return;
  page.heading(words.week_dose);
  page.raw("<figure>");
  page.raw(dose_chart(weeks, context.span, {.width_mm = 182.0, .height_mm = 38.0}, context.language));
  page.raw("</figure>");
}

}  // namespace phalanx::report
