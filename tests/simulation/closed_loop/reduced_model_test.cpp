// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/closed_loop/reduced_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "phalanx/scene/scene_trial.h"
#include "phalanx/simulation/closed_loop/trial.h"

namespace phalanx {
namespace {

const StabiliserParameters kNone{.method = Stabiliser::kNone};
const StabiliserParameters kTenthOfANewton{
    .method = Stabiliser::kSmoothing, .min_rate = -20.0, .max_rate = 20.0};

ReducedModel with_press(double press) {
  ReducedModel model = make_reduced_model();
  model.patient.press = press;
  model.patient.press_spread = 0.0;
  return model;
}

/// Holds where the patient leaves it: all dry friction off.
ReducedModel frictionless(double press) {
  ReducedModel model = with_press(press);
  for (ExoJoint& joint : model.exoskeleton.joints) joint.friction.coulomb = 0.0;
  for (ExoMotor& motor : model.exoskeleton.motors) motor.sheath.coulomb = 0.0;
  return model;
}

// docs/device-file.md, "The shipped devices": the column of beihang, what all have, and the patient `adult`.
TEST(ReducedModel, HasTheNumbersOfTheShippedDevice) {
  const ReducedModel model = make_reduced_model();
  ASSERT_EQ(model.exoskeleton.joints.size(), 1U);
  ASSERT_EQ(model.exoskeleton.motors.size(), 1U);
  const ExoJoint& joint = model.exoskeleton.joints[0];
  const ExoMotor& motor = model.exoskeleton.motors[0];
  const auto j = static_cast<std::size_t>(joint.joint);
  EXPECT_EQ(motor.mass, 0.20);
  EXPECT_EQ(joint.inertia, 0.04);
  EXPECT_EQ(motor.damping, 0.8);
  EXPECT_EQ(joint.damping, 0.8);
  EXPECT_EQ(motor.sheath.coulomb, 0.34);
  EXPECT_EQ(joint.friction.coulomb, 0.06);
  for (const DryFriction& friction : {motor.sheath, joint.friction}) {
    EXPECT_EQ(friction.static_ratio, 1.05);
    EXPECT_EQ(friction.stribeck_speed, 2e-3);
    EXPECT_EQ(friction.capstan, 0.0);
  }
  EXPECT_EQ(motor.tendon_stiffness, 10e3);
  EXPECT_EQ(motor.tendon_damping, 5.0);
  EXPECT_EQ(motor.backlash, 0.1e-3);
  EXPECT_EQ(motor.lag, 4e-3);
  EXPECT_EQ(motor.force_limit, 10.0);
  EXPECT_EQ(motor.arm[j], -1.0);
  EXPECT_EQ(motor.name, "wall");
  EXPECT_EQ(joint.sensor_lsb, 25e-6);
  EXPECT_EQ(joint.sensor_noise, 10e-6);
  EXPECT_EQ(model.exoskeleton.controller.rate_hz, 1000.0);
  EXPECT_EQ(model.exoskeleton.controller.compute_delay, 4.5e-3);
  EXPECT_EQ(model.exoskeleton.controller.return_delay, 1e-3);
  EXPECT_EQ(model.patient.stiffness[j], 700.0);
  EXPECT_EQ(model.patient.damping[j], 2.8);
  EXPECT_EQ(model.patient.bump, 2.0);
}

// F = k x and kh (x_end - x) = F at x_end = F (1/kh + 1/k). What is left is the sensor: 25 um in 100 N/m, and
// a tremor of 30 um that has no mean.
TEST(ReducedModel, RestsAtThePressOnASoftWallWithoutFriction) {
  constexpr double kWall = 100.0;
  for (const double press : {1.0, 2.0, 3.0}) {
    const TrialResult result = run_reduced_trial(frictionless(press), kNone, kWall, 1);
    EXPECT_TRUE(result.valid) << result.why_invalid;
    EXPECT_TRUE(result.stable) << "force swings by " << result.force_swing;
    EXPECT_NEAR(result.mean_force, press, kWall * 25e-6 + 1e-3) << press;
    EXPECT_NEAR(result.mean_depth, press / kWall, 25e-6 + 10e-6) << press;
  }
}

// The finger rests at 30 mm from 1.3 s on; at 1.6 s 2 N push it for 0.1 s, by 2 N / (700 + 100 N/m) = 2.5 mm
// at least. Without them it is deepest where it arrives, less than 1 mm beyond its rest (50 mm/s / 58 rad/s).
TEST(ReducedModel, IsPushedDeeperByTheBump) {
  const auto peak_with = [](double bump) {
    ReducedModel model = frictionless(3.0);
    model.patient.approach_min = model.patient.approach_max = 0.05;
    model.patient.bump = bump;
    return run_reduced_trial(model, kNone, 100.0, 1).peak_depth;
  };
  EXPECT_GT(peak_with(2.0) - peak_with(0.0), 1.0e-3);
}

// Dry friction of 0.40 N may hold the finger off by Fc / (kh + k): the force by k Fc / (kh + k).
TEST(ReducedModel, RestsWithinItsDryFrictionOfThePress) {
  for (const double wall : {300.0, 500.0, 1000.0}) {
    const double band = wall * 1.05 * 0.40 / (700.0 + wall);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const TrialResult result = run_reduced_trial(with_press(3.0), kTenthOfANewton, wall, seed);
      EXPECT_TRUE(result.stable) << "seed " << seed;
      EXPECT_NEAR(result.mean_force, 3.0, band + wall * 25e-6) << "wall " << wall << ", seed " << seed;
      EXPECT_NEAR(result.mean_force, wall * result.mean_depth, 0.05) << "wall " << wall << ", seed " << seed;
    }
  }
}

TEST(ReducedModel, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const ReducedModel model = make_reduced_model();
  const TrialResult first = run_reduced_trial(model, kTenthOfANewton, 800.0, 1);
  const TrialResult again = run_reduced_trial(model, kTenthOfANewton, 800.0, 1);
  EXPECT_EQ(first.mean_force, again.mean_force);
  EXPECT_EQ(first.force_swing, again.force_swing);
  EXPECT_EQ(first.ghost_energy, again.ghost_energy);
  EXPECT_NE(first.mean_force, run_reduced_trial(model, kTenthOfANewton, 800.0, 2).mean_force);
}

TEST(ReducedModel, ShakesOnAStiffWallWithoutSmoothingAndRestsWithIt) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    EXPECT_FALSE(run_reduced_trial(make_reduced_model(), kNone, 2000.0, seed).stable) << seed;
    EXPECT_TRUE(run_reduced_trial(make_reduced_model(), kTenthOfANewton, 1000.0, seed).stable) << seed;
  }
}

// Hand, meshes and GDP in place of one coordinate: same seed, same draws, so both are meant to rest at the
// same force, and dry friction may hold each off by its band.
TEST(ReducedModel, RestsWhereTheWholeHandRests) {
  constexpr double kWall = 500.0;
  const auto setup = make_trial_setup(
      load_scene("stability_press", {{"smoothing.min_n", "-0.1"}, {"smoothing.max_n", "0.1"}}));
  ReducedModel model = make_reduced_model();
  model.patient.bump = setup->patient.bump;
  const double band = kWall * 1.05 * 0.40 / (700.0 + kWall);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const TrialResult reduced = run_reduced_trial(model, kTenthOfANewton, kWall, seed);
    const TrialResult whole = run_trial(*setup, kWall, std::numeric_limits<double>::quiet_NaN(), seed);
    EXPECT_TRUE(reduced.stable && whole.stable) << "seed " << seed;
    EXPECT_NEAR(whole.mean_force, reduced.mean_force, 2.0 * band) << "seed " << seed;
  }
}

}  // namespace
}  // namespace phalanx
