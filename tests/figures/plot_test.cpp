// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/plot.h"

#include <gmock/gmock.h>

#include <numeric>

#include "figures/plot/panel.h"
#include "figures/plot/polyline.h"
#include "figures/plot/ticks.h"
#include "phalanx/figures/trace.h"

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// Whether every element is closed by its own end tag, in order, and no bare & or < is left in text.
bool well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t i = 0; i < xml.size();) {
    if (xml[i] == '&') {
      const std::size_t end = xml.find(';', i);
      if (end == std::string::npos || end - i > 6) return false;
    }
    if (xml[i] != '<') {
      ++i;
      continue;
    }
    const std::size_t end = xml.find('>', i);
    if (end == std::string::npos) return false;
    const std::string tag = xml.substr(i + 1, end - i - 1);
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return false;
    const std::string name =
        tag.substr(tag[0] == '/' ? 1 : 0, tag.find_first_of(" /", 1) - (tag[0] == '/' ? 1 : 0));
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
    } else if (tag[0] != '?' && tag.back() != '/') {
      open.push_back(name);
    }
    i = end + 1;
  }
  return open.empty();
}

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t n = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

/// One second in which `segments` segments carry 1, 2, ... N and MCP flexion of the index finger 0.1 Nm and
/// 30 degrees.
Trace trace_with(std::size_t segments) {
  Trace trace;
  for (int i = 0; i <= 100; ++i) {
    TraceTick tick;
    tick.time_s = 0.01 * i;
    const double share = 0.01 * i;
    for (std::size_t s = 0; s < segments; ++s) {
      tick.force_raw[s] = 1.5 * share * static_cast<double>(s + 1);
      tick.force[s] = share * static_cast<double>(s + 1);
    }
    tick.torque[4] = -0.1 * share;
    tick.hcp_angle[4] = 0.6 * share;
    tick.gdp_angle[4] = 0.5 * share;
    trace.push_back(tick);
  }
  return trace;
}

TEST(PlotSvg, IsWellFormedWhateverTheTitle) {
  const std::string svg =
      plot_svg(trace_with(3),
               {.title = "a <b> & \"c\"", .subtitle = "k < 1 & more", .parameters = std::string(400, 'x')});
  EXPECT_TRUE(well_formed(svg));
  EXPECT_THAT(svg, HasSubstr("a &lt;b&gt; &amp; &quot;c&quot;"));
  EXPECT_THAT(svg, HasSubstr("width=\"180mm\""));
  EXPECT_THAT(svg, HasSubstr("x\u2026<"));
}

TEST(PlotSvg, DrawsSentAndLawOfEveryTouchingSegmentAndNothingElse) {
  const std::string svg = plot_svg(trace_with(3), {});
  // Three forces, one torque, one angle; dashed: three laws and the measured angle.
  EXPECT_EQ(count(svg, "class=\"solid\""), 5U);
  EXPECT_EQ(count(svg, "class=\"dashed\""), 4U);
  EXPECT_THAT(svg, HasSubstr(">thumb metacarpal<"));
  EXPECT_THAT(svg, HasSubstr(">index MCP flexion<"));
  EXPECT_THAT(svg, Not(HasSubstr("index distal")));
  EXPECT_THAT(svg, Not(HasSubstr(" shown<")));
}

TEST(PlotSvg, SaysHowManyOfManyCurvesItShows) {
  const std::string svg = plot_svg(trace_with(14), {});
  EXPECT_THAT(svg, HasSubstr(">8 of 14 shown<"));
  EXPECT_EQ(count(svg, "class=\"solid\""), 10U);
  // The largest are shown: segments 6 to 13.
  EXPECT_THAT(svg, Not(HasSubstr(">index distal<")));
  EXPECT_THAT(svg, HasSubstr(">middle proximal<"));
}

// The law asks for 100 N of the ring finger and nothing is sent to it: the eight that are sent a force come
// first.
TEST(PlotSvg, ShowsWhatIsSentBeforeWhatTheLawAlone) {
  Trace trace = trace_with(8);
  for (TraceTick& tick : trace) tick.force_raw[9] = 100.0;
  const std::string svg = plot_svg(trace, {});
  EXPECT_THAT(svg, HasSubstr(">8 of 9 shown<"));
  EXPECT_THAT(svg, HasSubstr(">thumb metacarpal<"));
  EXPECT_THAT(svg, Not(HasSubstr(">ring proximal<")));
}

