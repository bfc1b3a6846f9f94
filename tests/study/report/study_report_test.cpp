// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>

#include "phalanx/study/laboratory/report.h"
#include "study/report/study_view.h"
#include "study/report/synthetic_study.h"
#include "support/page_checks.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<double> kFrictions = {0, 0.1, 0.2, 0.34, 0.5, 0.7, 1};
const StudyAxis kFriction = numbers("device.scale.sheath_friction", "sheath friction [N]", kFrictions);
const StudyAxis kDelay = numbers("device.delay", "delay [ms]", {1, 2, 4.5, 8});

std::string page_of(const Study& study, const std::string& name = "") {
  const std::string page = study_report_html(study, synthetic_results(study), kMadeUp);
  EXPECT_EQ(flaw_of(page), "") << name;
  EXPECT_THAT(page, Not(HasSubstr("nan")));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("src=")));
  EXPECT_THAT(page, Not(HasSubstr("href=")));
  if (!name.empty()) keep(name, page);
  return page;
}

TEST(StudyReport, OfOneNumericAxisHasACurveForEachVariant) {
  const std::string page =
      page_of(synthetic_study({"none", "smoothing +-0.1", "rise-only +0.1"}, {kFriction}), "one_axis.html");
  EXPECT_EQ(count_of(page, "class=\"curve\""), 7U * 3U);  // quantities x variants
  EXPECT_EQ(count_of(page, "class=\"limit\""), kFrictions.size() * 3U);
  EXPECT_THAT(page, Not(HasSubstr("class=\"scale\"")));
  for (const char* words :
       {">k_lim [N/mm]<", ">k_eff [N/mm]<", ">peak penetration [mm]<", ">ghost time [ms]<",
        ">ghost energy [mJ]<", ">force swing [N]<", ">position swing [mm]<", "device.scale.sheath_friction",
        "step.rate = 200", "Made-up numbers", "0.1 to 4 N/mm", ">1 to 20 (20 a point)<", "more than 0.5 N"})
    EXPECT_THAT(page, HasSubstr(words));
  // Columns of numbers are set flush right.
  EXPECT_THAT(page, HasSubstr("<thead>\n<tr><th>variant</th><th class=\"n\">sheath friction [N]</th>"
                              "<th class=\"n\">k_lim [N/mm]</th><th class=\"n\">k_eff [N/mm]</th>"
                              "<th class=\"n\">peak penetration [mm]</th>"
                              "<th class=\"n\">ghost time [ms] mean (largest)</th>"
                              "<th class=\"n\">ghost energy [mJ] mean (largest)</th>"
                              "<th class=\"n\">force swing [N]</th><th class=\"n\">position swing [mm]</th>"
                              "<th class=\"n\">runs</th><th>notes</th></tr>\n</thead>"));
  EXPECT_EQ(count_of(page, "width=\"88.00mm\""), 3U);  // a map of verdicts for each variant
}

// Of up to eight columns: two of them fit beside each other. Curves are always as wide as the page.
TEST(StudyReport, TakesHalfAPageForAMapOfFewColumns) {
  std::vector<double> values = {1, 2, 3, 4, 5, 6, 7, 8};
  EXPECT_EQ(count_of(page_of(synthetic_study({}, {numbers("x.y", "x.y", values)})), "width=\"88.00mm\""), 1U);
  values.push_back(9);
  EXPECT_EQ(count_of(page_of(synthetic_study({}, {numbers("x.y", "x.y", values)})), "width=\"88.00mm\""), 0U);
}

