// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/step_times.h"

#include <gmock/gmock.h>

#include <numeric>

namespace phalanx {
namespace {

// 1..1000 in reverse: the nearest rank of p percent is the value 10 p itself.
TEST(StepTimes, AreTheNearestRanks) {
  std::vector<double> us(1000);
  std::iota(us.rbegin(), us.rend(), 1.0);
  const StepTimes times = step_times(us);
  EXPECT_EQ(times.p50, 500.0);
  EXPECT_EQ(times.p90, 900.0);
  EXPECT_EQ(times.p99, 990.0);
  EXPECT_EQ(times.p999, 999.0);
  EXPECT_EQ(times.max, 1000.0);
  EXPECT_EQ(times.mean, 500.5);
}

// Of three values half is 1.5 values, so the second; 90 % is 2.7 values, so the third.
TEST(StepTimes, RoundARankUp) {
  const StepTimes times = step_times({30.0, 10.0, 20.0});
  EXPECT_EQ(times.p50, 20.0);
  EXPECT_EQ(times.p90, 30.0);
  EXPECT_EQ(times.p999, 30.0);
}

TEST(StepTimes, OfOneStepAreThatStep) {
  const StepTimes times = step_times({4.2});
  EXPECT_EQ(times.p50, 4.2);
  EXPECT_EQ(times.max, 4.2);
}

TEST(StepTimes, OfNoStepsAreZero) {
  const StepTimes times = step_times({});
  for (const double time : {times.p50, times.p90, times.p99, times.p999, times.max, times.mean})
    EXPECT_EQ(time, 0.0);
}

}  // namespace
}  // namespace phalanx
