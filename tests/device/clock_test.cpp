// SPDX-License-Identifier: Apache-2.0
// Under a held clock, which stands still until all threads sleep, but for a microsecond at some looks.
#include "phalanx/device/clock.h"

#include <gtest/gtest.h>

namespace phalanx {
namespace {

constexpr double kLooks = 20e-6;  // [s]

// The second clock begins three quarters of a second after the first: its own sleep goes over a full second.
TEST(Clock, CountsSecondsFromItsMaking) {
  const Clock first;
  EXPECT_NEAR(first.now(), 0.0, kLooks);
  EXPECT_TRUE(first.sleep_until(0.75));
  EXPECT_NEAR(first.now(), 0.75, kLooks);
  const Clock second;
  EXPECT_NEAR(second.now(), 0.0, kLooks);
  EXPECT_LE(second.now_us(), 20U);
  EXPECT_TRUE(second.sleep_until(1.5));
  EXPECT_NEAR(second.now(), 1.5, kLooks);
  EXPECT_NEAR(static_cast<double>(second.now_us()), 1.5e6, 20.0);
  EXPECT_NEAR(first.now(), 2.25, kLooks);
  EXPECT_EQ(first.slowdown(), 1.0);
}

TEST(Clock, GoesSlowerThanRealTimeIfItIsTold) {
  const Clock real;
  const Clock slow(10.0);
  EXPECT_EQ(slow.slowdown(), 10.0);
  EXPECT_TRUE(slow.sleep_until(0.35));
  EXPECT_NEAR(slow.now(), 0.35, kLooks);
  EXPECT_NEAR(real.now(), 3.5, kLooks);
}

}  // namespace
}  // namespace phalanx