TEST(StudyView, ShowsEachNumberInTheUnitThatItsLabelNames) {
  const Study study = synthetic_study({}, {});
  PointResult result;
  result.k_lim = 2500.0;
  result.k_eff = 1900.0;
  result.peak_depth = 1.25e-3;
  result.ghost_s = {.mean = 0.031, .largest = 0.042};
  result.ghost_energy = {.mean = 0.002, .largest = 0.003};
  result.force_swing = 0.375;
  result.position_swing = 0.02e-3;
  struct Expected {
    const char* label;
    double value;
    double largest = PointResult::kNone;
    double criterion = PointResult::kNone;
  };
  const std::vector<Expected> expected = {{"k_lim [N/mm]", 2.5},
                                          {"k_eff [N/mm]", 1.9},
                                          {"peak penetration [mm]", 1.25},
                                          {"ghost time [ms]", 31.0, 42.0},
                                          {"ghost energy [mJ]", 2.0, 3.0},
                                          {"force swing [N]", 0.375, PointResult::kNone, 0.5},
                                          {"position swing [mm]", 0.02, PointResult::kNone, 0.5}};
  const std::vector<Quantity> quantities = StudyView(study, {}).quantities();
  ASSERT_EQ(quantities.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(quantities[i].label(), expected[i].label);
    EXPECT_NEAR(quantities[i].value(result), expected[i].value, 1e-9) << expected[i].label;
    ASSERT_EQ(quantities[i].largest != nullptr, std::isfinite(expected[i].largest)) << expected[i].label;
    if (quantities[i].largest != nullptr) {
      EXPECT_NEAR(quantities[i].largest(result), expected[i].largest, 1e-9) << expected[i].label;
    }
    ASSERT_EQ(std::isfinite(quantities[i].criterion), std::isfinite(expected[i].criterion))
        << expected[i].label;
    if (std::isfinite(quantities[i].criterion)) {
      EXPECT_NEAR(quantities[i].criterion, expected[i].criterion, 1e-9) << expected[i].label;
    }
  }
}

TEST(StudyReport, SaysWhereItWasMade) {
  const std::string page = page_of(synthetic_study({}, {}));
  for (const std::string& words :
       {kMadeUp.commit, kMadeUp.cpu, kMadeUp.compiler, kMadeUp.build_type, kMadeUp.date})
    EXPECT_THAT(page, HasSubstr('>' + words + '<'));
}

// By hand: limit 1.6 N/mm, felt 1.44, 1.875 mm deep, ghost 80 (112) ms and 16 (19.2) mJ, swings 0.1 N and 0.1
// mm.
TEST(StudyReport, HasEveryNumberOfAPoint) {
  const Study study = synthetic_study({}, {});
  const std::string page = study_report_html(study, {synthetic_result(study, 0, 15)}, kMadeUp);
  EXPECT_EQ(flaw_of(page), "");
  EXPECT_THAT(page,
              HasSubstr("<td class=\"n\">1.6</td><td class=\"n\">1.44</td><td class=\"n\">1.88</td>"
                        "<td class=\"n\">80 (112)</td><td class=\"n\">16 (19.2)</td><td class=\"n\">0.1</td>"
                        "<td class=\"n\">0.1</td><td class=\"n\">100</td>"));
  keep("one_point.html", page);
}

TEST(StudyReport, OfTwoAxesHasAMapForEachVariantAndQuantity) {
  const std::string page =
      page_of(synthetic_study({"none", "smoothing"}, {kFriction, kDelay}), "two_axes.html");
  EXPECT_EQ(count_of(page, "class=\"scale\""), 24U * 7U * 2U);  // steps of a scale x quantities x variants
  EXPECT_EQ(count_of(page, "class=\"curve\""),
            7U * 4U * 2U);  // over friction: a curve for each delay and variant
  // Of half a page: a map of each quantity and variant, and one of the verdicts for each delay and variant.
  EXPECT_EQ(count_of(page, "width=\"88.00mm\""), 7U * 2U + 4U * 2U);
}

/// The d of every curve's path, in the page's order.
std::vector<std::string> curves_of(const std::string& page) {
  const std::string before = "class=\"curve\" d=\"";
  std::vector<std::string> curves;
  for (std::size_t at = page.find(before); at != std::string::npos; at = page.find(before, at + 1)) {
    const std::size_t begin = at + before.size();
    curves.push_back(page.substr(begin, page.find('"', begin) - begin));
  }
  return curves;
}

