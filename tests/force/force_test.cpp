// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "phalanx/core/constants.h"
#include "phalanx/force/force_law.h"
#include "phalanx/force/stabiliser_methods.h"

namespace phalanx {
namespace {

// 2 mm into a 500 N/m wall is 1 N, by hand.
TEST(ForceLaw, HookeIsStiffnessTimesDepth) {
  const ForceLawParameters law{.law = ForceLaw::kHooke, .stiffness = 500.0};
  EXPECT_DOUBLE_EQ(law_force(law, 2e-3, 0.7), 1.0);
}

// 2 mm at 0.1 m/s into 500 N/m and 3 N s/m: 1 N + 0.3 N. Leaving at 1 m/s it would pull: 0.
TEST(ForceLaw, KelvinVoigtAddsDampingAndNeverPulls) {
  const ForceLawParameters law{.law = ForceLaw::kKelvinVoigt, .stiffness = 500.0, .damping = 3.0};
  EXPECT_DOUBLE_EQ(law_force(law, 2e-3, 0.1), 1.3);
  EXPECT_EQ(law_force(law, 2e-3, -1.0), 0.0);
}

// At 1 mm: k d = 0.5 N whatever n. At 4 mm with n = 1.5: 0.5 N x 4^1.5 = 4 N; closing at 0.1 m/s with a = 2
// s/m: x 1.2.
TEST(ForceLaw, HuntCrossleyIsAPowerLawWithDampingThatStartsFromZero) {
  const ForceLawParameters law{.law = ForceLaw::kHuntCrossley,
                               .stiffness = 500.0,
                               .hunt_crossley_exponent = 1.5,
                               .hunt_crossley_damping = 2.0};
  EXPECT_DOUBLE_EQ(law_force(law, 1e-3, 0.0), 0.5);
  EXPECT_NEAR(law_force(law, 4e-3, 0.0), 4.0, 1e-12);
  EXPECT_NEAR(law_force(law, 4e-3, 0.1), 4.8, 1e-12);
  EXPECT_LT(law_force(law, 1e-9, 1.0), 1e-6);
  EXPECT_EQ(law_force(law, 1e-3, -1.0), 0.0);
}

// 2 mm: 1 N + 5e7 x 8e-9 = 1.4 N.
TEST(ForceLaw, DuffingAddsACube) {
  const ForceLawParameters law{.law = ForceLaw::kDuffing, .stiffness = 500.0, .cubic = 5e7};
  EXPECT_DOUBLE_EQ(law_force(law, 2e-3, 0.0), 1.4);
}

// Linear to 2 mm, then the cube of the excess: at 3 mm 1.5 N + 5e7 x 1e-9 = 1.55 N; no jump in value or slope
// at 2 mm.
TEST(ForceLaw, LinearThenCubicIsContinuousWithItsSlope) {
  const ForceLawParameters law{
      .law = ForceLaw::kLinearThenCubic, .stiffness = 500.0, .cubic = 5e7, .linear_depth = 2e-3};
  EXPECT_DOUBLE_EQ(law_force(law, 2e-3, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(law_force(law, 3e-3, 0.0), 1.55);
  const double h = 1e-7;
  EXPECT_NEAR((law_force(law, 2e-3 + h, 0.0) - law_force(law, 2e-3 - h, 0.0)) / (2.0 * h), 500.0, 1e-4);
}

TEST(ForceLaw, NoneOfThemPushesWithoutDepth) {
  for (const ForceLaw kind : {ForceLaw::kHooke, ForceLaw::kKelvinVoigt, ForceLaw::kHuntCrossley,
                              ForceLaw::kDuffing, ForceLaw::kLinearThenCubic}) {
    const ForceLawParameters law{.law = kind};
    EXPECT_EQ(law_force(law, 0.0, 1.0), 0.0);
    EXPECT_EQ(law_force(law, -1e-3, 1.0), 0.0);
    EXPECT_GT(law_force(law, 1e-3, 0.0), 0.0);
  }
}

// A number that names no law, as a caller of the library may set it.
TEST(ForceLaw, ANumberThatIsNoLawPushesNothing) {
  const ForceLawParameters law{.law = static_cast<ForceLaw>(77), .stiffness = 500.0};
  EXPECT_EQ(law_force(law, 2e-3, 0.1), 0.0);
  EXPECT_EQ(law_slope(law, 2e-3), 0.0);
}

TEST(ForceLaw, LowPassReachesSixtyThreePercentAfterItsTimeConstant) {
  const double corner = 20.0;
  const double time_constant = 1.0 / (2.0 * std::numbers::pi * corner);
  EXPECT_NEAR(lowpass_gain(corner, time_constant), 1.0 - std::exp(-1.0), 1e-12);
}

constexpr double kPeriod = 0.005;

/// S2's +-0.1 N a step at 200 Hz.
double by_a_tenth(double target, double previous) {
  return smoothed_force(target, previous, -20.0, 20.0, kPeriod);
}

TEST(Smoothing, NeverExceedsItsBounds) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> force(0.0, 5.0);
  double sent = 0.0;
  for (int n = 0; n < 10000; ++n) {
    const double next = by_a_tenth(force(random), sent);
    ASSERT_LE(std::abs(next - sent), 0.1 + 1e-15) << "seed 5 step " << n;
    ASSERT_GE(next, 0.0);
    sent = next;
  }
}

// 1.44 N at 0.1 N a step: 14 full steps and a rest, exactly 15.
TEST(Smoothing, ReachesHookesValueInThePredictedNumberOfSteps) {
  const double target = 1.44;
  double sent = 0.0;
  int steps = 0;
  while (sent != target) {
    sent = by_a_tenth(target, sent);
    ++steps;
    ASSERT_LE(steps, 100);
  }
  EXPECT_EQ(steps, 15);
}

TEST(Smoothing, RiseOnlyFallsAtOnce) {
  EXPECT_DOUBLE_EQ(smoothed_force(3.0, 1.0, -kInfinity, 20.0, kPeriod), 1.1);
  EXPECT_EQ(smoothed_force(0.0, 4.0, -kInfinity, 20.0, kPeriod), 0.0);
}

// What nobody has set protects the patient: every limit is on.
TEST(LimitParameters, AreOnByDefault) {
  constexpr LimitParameters kLimits;
  EXPECT_TRUE(kLimits.fingertip_force_enabled);
  EXPECT_TRUE(kLimits.joint_torque_enabled);
  EXPECT_TRUE(kLimits.torque_rate_enabled);
  EXPECT_EQ(kLimits.fingertip_force, 5.0);
  EXPECT_EQ(kLimits.joint_torque, 0.5);
  EXPECT_EQ(kLimits.torque_rate, 10.0);
  EXPECT_EQ(kLimits.joint_speed, 40.0);
}

}  // namespace
}  // namespace phalanx
