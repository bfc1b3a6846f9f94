// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/report/chart.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "study/report/page_checks.h"
#include "study/report/svg.h"

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A press that shakes, like S2 fig. 4 without smoothing.
LineChart press() {
  LineChart chart{
      .title = "Index presses the teapot at 0.9 N/mm",
      .subtitle = "made-up numbers",
      .x_label = "time [s]",
      .panels = {{.title = "Force", .y_label = "force [N]", .series = {}, .marks = {{3.0, "press: 3 N"}}},
                 {.title = "Position along n",
                  .y_label = "position [mm]",
                  .series = {},
                  .marks = {},
                  .from_zero = false,
                  .legend = false}},
      .windows = {{1.6, 1.7, "bump"}, {2.7, 4.2, "window"}}};
  for (const char* name : {"without smoothing", "with +-0.05 N a step"}) {
    ChartSeries force{.name = name, .x = {}, .y = {}, .low = {}, .high = {}};
    ChartSeries position = force;
    const double shake = name[4] == 'o' ? 1.0 : 0.02;
    for (int i = 0; i < 5000; ++i) {
      const double t = 1e-3 * i;
      force.x.push_back(t);
      force.y.push_back(std::max(0.0, 3.0 * std::tanh(t) + shake * std::sin(40 * t) * (t > 1.6 ? 1.0 : 0.1)));
      position.x.push_back(t);
      position.y.push_back(52.0 - 0.4 * force.y.back());
    }
    chart.panels[0].series.push_back(force);
    chart.panels[1].series.push_back(position);
  }
  return chart;
}

ChartSeries short_series(const std::string& name, std::vector<double> y) {
  ChartSeries series{.name = name, .x = {}, .y = std::move(y), .low = {}, .high = {}};
  for (std::size_t i = 0; i < series.y.size(); ++i) series.x.push_back(0.1 * static_cast<double>(i));
  return series;
}

LineChart chart_of(std::vector<ChartSeries> series) {
  return {.title = "title",
          .subtitle = "",
          .x_label = "friction [N]",
          .panels = {{.title = "panel", .y_label = "k_lim [N/mm]", .series = std::move(series), .marks = {}}},
          .windows = {}};
}

TEST(LineChartSvg, StacksPanelsOverOneAxisWithMarksAndWindows) {
  const std::string svg = line_chart_svg(press());
  keep("press.svg", svg);
  EXPECT_EQ(flaw_of(svg), "");
  EXPECT_THAT(svg, HasSubstr("width=\"180.00mm\""));
  for (const char* words : {">Force<", ">force [N]<", ">position [mm]<", ">time [s]<", ">press: 3 N<",
                            ">bump<", ">window<", ">without smoothing<", ">with +-0.05 N a step<"})
    EXPECT_EQ(count_of(svg, words), 1U) << words;
  EXPECT_EQ(count_of(svg, "class=\"curve\""), 4U);
  EXPECT_EQ(count_of(svg, "class=\"mark\""), 1U);
}

TEST(LineChartSvg, GivesTheSameBytesForTheSameNumbers) {
  EXPECT_EQ(line_chart_svg(press()), line_chart_svg(press()));
}

