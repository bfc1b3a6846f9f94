// SPDX-License-Identifier: Apache-2.0
#include "figures/chart/axis.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "figures/chart/polyline.h"

namespace phalanx {
namespace {

using ::testing::ElementsAre;

TEST(Range, CoversTheFiniteValues) {
  Range range;
  EXPECT_TRUE(range.empty());
  range.include({3.0, std::numeric_limits<double>::quiet_NaN(), -1.0, HUGE_VAL, -HUGE_VAL});
  EXPECT_FALSE(range.empty());
  EXPECT_EQ(range.low, -1.0);
  EXPECT_EQ(range.high, 3.0);
  const Range axis = range.for_axis();
  EXPECT_EQ(axis.low, -1.0);
  EXPECT_EQ(axis.high, 3.0);
}

// An axis has an extent, and finite ticks, whatever it is for.
TEST(Range, HasAnExtentForAnAxisWhateverItsValues) {
  const Range none = Range{}.for_axis();
  EXPECT_EQ(none.low, 0.0);
  EXPECT_EQ(none.high, 1.0);
  constexpr double kMost = std::numeric_limits<double>::max();
  for (const double value : {0.0, 5.0, -5.0, 1e-300, 1e12, kMost, -kMost}) {
    Range range;
    range.include(value);
    const Range axis = range.for_axis();
    EXPECT_LT(axis.low, axis.high) << value;
    const std::vector<double> ticks = nice_ticks(axis.low, axis.high, 5);
    EXPECT_GE(ticks.size(), 2U) << value;
    for (const double tick : ticks) EXPECT_TRUE(std::isfinite(tick)) << value;
  }
  Range all;
  all.include({-kMost, kMost});
  for (const double tick : nice_ticks(all.low, all.high, 5)) EXPECT_TRUE(std::isfinite(tick));
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
