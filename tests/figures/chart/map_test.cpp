// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>
#include <regex>
#include <stdexcept>

#include "figures/chart/column_names.h"
#include "figures/chart/palette.h"
#include "figures/chart/svg.h"
#include "phalanx/figures/chart.h"
#include "support/page_checks.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

HeatMap small_map() {
  return {.title = "k_lim",
          .quantity = "k_lim [N/mm]",
          .x_label = "sheath friction [N]",
          .y_label = "delay [ms]",
          .columns = {"0", "0.17", "0.34"},
          .rows = {"4.5", "2"},
          .value = {0.25, 0.55, kNotANumber, 0.31, 1.25, 3.9},
          .at_least = {false, false, false, false, false, true},
          .low = {},
          .high = {},
          .width_mm = 88.0};
}

TEST(HeatMapSvg, WritesEveryNumberAndHatchesWhatIsMissing) {
  const std::string svg = heat_map_svg(small_map());
  keep("small_map.svg", svg);
  EXPECT_EQ(flaw_of(svg), "");
  for (const char* words : {">0.25<", ">0.55<", ">0.31<", ">1.25<", ">\u22653.9<", ">0.17<", ">4.5<",
                            ">delay [ms]<", ">sheath friction [N]<", ">k_lim [N/mm]<", ">no value<"})
    EXPECT_THAT(svg, HasSubstr(words));
  EXPECT_EQ(count_of(svg, "fill=\"url(#hatch)\""), 2U);  // the cell and the legend
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_EQ(svg, heat_map_svg(small_map()));
}

// 88 mm are 249.45 pt. Left of the cells 8 and two letters of 4.32, right of them 58 + 16: a fifth of the
// rest is 31.76. The heading's 22 and 6 are above them, and rows are 17 high where there is room.
TEST(HeatMapSvg, PutsEveryCellAndNameInItsPlace) {
  const HeatMap map{.title = "t",
                    .quantity = "q",
                    .x_label = "x",
                    .y_label = "",
                    .columns = {"a", "b", "c", "d", "e"},
                    .rows = {"1", "2", "3", "4", "5", "6", "7", "8", "9", "10"},
                    .value = std::vector<double>(50, 1.5),
                    .width_mm = 88.0};
  const std::string svg = heat_map_svg(map);
  for (const char* piece :
       {R"(<rect x="16.64" y="28.00" width="31.76" height="17.00")",
        R"(<rect x="143.69" y="28.00" width="31.76" height="17.00")",
        R"(<rect x="143.69" y="181.00" width="31.76" height="17.00")",
        R"(<rect x="16.64" y="28.00" width="158.81" height="170.00" fill="none")",
        R"(<text x="32.52" y="209.00" text-anchor="middle">a<)",
        R"(<text x="96.04" y="221.00" text-anchor="middle">x<)",
        R"(<text x="12.64" y="39.30" text-anchor="end">1<)", R"(viewBox="0 0 249.45 229.00")"})
    EXPECT_EQ(count_of(svg, piece), 1U) << piece;
}

// However few they are: a column is no wider than 80 pt.
TEST(HeatMapSvg, GivesOneColumnAllTheRoomItMayHave) {
  const HeatMap map{.title = "",
                    .quantity = "",
                    .x_label = "",
                    .y_label = "y",
                    .columns = {"twenty letters' name"},
                    .rows = {"1"},
                    .value = {1.5},
                    .width_mm = 88.0};
  EXPECT_THAT(heat_map_svg(map), HasSubstr("width=\"80.00\""));
}

TEST(MapsSvg, Are180MillimetresWideUnlessSaidOtherwise) {
  EXPECT_THAT(heat_map_svg({}), HasSubstr("width=\"180.00mm\""));
  EXPECT_THAT(verdict_map_svg({}), HasSubstr("width=\"180.00mm\""));
}