// k_lim stands first: 1 and 2 N/mm for a, 3 and 3.5 for b.
TEST(StudyReport, EachVariantsCurveIsOfItsOwnPoints) {
  const Study study = synthetic_study({"a", "b"}, {numbers("x.y", "x.y", {0, 1})});
  std::vector<PointResult> results;
  for (const int limit : {9, 19, 29, 34})
    results.push_back(synthetic_result(study, static_cast<int>(results.size()), limit));
  const std::vector<std::string> curves = curves_of(study_report_html(study, results, kMadeUp));
  ASSERT_EQ(curves.size(), 7U * 2U);
  EXPECT_NE(curves[0], curves[1]);
  // The other way round the two change places.
  std::swap(results[0].k_lim, results[2].k_lim);
  std::swap(results[1].k_lim, results[3].k_lim);
  const std::vector<std::string> exchanged = curves_of(study_report_html(study, results, kMadeUp));
  EXPECT_EQ(exchanged[0], curves[1]);
  EXPECT_EQ(exchanged[1], curves[0]);
}

// 1, 2 and 3 N/mm for x.z 0, 1.5, 2.5 and 3.5 for x.z 1. The frame is 96 pt high from 18 pt on for
// 0 to 4 N/mm, and 326.24 pt wide from 46 pt on for -0.05 to 2.05.
TEST(StudyReport, EachCurveIsOfItsOwnChoice) {
  const Study study = synthetic_study({}, {numbers("x.y", "x.y", {0, 1, 2}), numbers("x.z", "x.z", {0, 1})});
  std::vector<PointResult> results;
  for (const int limit : {9, 14, 19, 24, 29, 34})
    results.push_back(synthetic_result(study, static_cast<int>(results.size()), limit));
  const std::vector<std::string> curves = curves_of(study_report_html(study, results, kMadeUp));
  ASSERT_EQ(curves.size(), 7U * 2U);
  EXPECT_EQ(curves[0], "M53.77,90.00L209.12,66.00L364.47,42.00");
  EXPECT_EQ(curves[1], "M53.77,78.00L209.12,54.00L364.47,30.00");
}

// k_eff is 1.13, 1.23, ... 1.83 N/mm, which no scale has a mark at and nothing else is: each stands in one
// cell.
TEST(StudyReport, EachVariantsMapIsOfItsOwnPoints) {
  const Study study = synthetic_study({"a", "b"}, {words("x.y", {"u", "v"}), words("x.z", {"u", "v"})});
  std::vector<PointResult> results;
  for (int i = 0; i < 8; ++i) {
    results.push_back(synthetic_result(study, i, 9));
    results.back().k_eff = 1130.0 + 100.0 * i;
  }
  const std::string page = study_report_html(study, results, kMadeUp);
  for (const char* cell : {"1.13", "1.23", "1.33", "1.43", "1.53", "1.63", "1.73", "1.83"})
    EXPECT_EQ(count_of(page, '>' + std::string(cell) + "</text>"), 1U) << cell;
  // Row after row, with the first axis' words along the bottom and the second one's changing fastest in the
  // results.
  std::size_t last = 0;
  for (const char* cell : {"1.13", "1.33", "1.23", "1.43", "1.53", "1.73", "1.63", "1.83"}) {
    const std::size_t at = page.find('>' + std::string(cell) + "</text>");
    EXPECT_GT(at, last) << cell;
    last = at;
  }
}

TEST(StudyReport, OfVariantsAloneHasBars) {
  const Study study = synthetic_study({"none", "smoothing +-0.1", "smoothing +-0.05", "local wall"}, {});
  const std::string page = page_of(study, "variants.html");
  EXPECT_EQ(count_of(page, "class=\"bar\""), 7U * 4U);
  EXPECT_THAT(page, Not(HasSubstr("To note")));
  EXPECT_THAT(page, Not(HasSubstr("class=\"curve\"")));
}

