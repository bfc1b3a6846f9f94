// SPDX-License-Identifier: Apache-2.0
// Every stabiliser in closed loop, on a wall that is soft enough for all.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "phalanx/study/trial_function.h"

namespace phalanx {
namespace {

class EveryStabiliser : public ::testing::TestWithParam<const char*> {};

TEST_P(EveryStabiliser, RunsAtHalfANewtonAMillimetre) {
  const TrialFunction trial = make_trial_function("stability_press");
  const Overrides method = {{"stabiliser.method", fmt::format("\"{}\"", GetParam())}};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const TrialResult result = trial(method, 500.0, std::numeric_limits<double>::quiet_NaN(), seed);
    for (const double number : {result.force_swing, result.position_swing, result.peak_depth,
                                result.mean_force, result.mean_depth, result.ghost_s, result.ghost_energy})
      EXPECT_TRUE(std::isfinite(number));
    EXPECT_TRUE(result.stable);
    EXPECT_TRUE(result.valid) << result.why_invalid;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryStabiliser,
                         ::testing::Values("none", "smoothing", "rise_only", "direction", "low_pass",
                                           "kelvin_voigt", "virtual_coupling", "passivity", "energy_bounding",
                                           "local_wall"));

// At 0.05 N a step of 5 ms, a press of F takes F / 10 N/s to go; the finger is out a little after it begins
// to.
TEST(StabilisersInTheLoop, LeaveAGhostWithTheSmoothingAndNoneThatLastsWithTheRiseAlone) {
  const TrialFunction trial = make_trial_function("stability_press");
  const double as_it_is = std::numeric_limits<double>::quiet_NaN();
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const TrialResult smoothed = trial({}, 500.0, as_it_is, seed);
    const TrialResult rise_only = trial({{"stabiliser.method", "\"rise_only\""}}, 500.0, as_it_is, seed);
    EXPECT_GT(smoothed.ghost_s, 0.5 * smoothed.mean_force / 10.0);
    EXPECT_LT(smoothed.ghost_s, smoothed.mean_force / 10.0 + 0.02);  // and the delays
    EXPECT_LT(rise_only.ghost_s, 0.02);                              // the delays alone
    EXPECT_LT(10.0 * rise_only.ghost_energy, smoothed.ghost_energy);
  }
}

}  // namespace
}  // namespace phalanx