TEST(LineChartSvg, ThinsALongRunToWhatTheWidthShows) {
  LineChart chart = press();
  for (ChartPanel& panel : chart.panels) {
    for (ChartSeries& series : panel.series) {
      const std::vector<double> y = series.y;
      for (int i = 1; i < 20; ++i) series.y.insert(series.y.end(), y.begin(), y.end());
      series.x.clear();
      for (std::size_t i = 0; i < series.y.size(); ++i) series.x.push_back(1e-3 * static_cast<double>(i));
    }
  }
  EXPECT_LT(line_chart_svg(chart).size(), 250'000U);  // 400,000 values
}

// Three points, a third of a frame of 4 units apart in y: their places in the SVG follow from the numbers by
// hand.
TEST(LineChartSvg, PutsEveryPointWhereItsNumbersSay) {
  LineChart chart = chart_of({short_series("", {0.0, 2.0, 4.0})});
  chart.panels[0].height = 100.0;
  const std::string svg = line_chart_svg(chart);
  // Frame: left 46 pt, width 510.24 - 46 - 14 = 450.24 pt, x from -0.005 to 0.205: 0.1 is in the middle.
  // Top: heading 15 + 7, and 18 above the first frame = 40; y from 0 to 4: 2 is in the middle of 100 pt.
  EXPECT_THAT(svg, HasSubstr("translate(271.12,90.00)"));
  EXPECT_THAT(svg, HasSubstr("d=\"M56.72,140.00L271.12,90.00L485.52,40.00\""));
}

TEST(LineChartSvg, BreaksTheLineAtWhatIsNotFinite) {
  const std::string svg = line_chart_svg(chart_of({short_series("a", {1, 2, kNan, 3, 4, HUGE_VAL, 5})}));
  EXPECT_EQ(flaw_of(svg), "");
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
  const std::size_t begin = svg.find("d=\"", svg.find("class=\"curve\"")) + 3;
  EXPECT_EQ(count_of(svg.substr(begin, svg.find('"', begin) - begin), "M"), 3U);
  EXPECT_EQ(count_of(svg, "class=\"marker\""), 5U + 1U);  // and the legend's
}

TEST(LineChartSvg, SaysThatThereIsNothing) {
  EXPECT_THAT(line_chart_svg(chart_of({})), HasSubstr(">no value<"));
  const std::string svg = line_chart_svg(chart_of({short_series("a", {kNan, kNan})}));
  EXPECT_EQ(flaw_of(svg), "");
  EXPECT_THAT(svg, HasSubstr(">no value<"));
}

TEST(LineChartSvg, ShowsOnePoint) {
  const std::string svg =
      line_chart_svg(chart_of({{.name = "", .x = {0.3}, .y = {1.5}, .low = {}, .high = {}}}));
  EXPECT_EQ(flaw_of(svg), "");
  EXPECT_EQ(count_of(svg, "class=\"marker\""), 1U);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(LineChartSvg, ShowsBandsAndLowerBounds) {
  ChartSeries series = short_series("a", {1, 2, 3});
  series.low = {0.5, kNan, 2.5};
  series.high = {1.5, 2.5, 3.5};
  series.at_least = {false, false, true};
  const std::string svg = line_chart_svg(chart_of({series}));
  EXPECT_EQ(flaw_of(svg), "");
  EXPECT_EQ(count_of(svg, "class=\"band\""), 1U);
  EXPECT_EQ(count_of(svg, "class=\"at-least\""), 2U);  // and the legend's
  EXPECT_THAT(svg, HasSubstr(">at least<"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(LineChartSvg, EscapesAllWords) {
  LineChart chart = chart_of({short_series(kNasty, {1, 2})});
  chart.title = chart.subtitle = chart.x_label = kNasty;
  chart.panels[0].title = chart.panels[0].y_label = kNasty;
  chart.panels[0].marks = {{1.5, kNasty}};
  chart.windows = {{0.0, 0.1, kNasty}};
  EXPECT_EQ(flaw_of(line_chart_svg(chart)), "");
}

TEST(LineChartSvg, TellsHowManyOfTooManyCurvesItShows) {
  std::vector<ChartSeries> many;
  for (int i = 0; i < 30; ++i) many.push_back(short_series(fmt::format("curve {}", i), {1.0 * i, 2.0 * i}));
  const std::string svg = line_chart_svg(chart_of(many));
  keep("many.svg", svg);
  EXPECT_EQ(count_of(svg, "class=\"curve\""), kMostSeries);
  EXPECT_THAT(svg, HasSubstr(">24 of 30 curves shown<"));
}

TEST(LineChartSvg, RefusesWhatDoesNotFitTogether) {
  EXPECT_THROW((void)line_chart_svg({}), std::invalid_argument);
  EXPECT_THROW((void)line_chart_svg(chart_of({{.name = "", .x = {1}, .y = {}, .low = {}, .high = {}}})),
               std::invalid_argument);
  EXPECT_THROW((void)line_chart_svg(chart_of({{.name = "", .x = {1}, .y = {1}, .low = {1}, .high = {}}})),
               std::invalid_argument);
}

TEST(BarChartSvg, DrawsEveryBarToScaleWithItsNumber) {
  const BarChart chart{
      .title = "Stabilisers",
      .names = {"none", "smoothing +-0.1", kNasty, "not measured"},
      .quantities = {
          {.label = "k_lim [N/mm]", .value = {0.7, 1.6, 3.2, kNan}, .at_least = {false, false, true, false}},
          {.label = "ghost time [ms]", .value = {15, 111, 0, kNan}},
          {.label = "ghost energy [mJ]", .value = {1.4, 20, 0, kNan}}}};
  const std::string svg = bar_chart_svg(chart);
  keep("bars.svg", svg);
  EXPECT_EQ(flaw_of(svg), "");
  for (const char* words : {">0.7<", ">1.6<", ">\u22653.2<", ">15<", ">111<", ">1.4<", ">20<", ">\u2013<"})
    EXPECT_THAT(svg, HasSubstr(words));
  EXPECT_EQ(count_of(svg, "class=\"bar\""), 3U + 2U + 2U);
}

TEST(BarChartSvg, RefusesAValueWithoutAName) {
  EXPECT_THROW(
      (void)bar_chart_svg({.title = "", .names = {"a"}, .quantities = {{.label = "", .value = {1, 2}}}}),
      std::invalid_argument);
}

TEST(NumberText, HasThreeDigitsAndNoNeedlessExponent) {
  EXPECT_EQ(number_text(1.6), "1.6");
  EXPECT_EQ(number_text(0.012345), "0.0123");
  EXPECT_EQ(number_text(12345.6), "12346");
  EXPECT_EQ(number_text(-0.5), "\u22120.5");
  EXPECT_EQ(number_text(kNan), "\u2013");
}

TEST(Wrapped, BreaksAtSpacesAndCutsTheLastLine) {
  const double ten = text_width("0123456789");
  EXPECT_THAT(wrapped("short", ten, 2), ElementsAre("short"));
  EXPECT_THAT(wrapped("one two three four", ten, 3), ElementsAre("one two", "three four"));
  EXPECT_THAT(wrapped("one two three four five", ten, 2), ElementsAre("one two", "three fou\u2026"));
}

}  // namespace
}  // namespace phalanx