TEST(PlotSvg, SaysWhenNothingTouched) {
  const Trace rest(10);
  const std::string svg = plot_svg(rest, {});
  EXPECT_TRUE(well_formed(svg));
  EXPECT_THAT(svg, HasSubstr("no segment touched"));
  EXPECT_THAT(svg, HasSubstr("no joint carried torque"));
}

TEST(PlotSvg, SurvivesNumbersThatAreNotFinite) {
  Trace trace = trace_with(2);
  trace[50].force[0] = std::numeric_limits<double>::quiet_NaN();
  trace[51].force_raw[0] = std::numeric_limits<double>::infinity();
  const std::string svg = plot_svg(trace, {});
  EXPECT_TRUE(well_formed(svg));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(TraceTick, HasTheSnapshotsForcesTorquesAndAngles) {
  Snapshot snapshot;
  snapshot.time_s = 0.25;
  snapshot.segment[5].force_raw = 2.0;
  snapshot.segment[5].force = 1.5;
  snapshot.hcp_angle[4] = 0.6;
  snapshot.gdp_angle[4] = 0.5;
  snapshot.torque[4] = -0.1;
  const TraceTick tick = trace_tick(snapshot);
  EXPECT_EQ(tick.time_s, 0.25);
  EXPECT_EQ(tick.force_raw[5], 2.0);
  EXPECT_EQ(tick.force[5], 1.5);
  EXPECT_EQ(tick.hcp_angle[4], 0.6);
  EXPECT_EQ(tick.gdp_angle[4], 0.5);
  EXPECT_EQ(tick.torque[4], -0.1);
}

TEST(PlotSvg, RefusesARunWithoutTicks) { EXPECT_THROW((void)plot_svg({}, {}), std::invalid_argument); }

/// From 1 to 3 s, 200 points wide.
PanelFrame frame_of(double height) {
  return {.x = 100.0,
          .y = 50.0,
          .width = 200.0,
          .height = height,
          .legend_x = 310.0,
          .time_low = 1.0,
          .time_high = 3.0,
          .time_ticks = {1.0, 2.0, 3.0},
          .time_labels = true};
}

// 100 points for each second, and 20 for each newton of the axis from 0 to 4, downwards.
TEST(DrawPanel, PutsEachSampleAndEachTickWhereItsTimeAndValueBelong) {
  const Panel panel{.title = "force",
                    .y_label = "N",
                    .solid_means = "",
                    .dashed_means = "",
                    .note = "",
                    .empty = "",
                    .curves = {{.label = "index", .solid = {0.0, 4.0, 2.0}, .dashed = {}}}};
  const std::string svg = draw_panel(panel, frame_of(80.0), {1.0, 2.0, 3.0}, "clip");
  EXPECT_THAT(svg, HasSubstr("d=\"M100.00,130.00L200.00,50.00L300.00,90.00\""));
  EXPECT_THAT(svg, HasSubstr("M200.00,50.00v80.00"));
  EXPECT_THAT(svg, HasSubstr("M100.00,90.00h200.00"));
  EXPECT_THAT(svg, Not(HasSubstr("stroke=\"#888\"")));  // no line at zero inside the frame
}

std::string panel_of(Curve curve) {
  const Panel panel{.title = "force",
                    .y_label = "N",
                    .solid_means = "sent",
                    .dashed_means = "asked",
                    .note = "note",
                    .empty = "",
                    .curves = {std::move(curve)},
                    .clip_dashed = true};
  return draw_panel(panel, frame_of(90.0), {1.0, 2.0, 3.0}, "clip");
}

// The solid curve reaches 2 and the dashed one five times that: the axis ends at 1.5 times 2, 30 points for
// each newton, and the dashed curve a frame's height above it. The legend's lines are 11.5 points apart, 1.5
// more below the curves.
TEST(DrawPanel, LeavesADashedCurveOutsideThatWouldDwarfTheSolidOne) {
  const std::string svg = panel_of({.label = "index", .solid = {0.0, 2.0, 1.0}, .dashed = {0.0, 10.0, 0.0}});
  for (const char* piece :
       {"class=\"solid\" d=\"M100.00,140.00L200.00,80.00L300.00,110.00\"",
        "class=\"dashed\" d=\"M100.00,140.00L200.00,-40.00L300.00,140.00\"", "d=\"M310.00,53.00h18\"",
        "translate(319.00,53.00)", "<text x=\"333.00\" y=\"55.80\" fill=\"#000\">index<",
        "d=\"M310.00,66.00h18\"", "<text x=\"333.00\" y=\"68.80\" fill=\"#555\">sent<",
        "d=\"M310.00,77.50h18\"", "<text x=\"333.00\" y=\"80.30\" fill=\"#555\">asked<",
        "<text x=\"310.00\" y=\"91.80\" fill=\"#555\">dashed up to 10, off scale<",
        "<text x=\"310.00\" y=\"103.30\" fill=\"#555\">note<"})
    EXPECT_EQ(count(svg, piece), 1U) << piece;
}

// Two and a half times as high is still drawn whole, on an axis from 0 to 6.
TEST(DrawPanel, KeepsADashedCurveThatFits) {
  const std::string svg = panel_of({.label = "index", .solid = {0.0, 2.0, 1.0}, .dashed = {0.0, 5.0, 0.0}});
  EXPECT_THAT(svg, Not(HasSubstr("off scale")));
  EXPECT_THAT(svg, HasSubstr("class=\"dashed\" d=\"M100.00,140.00L200.00,65.00L300.00,140.00\""));
}

TEST(DrawPanel, DrawsALineAtZeroInsideTheFrame) {
  EXPECT_THAT(panel_of({.label = "index", .solid = {-2.0, 0.0, 2.0}, .dashed = {}}),
              HasSubstr("d=\"M100.00,95.00h200.00\" stroke=\"#888\""));
}

TEST(NiceTicks, AreRoundNumbersAroundTheData) {
  EXPECT_THAT(nice_ticks(0.0, 3.9, 5), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(nice_ticks(-0.3, 0.0, 4), ElementsAre(::testing::DoubleEq(-0.3), ::testing::DoubleEq(-0.2),
                                                    ::testing::DoubleEq(-0.1), 0));
  EXPECT_THAT(nice_ticks(0.0, 640.0, 5), ElementsAre(0, 200, 400, 600, 800));
}

TEST(TickLabel, HasTheDecimalsThatTheSpacingNeeds) {
  EXPECT_EQ(tick_label(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(tick_label(-0.02, 0.02), "\u22120.02");
  EXPECT_EQ(tick_label(200.0, 50.0), "200");
  EXPECT_EQ(tick_label(-1e-17, 0.5), "0");
  EXPECT_EQ(tick_label(100.2, 100.3 - 100.2), "100.2");  // a little less than 0.1 by rounding
}

TEST(Thinned, KeepsEveryExtreme) {
  std::vector<double> values(100'000, 0.0);
  values[12'345] = 7.0;
  values[54'321] = -7.0;
  const auto kept = thinned(values, 100);
  EXPECT_LE(kept.size(), 400U);
  EXPECT_NE(std::find(kept.begin(), kept.end(), 12'345U), kept.end());
  EXPECT_NE(std::find(kept.begin(), kept.end(), 54'321U), kept.end());
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_EQ(kept.front(), 0U);
  EXPECT_EQ(kept.back(), 99'999U);
}

TEST(Thinned, DropsOnlyTheInsideOfLevelStretchesOfAShortCurve) {
  EXPECT_THAT(thinned({1, 1, 1, 2, 3, 3, 3}, 10), ElementsAre(0, 2, 3, 4, 6));
}

TEST(Thinned, KeepsTheLastPointWhateverLiesBehindIt) {
  std::vector<double> level(4, 1.0);
  level.pop_back();  // behind the end stands the fourth value still, which would make the last point an inner
                     // one
  EXPECT_THAT(thinned(level, 10), ElementsAre(0, 2));
}

}  // namespace
}  // namespace phalanx
