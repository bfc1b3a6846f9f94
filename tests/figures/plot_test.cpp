// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/plot.h"

#include <gmock/gmock.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "support/page_checks.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

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
  EXPECT_EQ(flaw_of(svg), "");
  EXPECT_THAT(svg, HasSubstr("a &lt;b&gt; &amp; &quot;c&quot;"));
  EXPECT_THAT(svg, HasSubstr("width=\"180.00mm\""));
  EXPECT_THAT(svg, HasSubstr("x\u2026<"));
}

TEST(PlotSvg, DrawsSentAndLawOfEveryTouchingSegmentAndNothingElse) {
  const std::string svg = plot_svg(trace_with(3), {});
  // Three forces, one torque, one angle; dashed: three laws and the measured angle.
  EXPECT_EQ(count_of(svg, "class=\"curve\""), 5U);
  EXPECT_EQ(count_of(svg, "class=\"companion\""), 4U);
  EXPECT_THAT(svg, HasSubstr(">thumb metacarpal<"));
  EXPECT_THAT(svg, HasSubstr(">index MCP flexion<"));
  EXPECT_THAT(svg, Not(HasSubstr("index distal")));
  EXPECT_THAT(svg, Not(HasSubstr(" shown<")));
}

TEST(PlotSvg, MarksACompletedAngle) {
  Trace trace = trace_with(1);
  EXPECT_THAT(plot_svg(trace, {}), Not(HasSubstr("completed")));
  trace.back().angle_origin[4] = AngleOrigin::kCompleted;
  EXPECT_EQ(count_of(plot_svg(trace, {}), "(completed)<"), 1U);
}

TEST(PlotSvg, SaysHowManyOfManyCurvesItShows) {
  const std::string svg = plot_svg(trace_with(14), {});
  EXPECT_THAT(svg, HasSubstr(">8 of 14 shown<"));
  EXPECT_EQ(count_of(svg, "class=\"curve\""), 10U);
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
  EXPECT_EQ(flaw_of(svg), "");
  EXPECT_THAT(svg, HasSubstr("no segment touched"));
  EXPECT_THAT(svg, HasSubstr("no joint carried torque"));
}

TEST(PlotSvg, SurvivesNumbersThatAreNotFinite) {
  Trace trace = trace_with(2);
  trace[50].force[0] = std::numeric_limits<double>::quiet_NaN();
  trace[51].force_raw[0] = std::numeric_limits<double>::infinity();
  const std::string svg = plot_svg(trace, {});
  EXPECT_EQ(flaw_of(svg), "");
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

}  // namespace
}  // namespace phalanx