// A letter is 4.32 wide, and 1.5 are between two names. A number in a cell of 4 has room for itself at every
// second one; a word that is too wide stands upright.
TEST(ColumnNames, StandUnderTheirColumns) {
  const auto drawn = [](const std::vector<std::string>& names, double cell, double end) {
    Svg svg(200.0);
    EXPECT_NEAR(draw_column_names(svg, names, 10.0, cell, 100.0), end, 1e-9);
    return svg.document(200.0, "");
  };
  const std::string numbered = drawn({"0", "1", "2"}, 20.0, 111.0);
  for (const char* piece : {R"(<text x="20.00" y="111.00" text-anchor="middle">0<)",
                            R"(<text x="40.00" y="111.00" text-anchor="middle">1<)",
                            R"(<text x="60.00" y="111.00" text-anchor="middle">2<)"})
    EXPECT_THAT(numbered, HasSubstr(piece));
  const std::string thinned_out = drawn({"0", "1", "2"}, 4.0, 111.0);
  EXPECT_THAT(thinned_out, HasSubstr(R"(<text x="12.00" y="111.00" text-anchor="middle">0<)"));
  EXPECT_THAT(thinned_out, HasSubstr(R"(<text x="20.00" y="111.00" text-anchor="middle">2<)"));
  EXPECT_EQ(count_of(thinned_out, "<text"), 2U);
  const std::string upright = drawn({"left", "right"}, 20.0, 126.6);
  EXPECT_THAT(upright, HasSubstr(R"x(translate(22.80,105.00) rotate(-90)" text-anchor="end">left<)x"));
  EXPECT_THAT(upright, HasSubstr(R"x(translate(42.80,105.00) rotate(-90)" text-anchor="end">right<)x"));
}

// A name of 40 letters is 172.8 pt wide, more than 0.3 of the width. Beside 2 cells of 46 pt there is room for
// it, beside 20 there is not.
TEST(HeatMapSvg, CutsARowsNameOnlyIfTheCellsNeedTheRoom) {
  const std::string name(40, 'n');
  for (const std::size_t columns : {2U, 20U}) {
    const HeatMap map{.title = "",
                      .quantity = "",
                      .x_label = "",
                      .y_label = "",
                      .columns = std::vector<std::string>(columns, "c"),
                      .rows = {name},
                      .value = std::vector<double>(columns, 1.5)};
    EXPECT_EQ(count_of(heat_map_svg(map), ">" + name + "<"), columns == 2U ? 1U : 0U) << columns;
  }
}

TEST(HeatMapSvg, ColoursTheSmallestDarkAndTheLargestBright) {
  const std::string svg = heat_map_svg(small_map());
  EXPECT_EQ(count_of(svg, "fill=\"" + scale_colour(0.0).fill + "\""), 1U);
  EXPECT_EQ(count_of(svg, "fill=\"" + scale_colour(1.0).fill + "\""), 1U);
}

TEST(HeatMapSvg, LeavesTheNumbersOutWhereThereIsNoRoom) {
  HeatMap map{.title = "many",
              .quantity = "q [N]",
              .x_label = "x",
              .y_label = "y",
              .columns = {},
              .rows = {},
              .value = {}};
  for (int i = 0; i < 50; ++i) map.columns.push_back(fmt::format("{:.2f}", 0.01 * i));
  for (int i = 0; i < 40; ++i) map.rows.push_back(fmt::format("{}", i));
  for (int i = 0; i < 2000; ++i)
    map.value.push_back(i % 97 == 0 ? kNotANumber : std::sin(0.1 * (i % 50)) + 0.05 * (i / 50));
  const std::string svg = heat_map_svg(map);
  keep("many_map.svg", svg);
  EXPECT_EQ(flaw_of(svg), "");
  EXPECT_LT(svg.size(), 300'000U);
  EXPECT_LT(count_of(svg, "<text"), 100U);
}

TEST(HeatMapSvg, SurvivesEqualValuesNoValuesAndNoCells) {
  HeatMap map = small_map();
  map.at_least.clear();
  map.value.assign(6, 1.5);
  EXPECT_EQ(flaw_of(heat_map_svg(map)), "");
  EXPECT_EQ(count_of(heat_map_svg(map), ">1.5<"), 6U);  // the scale says 1.50
  map.value.assign(6, kNotANumber);
  EXPECT_EQ(count_of(heat_map_svg(map), "fill=\"url(#hatch)\""), 7U);
  EXPECT_EQ(flaw_of(heat_map_svg({})), "");
}

TEST(HeatMapSvg, EscapesAllWords) {
  HeatMap map = small_map();
  map.title = map.quantity = map.x_label = map.y_label = map.columns[0] = map.rows[0] = kNasty;
  EXPECT_EQ(flaw_of(heat_map_svg(map)), "");
}

TEST(HeatMapSvg, RefusesAWrongNumberOfValues) {
  HeatMap map = small_map();
  map.value.pop_back();
  EXPECT_THROW((void)heat_map_svg(map), std::invalid_argument);
}

/// CIE L* of "#RRGGBB".
double lightness(const std::string& colour) {
  const std::array<double, 3> weight = {0.2126, 0.7152, 0.0722};
  double luminance = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = std::stoi(colour.substr(1 + 2 * i, 2), nullptr, 16) / 255.0;
    luminance += weight[i] * (c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
  }
  return 116.0 * std::cbrt(luminance) - 16.0;
}

// 20 to 90 in equal steps; a byte a channel is worth up to 0.5 of lightness.
TEST(ScaleColour, RisesEvenlyInLightness) {
  for (int i = 0; i <= 20; ++i) EXPECT_NEAR(lightness(scale_colour(i / 20.0).fill), 20.0 + 3.5 * i, 0.5) << i;
  EXPECT_EQ(scale_colour(-1.0).fill, scale_colour(0.0).fill);
  EXPECT_EQ(scale_colour(2.0).fill, scale_colour(1.0).fill);
}

// WCAG 2 asks for a contrast of at least 4.5.
TEST(ScaleColour, CarriesWordsThatCanBeRead) {
  for (int i = 0; i <= 100; ++i) {
    const ScaleColour colour = scale_colour(i / 100.0);
    const double luminance = std::pow((lightness(colour.fill) + 16.0) / 116.0, 3.0);
    const double contrast =
        std::string(colour.text) == "#FFF" ? 1.05 / (luminance + 0.05) : (luminance + 0.05) / 0.05;
    EXPECT_GE(contrast, 4.5) << i << " " << colour.fill;
  }
}

VerdictMap verdicts() {
  VerdictMap map{.title = "smoothing +-0.1",
                 .x_label = "sheath friction [N]",
                 .stiffness = {0.1, 0.2, 0.3, 0.4},
                 .columns = {},
                 .width_mm = 88.0};
  using C = CellVerdict;
  map.columns = {
      {.name = "0", .cell = {C::kStable, C::kStable, C::kUnstable, C::kNotChecked}, .k_lim = 0.2},
      {.name = "0.17",
       .cell = {C::kStable, C::kStable, C::kStable, C::kStable},
       .k_lim = 0.4,
       .at_least = true},
      {.name = "0.34", .cell = {C::kInvalid, C::kNotChecked, C::kNotChecked, C::kUnstable}, .k_lim = 0.0},
      {.name = "1", .cell = std::vector<C>(4)}};
  return map;
}

TEST(VerdictMapSvg, DrawsOneCellForEachVerdictAndTheLimit) {
  const std::string svg = verdict_map_svg(verdicts());
  keep("verdicts.svg", svg);
  EXPECT_EQ(flaw_of(svg), "");
  const auto cells = [&](const std::string& name) {
    const std::size_t begin = svg.find("<path class=\"" + name);
    return count_of(svg.substr(begin, svg.find("/>", begin) - begin), "M");
  };
  EXPECT_EQ(cells("stable"), 6U);
  EXPECT_EQ(cells("unstable"), 2U);
  EXPECT_EQ(cells("invalid"), 1U);
  EXPECT_EQ(count_of(svg, "class=\"limit\""), 3U);
  for (const char* words :
       {">stable<", ">unstable<", ">invalid<", ">not checked<", ">k_lim<", ">0.17<", ">\u22650.4<"})
    EXPECT_THAT(svg, HasSubstr(words));
}

// Four rows of 10 pt from the bottom: the limit 0.2 is the second, so its line is half way up; 0 is at the
// bottom.
TEST(VerdictMapSvg, PutsTheLimitOnTopOfItsCell) {
  const std::string svg = verdict_map_svg(verdicts());
  // Heading 22, legend and gap 22: the frame begins at 44 and is 40 high.
  EXPECT_THAT(svg, HasSubstr("class=\"limit\" d=\"M36.00,64.00h30.00\""));
  EXPECT_THAT(svg, HasSubstr("class=\"limit\" d=\"M66.00,44.00h30.00\""));
  EXPECT_THAT(svg, HasSubstr("class=\"limit\" d=\"M96.00,84.00h30.00\""));
}

// 12 pt from the left edge of a colour that is 9 wide, and before the next colour.
TEST(VerdictMapSvg, NamesEachColourBesideIt) {
  const std::string svg = verdict_map_svg(verdicts());
  const std::regex entry(R"re(<rect x="([0-9.]+)"[^>]*width="9" height="7"[^>]*/>\s*<text x="([0-9.]+)")re");
  double words = 0.0;
  int entries = 0;
  for (std::sregex_iterator found(svg.begin(), svg.end(), entry), none; found != none; ++found, ++entries) {
    const double colour = std::stod((*found)[1]);
    EXPECT_GT(colour, words);
    words = std::stod((*found)[2]);
    EXPECT_NEAR(words - colour, 12.0, 0.02);
  }
  EXPECT_EQ(entries, 4);
}

// With the fourth colour the legend is wider than 88 mm, 249.4 pt: k_lim stands below, and the frame begins 11 pt
// lower.
TEST(VerdictMapSvg, BreaksALegendThatIsTooWide) {
  VerdictMap map = verdicts();
  map.columns[0].cell[0] = CellVerdict::kSomeStable;
  const std::string svg = verdict_map_svg(map);
  keep("some_stable.svg", svg);
  EXPECT_THAT(svg, HasSubstr(">some seeds stable<"));
  const std::regex word(R"re(<text x="([0-9.]+)" y="([0-9.]+)"[^>]*>(stable|not checked|k_lim)<)re");
  std::vector<double> heights;
  for (std::sregex_iterator found(svg.begin(), svg.end(), word), none; found != none; ++found) {
    EXPECT_LT(std::stod((*found)[1]), 249.4) << (*found)[3];
    heights.push_back(std::stod((*found)[2]));
  }
  ASSERT_EQ(heights.size(), 3U);
  EXPECT_NEAR(heights.back() - heights.front(), 11.0, 0.02);
  EXPECT_THAT(svg, HasSubstr("<rect x=\"36.00\" y=\"55.00\""));
}

TEST(VerdictMapSvg, SurvivesNothingAndEscapesAllWords) {
  EXPECT_EQ(flaw_of(verdict_map_svg({})), "");
  VerdictMap map = verdicts();
  map.title = map.x_label = map.columns[0].name = kNasty;
  EXPECT_EQ(flaw_of(verdict_map_svg(map)), "");
  map.columns[0].cell.pop_back();
  EXPECT_THROW((void)verdict_map_svg(map), std::invalid_argument);
}

}  // namespace
}  // namespace phalanx
