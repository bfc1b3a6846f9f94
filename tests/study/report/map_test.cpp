// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>
#include <regex>
#include <stdexcept>

#include "phalanx/study/report/chart.h"
#include "study/report/page_checks.h"
#include "study/report/palette.h"

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
