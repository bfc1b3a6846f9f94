// SPDX-License-Identifier: Apache-2.0
#include "phalanx/papers/experiments.h"

#include <gmock/gmock.h>

#include "phalanx/figures/chart.h"
#include "study/report/synthetic_study.h"
#include "support/page_checks.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;

std::vector<PaperRow> rows() {
  return {{.experiment = "s2-limit",
           .quantity = "largest stable stiffness, without smoothing",
           .unit = "N/mm",
           .paper = "0.7",
           .ours = "0.11 (made up)",
           .difference = "\u22120.59",
           .kind = RowKind::kFitted,
           .note = "made-up number"},
          {.experiment = "s2-fig4",
           .quantity = "at 0.9 N/mm with smoothing",
           .unit = "",
           .paper = "stable",
           .ours = "",
           .difference = "",
           .kind = RowKind::kPredicted,
           .note = ""},
          {.experiment = "s2-timing",
           .quantity = "step",
           .unit = "ms",
           .paper = "",
           .ours = "0.2",
           .difference = "",
           .kind = RowKind::kMeasured,
           .note = ""}};
}

std::vector<ReportSection> sections() {
  const std::string chart = heat_map_svg({.title = "map",
                                          .quantity = "q [N]",
                                          .x_label = "x",
                                          .y_label = "",
                                          .columns = {"1", "2"},
                                          .rows = {"a"},
                                          .value = {0.5, 0.7},
                                          .width_mm = 88.0});
  return {{.title = "Figure 4",
           .text = {"First paragraph.", "Second paragraph."},
           .svg = {chart, chart},
           .table = {}},
          {.title = "Sensitivity",
           .text = {},
           .svg = {},
           .table = {.header = {"friction", "k_lim"}, .rows = {{"none", "0.25"}, {"half", "0.55"}}}}};
}

TEST(ExperimentsPage, SetsEveryNumberBesideThePapers) {
  const std::string page = experiments_html(rows(), sections(), kMadeUp, "1 to 20");
  keep("experiments.html", page);
  EXPECT_EQ(flaw_of(page), "");
  for (const char* words : {">s2-limit<",
                            ">0.7<",
                            ">0.11 (made up)<",
                            ">\u22120.59<",
                            ">N/mm<",
                            ">fitted<",
                            ">predicted<",
                            ">measured<",
                            ">made-up number<",
                            ">not printed<",
                            ">not run<",
                            ">Figure 4<",
                            ">First paragraph.<",
                            ">Second paragraph.<",
                            ">Sensitivity<",
                            ">0.25<",
                            ">0.55<",
                            ">v0.0-synthetic<",
                            ">made-up CPU<",
                            ">made-up compiler 1.0<",
                            ">Nothing<",
                            ">2000-01-01T00:00:00Z<",
                            ">1 to 20<"})
    EXPECT_THAT(page, HasSubstr(words));
  EXPECT_EQ(count_of(page, "<svg"), 2U);
  EXPECT_EQ(count_of(page, "<figure>"), 1U);  // the second section has none
  EXPECT_EQ(count_of(page, "<table>"), 3U);   // the numbers, the second section's, and where it was made
  EXPECT_EQ(count_of(page, "<?xml"), 0U);
  EXPECT_EQ(page, experiments_html(rows(), sections(), kMadeUp, "1 to 20"));
}

TEST(ExperimentsPage, WithoutAnythingIsStillAPage) {
  const std::string page = experiments_html({}, {}, {});
  EXPECT_EQ(flaw_of(page), "");
  EXPECT_THAT(page, HasSubstr("No number was compared."));
}

TEST(ExperimentsPage, EscapesAllWords) {
  PaperRow row = rows()[0];
  row.experiment = row.quantity = row.unit = row.paper = row.ours = row.difference = row.note = kNasty;
  const ReportSection section = {
      .title = kNasty, .text = {kNasty}, .svg = {}, .table = {.header = {kNasty}, .rows = {{kNasty}}}};
  Made made = kMadeUp;
  made.cpu = kNasty;
  EXPECT_EQ(flaw_of(experiments_html({row}, {section}, made, kNasty)), "");
}

}  // namespace
}  // namespace phalanx
