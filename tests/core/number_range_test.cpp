// SPDX-License-Identifier: Apache-2.0
#include "phalanx/core/number_range.h"

#include <gtest/gtest.h>

#include <limits>

namespace phalanx {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(NumberRange, HoldsItsEndsUnlessTheyAreOpen) {
  constexpr NumberRange closed = between(-1, 2);
  for (const double in : {-1.0, 0.0, 2.0}) EXPECT_TRUE(closed.contains(in)) << in;
  for (const double out : {-1.001, 2.001}) EXPECT_FALSE(closed.contains(out)) << out;
  constexpr NumberRange open = {.min = -1, .max = 2, .min_open = true, .max_open = true};
  for (const double in : {-0.999, 1.999}) EXPECT_TRUE(open.contains(in)) << in;
  for (const double out : {-1.0, 2.0}) EXPECT_FALSE(open.contains(out)) << out;
  EXPECT_FALSE(above(0, 1).contains(0.0));
  EXPECT_TRUE(above(0, 1).contains(1.0));
}

TEST(NumberRange, HoldsFiniteNumbersOnlyAndMinusInfinityIfItSaysSo) {
  for (const double number : {kInf, -kInf, kNan}) EXPECT_FALSE(NumberRange{}.contains(number)) << number;
  constexpr NumberRange unbounded = {.min = -1, .max = 0, .allows_minus_infinity = true};
  EXPECT_TRUE(unbounded.contains(-kInf));
  for (const double number : {-2.0, kInf, kNan}) EXPECT_FALSE(unbounded.contains(number)) << number;
}

TEST(NumberRange, IsDescribedInWords) {
  EXPECT_EQ(between(1, 4000).text(), ">= 1, <= 4000");
  EXPECT_EQ(above(0, 0.1).text(), "> 0, <= 0.1");
  EXPECT_EQ((NumberRange{.min = -1e6, .max = 0, .max_open = true, .allows_minus_infinity = true}).text(),
            ">= -1000000, < 0, or -inf");
  EXPECT_EQ((NumberRange{.max = 3}).text(), "<= 3");
  EXPECT_EQ(NumberRange{}.text(), "any finite number");
}

TEST(ShortestText, ReadsBackAsTheSameNumber) {
  EXPECT_EQ(shortest_text(0.0), "0");
  EXPECT_EQ(shortest_text(0.1), "0.1");
  EXPECT_EQ(shortest_text(1e-4), "0.0001");
  EXPECT_EQ(shortest_text(1e-5), "1e-05");
  EXPECT_EQ(shortest_text(9007199254740992.0), "9007199254740992");
  EXPECT_EQ(shortest_text(1e16), "1e+16");
  EXPECT_EQ(shortest_text(-2.2250738585072014e-308), "-2.2250738585072014e-308");
  EXPECT_EQ(shortest_text(-std::numeric_limits<double>::max()), "-1.7976931348623157e+308");
  EXPECT_EQ(shortest_text(kInf), "inf");
  EXPECT_EQ(shortest_text(kNan), "nan");
}

}  // namespace
}  // namespace phalanx
