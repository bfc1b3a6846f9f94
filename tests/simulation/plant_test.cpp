// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/plant.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "phalanx/core/constants.h"
#include "plant_cases.h"
#include "support/count_allocations.h"

namespace phalanx {
namespace {

using test::at;
using test::bare_joint;
using test::kMcp;
using test::kPip;
using test::motor_on;
using test::no_input;
using test::no_patient;
using test::one_motor;
using test::two_joint_device;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

// 0.3 rad on an arm of 10 mm are wound up as 3 mm.
TEST(Plant, BeginsAtRestWithoutTension) {
  JointArray start{};
  start[at(kMcp)] = 0.3;
  const Plant plant(one_motor(0.01), no_patient(), start);
  EXPECT_EQ(plant.angle(), start);
  EXPECT_EQ(plant.speed(), JointArray{});
  EXPECT_EQ(plant.tendon_torque(), JointArray{});
  EXPECT_DOUBLE_EQ(plant.tendon(0).wound, 3e-3);
  EXPECT_EQ(plant.tendon(0).speed, 0.0);
  EXPECT_EQ(plant.tendon(0).motor_force, 0.0);
  EXPECT_EQ(plant.tendon(0).tension, 0.0);
  EXPECT_NEAR(plant.stored_energy(), 0.0, 1e-20);
  EXPECT_EQ(plant.energy().motors, 0.0);
  EXPECT_EQ(plant.energy().patient, 0.0);
  EXPECT_EQ(plant.energy().dissipated, 0.0);
  EXPECT_EQ(plant.energy().turned_over, 0.0);
}

// 2 mm of play on an arm of 10 mm: 0.2 rad. 0.01 Nm are 1 N on the tendon, which gives 0.1 mm, 0.01 rad.
TEST(Plant, ATendonWithBacklashHasItsPlayAndNoTensionInside) {
  Exoskeleton exo = one_motor(0.01);
  exo.motors[0].backlash = 2e-3;
  exo.motors[0].tendon_damping = 5.0;
  exo.motors[0].sheath.coulomb = 1000.0;  // the rotor stays
  exo.joints[0].damping = 0.02;           // critical, against the tendon
  Plant plant(exo, no_patient(), {});
  PlantInput input = no_input(exo);
  int inside = 0;
  for (const double side : {1.0, -1.0, 1.0}) {
    input.push[at(kMcp)] = side * 0.01;
    for (int i = 0; i < 3000; ++i) {
      const double before = std::abs(plant.angle()[at(kMcp)]);
      plant.advance(input, 1e-3);
      if (std::max(before, std::abs(plant.angle()[at(kMcp)])) > 0.0999) continue;
      ++inside;
      EXPECT_EQ(plant.tendon(0).tension, 0.0);
    }
    EXPECT_NEAR(plant.angle()[at(kMcp)], side * 0.11, 1e-9);
    EXPECT_NEAR(plant.tendon(0).tension, -side * 1.0, 1e-6);
  }
  EXPECT_GT(inside, 20);
  EXPECT_EQ(plant.tendon(0).wound, 0.0);
}

// y = f t^2 / (2 m) = -0.5 N (0.1 s)^2 / 0.4 kg, while the joint stays where it is.
TEST(Plant, ASlackTendonsRotorMovesFreely) {
  Exoskeleton exo = one_motor(0.01);
  exo.motors[0].pull_only = true;
  exo.motors[0].tendon_damping = 5.0;
  Plant plant(exo, no_patient(), {});
  PlantInput input = no_input(exo);
  input.motor_force[0] = -0.5;
  plant.advance(input, 0.1);
  EXPECT_NEAR(plant.tendon(0).wound, -0.0125, 1e-12);
  EXPECT_EQ(plant.angle()[at(kMcp)], 0.0);
}

TEST(Plant, APullOnlyTendonNeverPushesHoweverItIsDamped) {
  for (const double damping : {0.0, 5.0, 500.0}) {
    Exoskeleton exo = two_joint_device();
    exo.motors[0].pull_only = true;
    exo.motors[0].arm[at(kPip)] = 0.004;
    exo.motors[0].tendon_damping = damping;
    exo.motors[1].tendon_damping = damping;
    Plant plant(exo, no_patient(), {});
    PlantInput input = no_input(exo);
    int slack = 0;
    int pulling = 0;
    for (int i = 0; i < 40000; ++i) {
      const double t = 5e-5 * i;
      input.motor_force = {0.5 + 2.0 * std::sin(40.0 * t), 3.0 * std::sin(170.0 * t)};
      input.push[at(kMcp)] = 0.05 * std::sin(290.0 * t);
      plant.advance(input, 5e-5);
      ASSERT_GE(plant.tendon(0).tension, 0.0) << "at " << t << " s, damping " << damping;
      ++(plant.tendon(0).tension > 0.0 ? pulling : slack);
    }
    EXPECT_GT(slack, 1000);
    EXPECT_GT(pulling, 1000);
  }
}

// 0.5 N on 10 mm against a spring of 0.5 Nm/rad: 0.01 rad.
TEST(Plant, APullOnlyTendonHoldsAPullHoweverSmall) {
  Exoskeleton exo = one_motor(0.01);
  exo.motors[0].pull_only = true;
  exo.motors[0].damping = 20.0;
  exo.motors[0].tendon_damping = 5.0;
  PatientParameters patient = no_patient();
  patient.stiffness[at(kMcp)] = 0.5;
  Plant plant(exo, patient, {});
  PlantInput input = no_input(exo);
  input.motor_force[0] = 0.5;
  plant.advance(input, 5.0);
  EXPECT_NEAR(plant.tendon(0).tension, 0.5, 1e-6);
  EXPECT_NEAR(plant.angle()[at(kMcp)], 0.01, 1e-8);
}

// 1 N for 0.1 s are 0.1 N s, which the rotor of 0.2 kg and the joint, 1e-4 kg m^2 on 10 mm, share: whatever
// the tendon does between the two, m y' + I q' / r stays what it is.
TEST(Plant, ATendonNeitherGivesNorTakesMomentumHoweverItIsDamped) {
  for (const double damping : {0.0, 1.0, 5.0}) {
    Exoskeleton exo = one_motor(0.01);
    exo.joints[0].damping = 0.0;
    exo.motors[0].tendon_damping = damping;
    Plant plant(exo, no_patient(), {});
    PlantInput input = no_input(exo);
    input.motor_force[0] = 1.0;
    plant.advance(input, 0.1);
    input.motor_force[0] = 0.0;
    plant.advance(input, 1.0);
    EXPECT_NEAR(0.2 * plant.tendon(0).speed + 1e-4 / 0.01 * plant.speed()[at(kMcp)], 0.1, 1e-7) << damping;
  }
}

TEST(Plant, AMotorsForceFollowsItsCommandWithAFirstOrderLag) {
  Exoskeleton exo = one_motor(0.01);
  exo.motors[0].lag = 4e-3;
  Plant plant(exo, no_patient(), {});
  PlantInput input = no_input(exo);
  input.motor_force[0] = 3.0;
  plant.advance(input, 4e-3);
  EXPECT_NEAR(plant.tendon(0).motor_force, 3.0 * (1.0 - std::exp(-1.0)), 1e-12);
  plant.advance(input, 8e-3);
  EXPECT_NEAR(plant.tendon(0).motor_force, 3.0 * (1.0 - std::exp(-3.0)), 1e-12);
}

TEST(Plant, AMotorSaturatesAtItsForceLimitEitherWay) {
  const Exoskeleton exo = one_motor(0.01);
  Plant plant(exo, no_patient(), {});
  PlantInput input = no_input(exo);
  input.motor_force[0] = 1e9;
  plant.advance(input, 1e-3);
  EXPECT_EQ(plant.tendon(0).motor_force, 10.0);
  input.motor_force[0] = -10.5;
  plant.advance(input, 1e-3);
  EXPECT_EQ(plant.tendon(0).motor_force, -10.0);
}

TEST(Plant, StaysFiniteWhateverArrives) {
  const Exoskeleton exo = two_joint_device();
  PatientParameters patient = no_patient();
  patient.stiffness.fill(2.0);
  patient.damping.fill(0.01);
  for (const double bad : {kNotANumber, kInfinity, -kInfinity, 1e308, -1e308}) {
    Plant plant(exo, patient, {});
    PlantInput input = no_input(exo);
    input.motor_force = {bad, -bad};
    for (int where = 0; where < 4; ++where) {
      if (where == 1) input.push.fill(bad);
      if (where == 2) input.intended.fill(bad);
      if (where == 3) input.intended_speed.fill(bad);
      plant.advance(input, 0.05);
      for (const double q : plant.angle()) EXPECT_TRUE(std::isfinite(q)) << bad << " " << where;
      for (const double v : plant.speed()) EXPECT_TRUE(std::isfinite(v)) << bad << " " << where;
      for (std::size_t m = 0; m < 2; ++m) EXPECT_TRUE(std::isfinite(plant.tendon(m).tension)) << bad;
      EXPECT_TRUE(std::isfinite(plant.energy().turned_over)) << bad << " " << where;
    }
  }
}

TEST(Plant, DoesNothingForATimeThatIsNotAboveZero) {
  const Exoskeleton exo = one_motor(0.01);
  Plant plant(exo, no_patient(), {});
  PlantInput input = no_input(exo);
  input.motor_force[0] = 1.0;
  for (const double duration : {0.0, -1.0, kNotANumber}) plant.advance(input, duration);
  EXPECT_EQ(plant.tendon(0).motor_force, 0.0);
  EXPECT_EQ(plant.tendon(0).wound, 0.0);
}

// A held rotor's tendon over both joints: stretch s = -(0.01 q1 + 0.02 q2), T = 1e4 s. With springs of
// 2 and 4 Nm/rad and a push of 0.3 Nm on the first joint:
//   2 q1 = 0.01 T + 0.3,  4 q2 = 0.02 T,
// s = T / 1e4 = -(0.01 (0.005 T + 0.15) + 0.02 (0.005 T))  =>  T (1e-4 + 1.5e-4) = -1.5e-3  =>  T = -6 N,
// q1 = 0.12, q2 = -0.03.
TEST(Plant, ATendonAcrossTwoJointsPullsBothByItsMomentArms) {
  Exoskeleton exo = two_joint_device();
  exo.motors = {motor_on("both", kMcp, 0.01)};
  exo.motors[0].arm[at(kPip)] = 0.02;
  exo.motors[0].sheath.coulomb = 100.0;
  for (ExoJoint& joint : exo.joints) joint.damping = 0.02;
  PatientParameters patient = no_patient();
  patient.stiffness[at(kMcp)] = 2.0;
  patient.stiffness[at(kPip)] = 4.0;
  Plant plant(exo, patient, {});
  PlantInput input = no_input(exo);
  input.push[at(kMcp)] = 0.3;
  plant.advance(input, 0.01);
  EXPECT_DOUBLE_EQ(plant.tendon_torque()[at(kPip)], 2.0 * plant.tendon_torque()[at(kMcp)]);
  plant.advance(input, 2.0);
  EXPECT_NEAR(plant.tendon(0).tension, -6.0, 1e-9);
  EXPECT_NEAR(plant.angle()[at(kMcp)], 0.12, 1e-10);
  EXPECT_NEAR(plant.angle()[at(kPip)], -0.03, 1e-10);
  EXPECT_NEAR(plant.tendon_torque()[at(kMcp)], -0.06, 1e-10);
}

// 5 N and 2 N pull against each other on 10 mm, against a spring of 0.5 Nm/rad: 0.03 / 0.5 = 0.06 rad. The
// rotors have wound up their tendon's excursion and its stretch: 0.6 mm + 0.5 mm and -0.6 mm + 0.2 mm.
TEST(Plant, AntagonistsRestWhereTheirPullsAndThePatientBalance) {
  Exoskeleton exo = one_motor(0.01);
  exo.motors.push_back(motor_on("extensor", kMcp, -0.01));
  for (ExoMotor& motor : exo.motors) {
    motor.pull_only = true;
    motor.damping = 20.0;
  }
  PatientParameters patient = no_patient();
  patient.stiffness[at(kMcp)] = 0.5;
  Plant plant(exo, patient, {});
  PlantInput input = no_input(exo);
  input.motor_force = {5.0, 2.0};
  plant.advance(input, 5.0);
  EXPECT_NEAR(plant.angle()[at(kMcp)], 0.06, 1e-9);
  EXPECT_NEAR(plant.tendon(0).wound, 1.1e-3, 1e-10);
  EXPECT_NEAR(plant.tendon(1).wound, -0.4e-3, 1e-10);
  EXPECT_NEAR(plant.tendon(0).tension, 5.0, 1e-7);
  EXPECT_NEAR(plant.tendon(1).tension, 2.0, 1e-7);
}

// 1 Nm/rad on 1e-4 kg m^2 swings with 100 rad/s; a period later it is where it was, to the integrator's phase
// error of (w h)^2 / 24.
TEST(Plant, AFreeJointSwingsWithItsNaturalFrequency) {
  const Exoskeleton exo = bare_joint(1e-4, 0.0);
  PatientParameters patient = no_patient();
  patient.stiffness[at(kMcp)] = 1.0;
  JointArray start{};
  start[at(kMcp)] = 0.1;
  Plant plant(exo, patient, start);
  plant.advance(no_input(exo), 0.25 * 2.0 * std::numbers::pi / 100.0);
  EXPECT_NEAR(plant.angle()[at(kMcp)], 0.0, 1e-6);
  EXPECT_NEAR(plant.speed()[at(kMcp)], -10.0, 1e-4);
}

TEST(Plant, RefusesAStepThatItsTendonsDoNotBear) {
  Exoskeleton exo = one_motor(0.01);  // w^2 = 1e4 (1 / 0.2 + 1e-4 / 1e-4) = 6e4
  EXPECT_NO_THROW(Plant(exo, no_patient(), {}, 1e-3));
  exo.motors[0].tendon_stiffness = 1e7;  // 7746 rad/s
  EXPECT_NO_THROW(Plant(exo, no_patient(), {}, 1.29e-4));
  EXPECT_THAT([&] { Plant(exo, no_patient(), {}, 1.30e-4); },
              testing::ThrowsMessage<std::invalid_argument>(testing::AllOf(
                  testing::HasSubstr("motor mcp on joint index_mcp_flexion (inertia 0.0001 kg m^2)"),
                  testing::HasSubstr("frequency of 7746 rad/s"), testing::HasSubstr("at most 0.000129 s"))));
  for (const double step : {0.0, 9e-8, 1.1e-3, kNotANumber})
    EXPECT_THROW(Plant(one_motor(0.01), no_patient(), {}, step), std::invalid_argument) << step;
  JointArray start{};
  start[at(kMcp)] = kNotANumber;
  EXPECT_THROW(Plant(one_motor(0.01), no_patient(), start), std::invalid_argument);
}

TEST(Plant, RefusesADeviceAndAPatientThatCannotBe) {
  Exoskeleton exo = one_motor(0.01);
  exo.motors[0].force_limit = 0.0;
  EXPECT_THROW(Plant(exo, no_patient(), {}), std::invalid_argument);
  PatientParameters patient = no_patient();
  patient.damping[at(kMcp)] = kNotANumber;
  EXPECT_THROW(Plant(one_motor(0.01), patient, {}), std::invalid_argument);
}

// w = sqrt(1e4 Nm/rad / 1e-4 kg m^2) = 1e4 rad/s, and the longest step is 1 / w = 1e-4 s.
TEST(Plant, RefusesAStepThatThePatientsSpringDoesNotBear) {
  const Exoskeleton exo = bare_joint(1e-4, 0.0);
  PatientParameters patient = no_patient();
  patient.stiffness[at(kMcp)] = 1e4;
  EXPECT_NO_THROW(Plant(exo, patient, {}, 0.99e-4));
  EXPECT_THROW(Plant(exo, patient, {}, 1.01e-4), std::invalid_argument);
  // 1 / w = 63 us: the default of 50 us is short enough.
  patient.stiffness[at(kMcp)] = 2.5e4;
  EXPECT_NO_THROW(Plant(exo, patient, {}));
  EXPECT_THROW(Plant(exo, patient, {}, 64e-6), std::invalid_argument);
}

TEST(Plant, AdvancesWithoutAllocation) {
  const Exoskeleton exo = two_joint_device();
  Plant plant(exo, no_patient(), {});
  PlantInput input = no_input(exo);
  input.motor_force = {3.0, -2.0};
  const std::size_t before = test::allocations_of_this_thread();
  for (int i = 0; i < 100; ++i) plant.advance(input, 1e-3);
  EXPECT_EQ(test::allocations_of_this_thread(), before);
}

}  // namespace
}  // namespace phalanx