TEST(StudyReport, OfVariantsAndWordsHasMaps) {
  const Study study =
      synthetic_study({"none", "smoothing"}, {words("device.file", {"beihang", "light", "frictionless"})});
  const std::string page = page_of(study, "words.html");
  EXPECT_EQ(count_of(page, "class=\"scale\""), 24U * 7U);
  EXPECT_THAT(page, HasSubstr(">frictionless<"));
}

TEST(StudyReport, OfManyAxesSaysWhatItLeavesOut) {
  const Study study = synthetic_study(
      {"a", "b", "c"}, {kFriction, kDelay, numbers("x.y", "stiffness [N/m]", {1, 2, 3, 4, 5})});
  const std::string page = page_of(study, "many_axes.html");
  EXPECT_THAT(page, HasSubstr("Maps of 12 of 15 combinations"));
  EXPECT_THAT(page, HasSubstr("60 curves would be too many"));
  EXPECT_THAT(page, HasSubstr("40 of 60 maps are drawn; 20 are left out."));
}

TEST(StudyReport, WithoutAGridHasNoLimit) {
  Study study = synthetic_study({"none", "smoothing"}, {kFriction});
  std::vector<PointResult> results = synthetic_results(study);
  study.stiffness.reset();
  for (PointResult& result : results) {
    result.k_lim = PointResult::kNone;
    result.checked = {{.n_per_mm = PointResult::kNone}};
  }
  results[3].stable = false;
  const std::string page = study_report_html(study, results, kMadeUp);
  keep("no_grid.html", page);
  EXPECT_EQ(flaw_of(page), "");
  EXPECT_THAT(page, Not(HasSubstr("k_lim")));
  EXPECT_THAT(page, Not(HasSubstr("class=\"limit\"")));
  EXPECT_THAT(page,
              HasSubstr("Not stable at the stiffness of the scene: 1 point (none, sheath friction 0.34 N)."));
}

TEST(StudyReport, StatesThatALimitIsTracedAndHasNoEffectiveStiffnessThen) {
  Study study = synthetic_study({"none", "smoothing"}, {kFriction});
  study.stiffness->search = StiffnessSearch::kTrace;
  const std::string page = page_of(study);
  EXPECT_EQ(flaw_of(page), "");
  EXPECT_THAT(page, HasSubstr("in steps of 0.1, traced<"));
  EXPECT_THAT(page, HasSubstr("k_eff is not measured."));
  EXPECT_THAT(page, Not(HasSubstr("k_eff [N/mm]")));
}

// A seed alone was stable at 2 N/mm, above the limit of 0.6 N/mm that another one has.
TEST(StudyReport, ShowsWhereSomeSeedsAloneWereStable) {
  Study study = synthetic_study({"none", "smoothing"}, {kFriction});
  std::vector<PointResult> results = synthetic_results(study);
  EXPECT_THAT(study_report_html(study, results, kMadeUp), Not(HasSubstr("some seeds stable")));
  study.stiffness->search = StiffnessSearch::kTrace;
  results[0].checked = {{.n_per_mm = 0.6, .verdict = Verdict::kStable, .seeds_run = study.seeds},
                        {.n_per_mm = 0.7, .verdict = Verdict::kUnstable, .seeds_run = 1},
                        {.n_per_mm = 2.0, .verdict = Verdict::kStable, .seeds_run = 1}};
  const std::string page = study_report_html(study, results, kMadeUp);
  EXPECT_EQ(flaw_of(page), "");
  EXPECT_THAT(page, HasSubstr(">some seeds stable<"));
  EXPECT_THAT(page, HasSubstr("<path class=\"some_stable\""));
  EXPECT_THAT(page, HasSubstr("At no point was a seed stable above a stiffness at which it was not."));
}

