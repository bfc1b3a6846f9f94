// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/chart.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "figures/chart/svg.h"
#include "support/page_checks.h"

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
      .subtitles = {"made-up numbers"},
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
          .subtitles = {},
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
  // Over the window's middle, 1.65 s of 4.999 s in a frame of 326.24 pt; 3 pt above the first frame, which
  // begins at 15 + 12 + 7 of the heading + 24.
  EXPECT_THAT(svg, HasSubstr("<text x=\"153.68\" y=\"55.00\" text-anchor=\"middle\" font-size=\"7\" "
                             "fill=\"#6B6650\">bump<"));
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
  // The frame; through the middle a line of the grid and a stroke outside for either axis.
  for (const char* piece : {"d=\"M46.00,40.00V140.00H496.24\"", "M46.00,90.00h450.24M",
                            "M271.12,40.00v100.00", "M46.00,90.00h-3M", "M271.12,140.00v3"})
    EXPECT_EQ(count_of(svg, piece), 1U) << piece;
}

TEST(LineChartSvg, MarksZeroInsideTheFrameOnly) {
  const auto drawn = [](std::vector<double> y) {
    LineChart chart = chart_of({short_series("", std::move(y))});
    chart.panels[0].height = 100.0;
    return line_chart_svg(chart);
  };
  EXPECT_THAT(drawn({-2.0, 0.0, 2.0}), HasSubstr("d=\"M46.00,90.00h450.24\" stroke=\"#888\""));
  EXPECT_EQ(count_of(drawn({-2.0, 0.0, 2.0}), "stroke=\"#888\""), 1U);
  EXPECT_THAT(drawn({0.0, 2.0, 4.0}), Not(HasSubstr("stroke=\"#888\"")));
  EXPECT_THAT(drawn({-4.0, -2.0, -1.0}), Not(HasSubstr("stroke=\"#888\"")));
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

/// Three points of one curve and its companion, in a frame of 90 pt.
std::string with_companion(std::vector<double> companion) {
  ChartSeries series{.name = "index", .x = {1, 2, 3}, .y = {0, 2, 1}, .low = {}, .high = {}};
  series.companion = std::move(companion);
  LineChart chart = chart_of({series});
  chart.panels[0].height = 90.0;
  chart.panels[0].solid_means = "sent";
  chart.panels[0].dashed_means = "asked";
  chart.panels[0].clip_companions = true;
  chart.panels[0].note = "note";
  return line_chart_svg(chart);
}

// The curve reaches 2 and its companion five times that: the axis ends at 1.5 times 2, 30 points for each
// newton, and the companion at a frame's height above it. The frame is 326.24 wide, for x from 0.95 to 3.05.
// The legend's lines are 10.5 points apart.
TEST(LineChartSvg, CutsACompanionThatWouldDwarfItsCurve) {
  const std::string svg = with_companion({0, 10, 0});
  EXPECT_EQ(flaw_of(svg), "");
  for (const char* piece :
       {"class=\"curve\" d=\"M53.77,130.00L209.12,70.00L364.47,100.00\"",
        "class=\"companion\" d=\"M53.77,130.00L209.12,-50.00L364.47,130.00\"",
        "<svg x=\"46.00\" y=\"39.00\" width=\"326.24\" height=\"92.00\" viewBox=\"46.00 39.00 326.24 92.00\" "
        "overflow=\"hidden\">",
        "d=\"M384.24,43.00h18\"", "translate(393.24,43.00)",
        "<text x=\"407.24\" y=\"45.80\" text-anchor=\"start\" fill=\"#000\">index<", "d=\"M384.24,53.50h18\"",
        "<text x=\"407.24\" y=\"56.30\" text-anchor=\"start\" fill=\"#555\">sent<", "d=\"M384.24,64.00h18\"",
        "<text x=\"407.24\" y=\"66.80\" text-anchor=\"start\" fill=\"#555\">asked<",
        "<text x=\"384.24\" y=\"77.30\" text-anchor=\"start\" fill=\"#555\">dashed up to "
        "10, off scale<",
        "<text x=\"384.24\" y=\"87.80\" text-anchor=\"start\" fill=\"#555\">note<"})
    EXPECT_EQ(count_of(svg, piece), 1U) << piece;
}

// Two and a half times as high is still drawn whole, on an axis from 0 to 6.
TEST(LineChartSvg, KeepsACompanionThatFits) {
  const std::string svg = with_companion({0, 5, 0});
  EXPECT_THAT(svg, Not(HasSubstr("off scale")));
  EXPECT_THAT(svg, Not(HasSubstr("overflow")));
  EXPECT_THAT(svg, HasSubstr("class=\"companion\" d=\"M53.77,130.00L209.12,55.00L364.47,130.00\""));
}

TEST(LineChartSvg, SpreadsNoMarkersAlongZero) {
  const std::string svg = line_chart_svg(chart_of({short_series("rests", std::vector<double>(50, 0.0)),
                                                   short_series("presses", std::vector<double>(50, 1.0))}));
  EXPECT_EQ(count_of(svg, "class=\"marker\""), 6U + 2U);  // and the legend's
}

TEST(LineChartSvg, HasAnAxisForEqualValuesAndForNone) {
  LineChart chart = chart_of({short_series("a", {-7.0, -7.0, -7.0})});
  chart.panels[0].from_zero = false;
  for (const LineChart& drawn : {chart, chart_of({}), chart_of({short_series("a", {0.0, 0.0})})}) {
    const std::string svg = line_chart_svg(drawn);
    EXPECT_EQ(flaw_of(svg), "");
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
  }
}

TEST(LineChartSvg, DrawsTheLargestNumbersInsideTheFrame) {
  constexpr double kMax = std::numeric_limits<double>::max();
  ChartSeries series{.name = "a", .x = {-kMax, 0.0, kMax}, .y = {-kMax, 0.0, kMax}, .low = {}, .high = {}};
  series.low = {-kMax, -1.0, 0.0};
  series.high = {0.0, 1.0, kMax};
  series.companion = {kMax, kMax, -kMax};
  LineChart chart = chart_of({series});
  chart.panels[0].marks = {{kMax, "largest"}};
  chart.windows = {{-kMax, kMax, "all"}};
  const std::string svg = line_chart_svg(chart);
  EXPECT_EQ(flaw_of(svg), "");
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

// Without a curve the axis still shows the time of the run: ticks from 2 to 4.
TEST(LineChartSvg, CoversTheGivenX) {
  LineChart chart = chart_of({});
  chart.x_covers = {2.0, 4.0};
  chart.panels[0].empty = "no segment touched";
  const std::string svg = line_chart_svg(chart);
  EXPECT_THAT(svg, HasSubstr(">2.0<"));
  EXPECT_THAT(svg, HasSubstr(">4.0<"));
  EXPECT_THAT(svg, HasSubstr(">no segment touched<"));
}

TEST(LineChartSvg, EscapesAllWords) {
  LineChart chart = chart_of({short_series(kNasty, {1, 2})});
  chart.title = chart.x_label = kNasty;
  chart.subtitles = {kNasty, kNasty};
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
  // It ends 6 pt below the legend: 22 + 18 above the frame, 24 curves and the line that says so, 10.5 pt
  // each.
  EXPECT_THAT(svg, HasSubstr("viewBox=\"0 0 510.24 308.50\""));
}

// The second of three panels, 50 pt high each, has ten curves: 105 pt of legend from 22 + 18 + 50 + 18 = 108
// on. A third panel with a legend of its own begins below it, 18 pt further down; one without, below the
// second frame.
TEST(LineChartSvg, LetsALongLegendPassAPanelWithoutOne) {
  std::vector<ChartSeries> ten;
  for (int i = 0; i < 10; ++i) ten.push_back(short_series(fmt::format("curve {}", i), {1.0, 2.0}));
  LineChart chart = chart_of({short_series("", {1.0, 2.0})});
  chart.panels[0].height = 50.0;
  chart.panels.resize(3, chart.panels[0]);
  chart.panels[0].legend = false;
  chart.panels[1].series = ten;
  const std::string below = line_chart_svg(chart);
  EXPECT_THAT(below, HasSubstr("d=\"M46.00,231.00V281.00H372.24\""));
  EXPECT_THAT(below, HasSubstr("viewBox=\"0 0 510.24 312.00\""));
  chart.panels[2].legend = false;
  const std::string beside = line_chart_svg(chart);
  EXPECT_THAT(beside, HasSubstr("d=\"M46.00,176.00V226.00H372.24\""));
  EXPECT_THAT(beside, HasSubstr("viewBox=\"0 0 510.24 257.00\""));
}

TEST(LineChartSvg, RefusesWhatDoesNotFitTogether) {
  EXPECT_THROW((void)line_chart_svg({}), std::invalid_argument);
  EXPECT_THROW((void)line_chart_svg(chart_of({{.name = "", .x = {1}, .y = {}, .low = {}, .high = {}}})),
               std::invalid_argument);
  EXPECT_THROW((void)line_chart_svg(chart_of({{.name = "", .x = {1}, .y = {1}, .low = {1}, .high = {}}})),
               std::invalid_argument);
}

TEST(LineChartSvg, RefusesACompanionOfAnotherLength) {
  ChartSeries series = short_series("a", {1, 2});
  series.companion = {1};
  EXPECT_THROW((void)line_chart_svg(chart_of({series})), std::invalid_argument);
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

// A letter is 4.32 wide: the names end at 8 + 8.64 and the bars begin 6 further right. The rest of 510.24 - 4
// is for two quantities, 241.80 each; a longest bar has all of that but 40, which is 201.80. Rows are 14 high
// from 22 + 28 on, bars 4 less.
TEST(BarChartSvg, PutsEveryBarWhereItsNumbersSay) {
  const std::string svg =
      bar_chart_svg({.title = "t",
                     .names = {"a", "bb"},
                     .quantities = {{.label = "q", .value = {1, 2}}, {.label = "r", .value = {4, 1}}}});
  for (const char* piece :
       {R"(x="22.64" y="52.00" width="100.90" height="10.00")",
        R"(x="22.64" y="66.00" width="201.80" height="10.00")",
        R"(x="264.44" y="52.00" width="201.80" height="10.00")",
        R"(x="264.44" y="66.00" width="50.45" height="10.00")",
        R"(<text x="126.54" y="59.80" text-anchor="start">1<)",
        R"(<text x="227.44" y="73.80" text-anchor="start">2<)",
        R"(<text x="469.24" y="59.80" text-anchor="start">4<)",
        R"(<text x="317.89" y="73.80" text-anchor="start">1<)",
        R"(<text x="22.64" y="44.00" text-anchor="start" font-weight="bold">q<)",
        R"(<text x="264.44" y="44.00" text-anchor="start" font-weight="bold">r<)",
        R"(<text x="16.64" y="59.80" text-anchor="end">a<)",
        R"(<text x="16.64" y="73.80" text-anchor="end">bb<)", R"(d="M22.64,50.00v28.00")",
        R"(d="M264.44,50.00v28.00")", R"(<rect x="4" y="50.00" width="502.24" height="14.00")",
        R"(viewBox="0 0 510.24 84.00")"})
    EXPECT_EQ(count_of(svg, piece), 1U) << piece;
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
