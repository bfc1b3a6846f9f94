// SPDX-License-Identifier: Apache-2.0
// Motors whose moment arm depends on the angle: in the plant and in the path of a command.
#include <gtest/gtest.h>

#include <cmath>

#include "phalanx/core/random.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/scene/device_file.h"
#include "phalanx/simulation/simulated_channels.h"
#include "phalanx/simulation/transmission.h"
#include "simulated_cases.h"
#include "support/count_allocations.h"

namespace phalanx {
namespace {

using test::at;
using test::kMcp;
using test::kPip;

JointLinkage mcp_polynomial() {
  return {.joint = kMcp, .min_angle = -0.8, .max_angle = 1.6, .polynomial = {-0.0125, 0.003}};
}

/// two_joint_device() with a linkage on each joint.
Exoskeleton linked_device() {
  Exoskeleton exo = test::two_joint_device();
  add_linkage(exo.motors[0], mcp_polynomial());
  add_linkage(exo.motors[1], test::four_bar_linkage(kPip));
  return exo;
}

// Virtual work: what the motors do is what the joints get, for each motion.
TEST(Linkages, ForcesAndTorquesDoTheSameVirtualWork) {
  Random random(5);
  const Exoskeleton exo = linked_device();
  Transmission transmission(exo);
  for (int i = 0; i < 100; ++i) {
    const JointArray q = test::posture(-0.4 + 1.6 * random.uniform(), 1.7 * random.uniform());
    JointArray wanted{};
    wanted[at(kMcp)] = 0.1 * (random.uniform() - 0.5);
    wanted[at(kPip)] = 0.1 * (random.uniform() - 0.5);
    transmission.set_angles(q);
    Rendered rendered;
    transmission.render(wanted, rendered);
    ASSERT_NEAR(rendered.unrendered[at(kMcp)], 0.0, 1e-15);
    ASSERT_NEAR(rendered.unrendered[at(kPip)], 0.0, 1e-15);
    const double moved[] = {1e-6 * (random.uniform() - 0.5), 1e-6 * (random.uniform() - 0.5)};
    double by_motors = 0.0;
    double on_joints = 0.0;
    for (std::size_t m = 0; m < 2; ++m) {
      const JointLinkage& linkage = exo.motors[m].linkages[0];
      const auto j = at(linkage.joint);
      by_motors +=
          rendered.force[m] * (excursion(linkage, q[j] + moved[m]) - excursion(linkage, q[j] - moved[m]));
      on_joints += rendered.torque[j] * 2.0 * moved[m];
    }
    ASSERT_NEAR(by_motors, on_joints, 1e-6 * std::abs(on_joints) + 1e-16);
  }
}

// The limit of the motor's force is that of the torque at each angle: r(q) times 10 N, not more.
TEST(Linkages, AMotorsForceLimitBoundsTheJointsTorqueAtEachAngle) {
  const Exoskeleton exo = linked_device();
  Transmission transmission(exo);
  for (const double pip : {0.0, 0.7, 1.5}) {
    transmission.set_angles(test::posture(0.0, pip));
    JointArray wanted{};
    wanted[at(kPip)] = -1.0;
    Rendered rendered;
    transmission.render(wanted, rendered);
    EXPECT_TRUE(rendered.saturated);
    EXPECT_NEAR(rendered.torque[at(kPip)], 10.0 * moment_arm(test::four_bar_linkage(kPip), pip), 1e-12);
  }
}

TEST(Linkages, AnAngleThatIsNotFiniteGivesAFiniteForce) {
  Transmission transmission(linked_device());
  transmission.set_angles(test::posture(std::nan(""), std::nan("")));
  JointArray wanted{};
  wanted[at(kMcp)] = 0.05;
  Rendered rendered;
  transmission.render(wanted, rendered);
  EXPECT_TRUE(std::isfinite(rendered.force[0]));
}

// A joint that its friction holds, at two angles: the commanded torque is the tendon's torque on the joint.
TEST(Linkages, ACommandedTorqueReachesTheJointAtEachAngle) {
  for (const double pip : {0.1, 1.4}) {
    Exoskeleton exo = linked_device();
    for (ExoJoint& joint : exo.joints) joint.friction.coulomb = 10.0;
    for (ExoMotor& motor : exo.motors) motor.damping = 20.0;
    SimulatedExoskeleton device(exo, test::no_patient(), {}, test::posture(0.3, pip), 1);
    Snapshot snapshot;
    snapshot.torque[at(kMcp)] = 0.04;
    snapshot.torque[at(kPip)] = -0.03;
    for (int i = 0; i < 500; ++i) {
      device.begin_tick();
      device.send(snapshot, device.time_s());
      device.end_tick({});
    }
    EXPECT_NEAR(device.plant().tendon_torque()[at(kMcp)], 0.04, 1e-4) << pip;
    EXPECT_NEAR(device.plant().tendon_torque()[at(kPip)], -0.03, 1e-4) << pip;
    const double force = -0.03 / moment_arm(test::four_bar_linkage(kPip), pip);
    EXPECT_NEAR(device.plant().tendon(1).tension, force, 0.01) << pip;
  }
}

// The motors wind what the joints unwind: a patient moves the hand, and the tendons hardly stretch.
TEST(Linkages, TheMotorsPositionFollowsTheExcursion) {
  const Exoskeleton exo = linked_device();
  PatientParameters patient = test::no_patient();
  patient.stiffness[at(kMcp)] = patient.stiffness[at(kPip)] = 2.0;
  patient.damping[at(kMcp)] = patient.damping[at(kPip)] = 0.05;
  Plant plant(exo, patient, test::posture(0.0, 0.0));
  PlantInput input = test::no_input(exo);
  input.intended = test::posture(0.9, 1.5);
  plant.advance(input, 3.0);
  EXPECT_GT(plant.angle()[at(kPip)], 1.4);
  for (std::size_t m = 0; m < 2; ++m) {
    const JointLinkage& linkage = exo.motors[m].linkages[0];
    EXPECT_NEAR(plant.tendon(m).wound, excursion(linkage, plant.angle()[at(linkage.joint)]), 2e-5);
  }
}

// Without friction: what the motors and the patient do is in the motion and in the tendons.
TEST(Linkages, ThePlantConservesEnergy) {
  Exoskeleton exo = linked_device();
  for (ExoMotor& motor : exo.motors) motor.tendon_damping = 0.0;
  Plant plant(exo, test::no_patient(), test::posture(0.2, 0.2));
  PlantInput input = test::no_input(exo);
  input.motor_force = {-0.2, -0.15};
  double worst = 0.0;
  double largest = 0.0;
  for (int i = 0; i < 200; ++i) {
    input.push[at(kMcp)] = 0.01 * std::sin(0.1 * i);
    plant.advance(input, 1e-3);
    const EnergyLedger& energy = plant.energy();
    worst =
        std::max(worst, std::abs(energy.motors + energy.patient - energy.dissipated - plant.stored_energy()));
    largest = std::max(largest, plant.stored_energy());
  }
  EXPECT_GT(std::abs(plant.angle()[at(kPip)] - 0.2), 0.1)
      << "it moves over angles with different moment arms";
  EXPECT_LT(worst, 2e-3 * largest);
}

// A linkage of constant moment arm is the constant one.
TEST(Linkages, AConstantLinkageIsAMomentArm) {
  const Exoskeleton constant = test::two_joint_device();
  Exoskeleton linked = constant;
  linked.motors[0].arm[at(kMcp)] = linked.motors[1].arm[at(kPip)] = 0.0;
  add_linkage(linked.motors[0],
              {.joint = kMcp, .min_angle = -1.0, .max_angle = 2.0, .polynomial = {-0.0125}});
  add_linkage(linked.motors[1], {.joint = kPip, .min_angle = -1.0, .max_angle = 2.0, .polynomial = {-0.01}});
  Plant a(constant, test::no_patient(), test::posture(0.1, 0.1));
  Plant b(linked, test::no_patient(), test::posture(0.1, 0.1));
  PlantInput input = test::no_input(constant);
  input.motor_force = {-0.1, 0.1};
  a.advance(input, 0.2);
  b.advance(input, 0.2);
  EXPECT_NEAR(a.angle()[at(kMcp)], b.angle()[at(kMcp)], 1e-9);
  EXPECT_NEAR(a.angle()[at(kPip)], b.angle()[at(kPip)], 1e-9);
}

TEST(Linkages, AMotorsChannelHasRoomForTheWholeExcursion) {
  HandParameters hand;
  hand.min_angle.fill(-0.5);
  hand.max_angle.fill(1.8);
  const Exoskeleton exo = linked_device();
  const auto channels = simulated_channels(exo, hand);
  for (const DeviceChannel& channel : channels) {
    if (channel.kind != ChannelKind::kMotor) continue;
    const JointLinkage& linkage = exo.motors[at(channel.index)].linkages[0];
    for (const double q : {-0.5, 0.0, 1.0, 1.8}) {
      EXPECT_GT(excursion(linkage, q), channel.gain * channel.raw_min);
      EXPECT_LT(excursion(linkage, q), channel.gain * channel.raw_max);
    }
  }
}

TEST(Linkages, TicksAllocateNothing) {
  SimulatedExoskeleton device(linked_device(), test::no_patient(), {}, test::posture(0.2, 0.2), 1);
  device.begin_tick();
  device.end_tick({});
  const std::size_t before = test::allocations_of_this_thread();
  for (int i = 0; i < 10; ++i) {
    device.begin_tick();
    device.end_tick({});
  }
  EXPECT_EQ(test::allocations_of_this_thread(), before);
}

TEST(Linkages, TheShippedDeviceHasBoth) {
  const Exoskeleton exo = load_device_file("linkages");
  int tables = 0;
  int bars = 0;
  for (const ExoMotor& motor : exo.motors) {
    for (const JointLinkage& linkage : motor.linkages) {
      tables += linkage.table.empty() ? 0 : 1;
      bars += linkage.four_bar ? 1 : 0;
    }
  }
  EXPECT_EQ(tables, 1);
  EXPECT_EQ(bars, 1);
}

}  // namespace
}  // namespace phalanx