TEST(StudyReport, WarnsOfWhatIsMissingInvalidOrAtTheEdge) {
  const Study study = synthetic_study({"none", "smoothing"}, {kFriction});
  std::vector<PointResult> results = synthetic_results(study);
  results[0] = synthetic_result(study, 0, -1);
  results[1] = synthetic_result(study, 1, 39);
  results[2].ends_in_invalid = true;
  results[2].invalid_trials = 3;
  results[2].why_invalid = "the torque limit acted & <stopped> it";
  results[3].non_monotone = true;
  results[3].checked.push_back({.n_per_mm = 3.7, .verdict = Verdict::kStable});
  results[4].k_eff_seeds = 7;
  results.erase(results.begin() + 10);
  const std::string page = study_report_html(study, results, kMadeUp);
  keep("warnings.html", page);
  EXPECT_EQ(flaw_of(page), "");
  for (const char* words :
       {"13 of 14 points are finished",
        "Not finished, of 14 points: 1 point (smoothing, sheath friction 0.34 N).",
        "Not even the smallest stiffness, 0.1 N/mm, is stable", "Stable up to the end of the grid, 4 N/mm",
        "3 of 102 runs were invalid", "the torque limit acted &amp; &lt;stopped&gt; it.",
        "What ends the search is an invalid run", "stable again at 3.7 N/mm, above", "not monotone",
        "k_eff of 7 seeds", ">missing<", ">&lt; 0.1<", ">\u2265 4<"})
    EXPECT_THAT(page, HasSubstr(words));
}

// Ten points of 31 have nothing that is stable and end in invalid runs, two each: 20 of 100 + ... + 109 runs.
// Eight of the points are named, and of the axis' values all but the last but one.
TEST(StudyReport, NamesTheFirstEightOfManyPointsAndCountsTheRest) {
  std::vector<double> values;
  for (int i = 0; i < 31; ++i) values.push_back(i);
  const Study study = synthetic_study({}, {numbers("x.y", "x.y", values)});
  std::vector<PointResult> results;
  for (int i = 0; i < 31; ++i) {
    results.push_back(synthetic_result(study, i, i < 10 ? -1 : 9));
    if (i >= 10) continue;
    results.back().ends_in_invalid = true;
    results.back().invalid_trials = 2;
    results.back().why_invalid = "no contact";
  }
  const std::string page = study_report_html(study, results, kMadeUp);
  EXPECT_EQ(flaw_of(page), "");
  const std::string ten = "10 points (x.y 0; x.y 1; x.y 2; x.y 3; x.y 4; x.y 5; x.y 6; x.y 7; and 2 more).";
  EXPECT_THAT(page,
              HasSubstr("Already at the smallest stiffness, 0.1 N/mm, a run is invalid; nothing is known "
                        "of the limit, which is shown as 0: " +
                        ten));
  EXPECT_THAT(
      page, HasSubstr("20 of 1045 runs were invalid and count as not stable, at " +
                      ten.substr(0, ten.size() - 1) + ". Why the first one at each point was: no contact."));
  EXPECT_THAT(page, Not(HasSubstr("Not even the smallest stiffness")));
  EXPECT_THAT(page, Not(HasSubstr("What ends the search")));
  EXPECT_THAT(page, HasSubstr("27, 28, \u2026, 30 (31 values)"));
  values.pop_back();
  EXPECT_THAT(page_of(synthetic_study({}, {numbers("x.y", "x.y", values)})), HasSubstr("27, 28, 29<"));
}

TEST(StudyReport, WithoutAnyResultIsStillAPage) {
  for (const Study& study :
       {synthetic_study({}, {}), synthetic_study({"a", "b"}, {}), synthetic_study({}, {kFriction, kDelay})}) {
    const std::string page = study_report_html(study, {}, kMadeUp);
    EXPECT_EQ(flaw_of(page), "");
    EXPECT_THAT(page, HasSubstr("0 of "));
    EXPECT_THAT(page, Not(HasSubstr("nan")));
  }
}

