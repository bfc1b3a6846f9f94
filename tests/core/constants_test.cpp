// SPDX-License-Identifier: Apache-2.0
#include "phalanx/core/constants.h"

#include <gtest/gtest.h>

#include <cmath>

namespace phalanx {
namespace {

TEST(Constants, SayHowManyUnitsMakeOneOfThose) {
  EXPECT_DOUBLE_EQ(kPi, 3.14159265358979323846);
  EXPECT_DOUBLE_EQ(1000.0 * kMilli, 1.0);
  EXPECT_DOUBLE_EQ(1000.0 * kMm, 1.0);
  EXPECT_DOUBLE_EQ(180.0 * kDeg, 3.14159265358979323846);
  EXPECT_DOUBLE_EQ(3.14159265358979323846 * kRadToDeg, 180.0);
  EXPECT_TRUE(std::isinf(kInfinity) && kInfinity > 0.0);
}

}  // namespace
}  // namespace phalanx
