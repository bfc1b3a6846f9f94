// SPDX-License-Identifier: Apache-2.0
// What sticks and what slides in the plant.
#include <gtest/gtest.h>

#include "phalanx/simulation/plant.h"
#include "plant_cases.h"

namespace phalanx {
namespace {

using test::at;
using test::bare_joint;
using test::kMcp;
using test::no_input;
using test::no_patient;
using test::one_motor;

// Coulomb 0.1 Nm, breakaway ratio 1.5, Stribeck speed 1 rad/s, viscous 0.1: at 1 rad/s the sum is
// 0.1 (1 + 0.5 / e) + 0.1 = 0.2183939721 Nm, by hand.
TEST(PlantFriction, SlidesAtTheSpeedAtWhichStribeckAndViscousFrictionTakeThePush) {
  Exoskeleton exo = bare_joint(1e-3, 0.1);
  exo.joints[0].friction = {.coulomb = 0.1, .static_ratio = 1.5, .stribeck_speed = 1.0};
  Plant plant(exo, no_patient(), {});
  PlantInput input = no_input(exo);
  input.push[at(kMcp)] = 0.21839397205857212;
  plant.advance(input, 2.0);
  EXPECT_NEAR(plant.speed()[at(kMcp)], 1.0, 1e-9);
}

// Far above the Stribeck speed Coulomb friction alone is left: 0.3 Nm = 0.1 + 0.1 v.
TEST(PlantFriction, SlidesAgainstCoulombFrictionFarAboveTheStribeckSpeed) {
  Exoskeleton exo = bare_joint(1e-3, 0.1);
  exo.joints[0].friction = {.coulomb = 0.1, .static_ratio = 1.5, .stribeck_speed = 0.01};
  Plant plant(exo, no_patient(), {});
  PlantInput input = no_input(exo);
  input.push[at(kMcp)] = -0.3;
  plant.advance(input, 2.0);
  EXPECT_NEAR(plant.speed()[at(kMcp)], -2.0, 1e-9);
}

TEST(PlantFriction, AJointHoldsAPushBelowItsBreakawayForAMinuteWithoutCreep) {
  Exoskeleton exo = bare_joint(1e-3, 0.1);
  exo.joints[0].friction = {.coulomb = 0.1, .static_ratio = 1.5, .stribeck_speed = 0.01};
  JointArray start{};
  start[at(kMcp)] = 0.3;
  Plant plant(exo, no_patient(), start);
  PlantInput input = no_input(exo);
  input.push[at(kMcp)] = 0.95 * 0.15;
  plant.advance(input, 60.0);
  EXPECT_EQ(plant.angle()[at(kMcp)], 0.3);
  EXPECT_EQ(plant.speed()[at(kMcp)], 0.0);
  input.push[at(kMcp)] = 1.01 * 0.15;
  plant.advance(input, 0.1);
  EXPECT_GT(plant.angle()[at(kMcp)], 0.3001);
}

// The motor pulls with 0.95 of what breaks its rotor away, against a joint that hangs on the tendon and is
// pushed: once the tendon has settled, nothing moves any more.
TEST(PlantFriction, ARotorHoldsAForceBelowItsBreakawayForAMinuteWithoutCreep) {
  Exoskeleton exo = one_motor(0.01);
  exo.joints[0].friction = {.coulomb = 1e-3, .static_ratio = 1.05, .stribeck_speed = 0.01};
  exo.motors[0].sheath = {.coulomb = 2.0, .static_ratio = 1.05, .stribeck_speed = 1e-3};
  exo.motors[0].tendon_damping = 5.0;
  Plant plant(exo, no_patient(), {});
  PlantInput input = no_input(exo);
  input.motor_force[0] = 2.2;  // the joint's 0.005 Nm hold about 0.5 N of it, so that 1.7 .. 1.995 are left
  input.push[at(kMcp)] = -0.0041;
  plant.advance(input, 1.0);
  const double q = plant.angle()[at(kMcp)];
  const TendonState tendon = plant.tendon(0);
  EXPECT_NE(q, 0.0);
  EXPECT_GT(tendon.tension, 0.2);
  plant.advance(input, 59.0);
  EXPECT_EQ(plant.angle()[at(kMcp)], q);
  EXPECT_EQ(plant.tendon(0).wound, tendon.wound);
  EXPECT_EQ(plant.tendon(0).tension, tendon.tension);
}

TEST(PlantFriction, ARotorStaysExactlyAtRestBelowItsBreakawayAndLeavesAboveIt) {
  Exoskeleton exo = one_motor(0.01);
  exo.motors[0].sheath = {.coulomb = 2.0, .static_ratio = 1.05, .stribeck_speed = 1e-3};
  Plant plant(exo, no_patient(), {});
  PlantInput input = no_input(exo);
  input.motor_force[0] = 0.95 * 2.1;
  plant.advance(input, 1.0);
  EXPECT_EQ(plant.tendon(0).wound, 0.0);
  input.motor_force[0] = 1.001 * 2.1;
  plant.advance(input, 0.5);
  EXPECT_GT(plant.tendon(0).wound, 1e-4);
}

/// Tension at which a rotor with Coulomb friction of 1 N gives way, as the joint is pushed away slowly [N].
double breakaway_tension(double static_ratio, double capstan) {
  Exoskeleton exo = one_motor(0.01);
  exo.joints[0].damping = 0.1;  // settles at once
  exo.motors[0].sheath = {
      .coulomb = 1.0, .static_ratio = static_ratio, .stribeck_speed = 1e-3, .capstan = capstan};
  Plant plant(exo, no_patient(), {});
  PlantInput input = no_input(exo);
  double held = 0.0;
  for (int i = 0; i < 4000 && plant.tendon(0).speed == 0.0; ++i) {
    held = plant.tendon(0).tension;
    input.push[at(kMcp)] = -1e-5 * i;  // 1 mN of tension a tick
    plant.advance(input, 1e-3);
  }
  return held;
}

// The joint pulls the tendon out, so that a tension T meets T (1 - exp(-mu theta)) = c T / (1 + c) beside
// Coulomb's r: it gives way at T = r (1 + c). However long the sheath, it never locks by the capstan alone.
TEST(PlantFriction, ATensionedTendonSticksToItsSheathTheHarder) {
  EXPECT_NEAR(breakaway_tension(1.0, 0.0), 1.0, 3e-3);
  EXPECT_NEAR(breakaway_tension(1.0, 0.2), 1.2, 3e-3);
  EXPECT_NEAR(breakaway_tension(1.25, 0.2), 1.5, 3e-3);
  EXPECT_NEAR(breakaway_tension(1.0, 1.5), 2.5, 6e-3);
}

// The motor winds up against the tension T of a joint that stands still, which adds c T, c = 0.5, to 1 N:
// with 4 N it comes to T = 3 N / 1.5. Let go, the rotor holds as long as T less the motor's force is at most
// 1 N + T c / (1 + c): down to 0.333 N. The same where the motor pushes.
TEST(PlantFriction, ASheathHoldsTheHarderWhatIsWoundUpAgainstTheTension) {
  for (const double side : {1.0, -1.0}) {
    Exoskeleton exo = one_motor(0.01);
    exo.joints[0].friction.coulomb = 100.0;
    exo.motors[0].sheath = {.coulomb = 1.0, .static_ratio = 1.0, .stribeck_speed = 1e-3, .capstan = 0.5};
    Plant plant(exo, no_patient(), {});
    PlantInput input = no_input(exo);
    for (int i = 0; i <= 4000; ++i) {  // 1 mN a tick
      input.motor_force[0] = side * 1e-3 * i;
      plant.advance(input, 1e-3);
    }
    EXPECT_NEAR(plant.tendon(0).tension, side * 2.0, 0.01);
    input.motor_force[0] = side * 0.36;
    plant.advance(input, 0.1);
    EXPECT_NEAR(plant.tendon(0).tension, side * 2.0, 0.01);
    input.motor_force[0] = side * 0.30;
    plant.advance(input, 0.1);
    EXPECT_LT(side * plant.tendon(0).tension, 1.97);
  }
}

}  // namespace
}  // namespace phalanx