TEST(StudyReport, OfAStudyThatRunsStatesItsProgressAndLoadsItselfAgain) {
  const Study study = synthetic_study({"a", "b"}, {kFriction});
  const std::string page = study_report_html(study, {}, kMadeUp, "3/8 points, 2 < 3 workers");
  EXPECT_EQ(flaw_of(page), "");
  EXPECT_THAT(page, HasSubstr("It runs: 3/8 points, 2 &lt; 3 workers (at 2000-01-01T00:00:00Z)."));
  EXPECT_THAT(page, HasSubstr("<meta http-equiv=\"refresh\" content=\"10\"/>"));
  EXPECT_THAT(study_report_html(study, {}, kMadeUp), Not(HasSubstr("http-equiv")));
}

TEST(StudyReport, EscapesAllWords) {
  Study study = synthetic_study({kNasty, "b"}, {kFriction, words("a.b", {kNasty, "c"})});
  study.name = study.title = study.scene = study.axes[0].label = kNasty;
  page_of(study);
}

TEST(StudyReport, OfTwoThousandPointsStaysSmallAndTheSame) {
  std::vector<double> many;
  for (int i = 0; i < 250; ++i) many.push_back(0.01 * i);
  const Study line = synthetic_study({"a", "b", "c", "d", "e", "f", "g", "h"}, {numbers("a.b", "a.b", many)});
  many.resize(50);
  const Study plane = synthetic_study(
      {}, {numbers("a.b", "a.b", many), numbers("c.d", "c.d", {many.begin(), many.begin() + 40})});
  for (const Study& study : {line, plane}) {
    ASSERT_EQ(point_count(study), 2000);
    const std::string page = page_of(study, study.axes.size() == 1 ? "long_line.html" : "large_plane.html");
    EXPECT_LT(page.size(), 4'000'000U);
    EXPECT_TRUE(page == page_of(study));
  }
}

TEST(StudyReport, OfManyPointsListsTheFirstFiveThousand) {
  std::vector<double> many;
  for (int i = 0; i < 9000; ++i) many.push_back(i);
  const std::string page = study_report_html(synthetic_study({}, {numbers("a.b", "a.b", many)}), {}, kMadeUp);
  EXPECT_EQ(flaw_of(page), "");
  EXPECT_THAT(page, HasSubstr("The first 5000 of 9000 points"));
  EXPECT_THAT(page, HasSubstr("4999</td>"));
  EXPECT_THAT(page, Not(HasSubstr("5000</td>")));
}

TEST(StudyReport, HasNoMapOfMoreCellsThanAPageCarries) {
  std::vector<double> many;
  for (int i = 0; i < 300; ++i) many.push_back(i);
  const std::vector<PointResult> none;
  const Study square = synthetic_study({}, {numbers("a.b", "a.b", many), numbers("c.d", "c.d", many)});
  const std::string page = study_report_html(square, none, kMadeUp);
  EXPECT_EQ(flaw_of(page), "");
  EXPECT_THAT(page, HasSubstr("Maps of 300 by 300 cells would be too large"));
  EXPECT_LT(page.size(), 4'000'000U);
  many.resize(100);
  const Study cube = synthetic_study({}, {numbers("a.b", "a.b", many), numbers("c.d", "c.d", many),
                                          numbers("e.f", "e.f", {1.0, 2.0, 3.0, 4.0})});
  const std::string some = study_report_html(cube, none, kMadeUp);
  EXPECT_EQ(flaw_of(some), "");
  EXPECT_THAT(some, ::testing::ContainsRegex("Maps of [1-3] of 4 combinations"));
  EXPECT_LT(some.size(), 20'000'000U);
}

TEST(StudyReport, RefusesAResultOfNoPoint) {
  const Study study = synthetic_study({"a", "b"}, {});
  std::vector<PointResult> results = synthetic_results(study);
  results[1].index = 2;
  EXPECT_THROW((void)study_report_html(study, results, kMadeUp), std::invalid_argument);
  results[1].index = 0;
  EXPECT_THROW((void)study_report_html(study, results, kMadeUp), std::invalid_argument);
}

}  // namespace
}  // namespace phalanx
