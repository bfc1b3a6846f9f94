// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/simulated_exoskeleton.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "simulated_cases.h"

namespace phalanx {
namespace {

using test::at;
using test::held_device;
using test::kMcp;
using test::kPip;
using test::no_patient;
using test::posture;
using test::rendered_at_next;
using test::two_joint_device;

constexpr int kOtherJoint = 7;

JointArray open_hand() {
  JointArray open{};
  for (std::size_t j = 0; j < open.size(); ++j) open[j] = 0.01 * static_cast<double>(j);
  return open;
}

Snapshot torque_command(double mcp) {
  Snapshot snapshot;
  snapshot.torque[at(kMcp)] = mcp;
  return snapshot;
}

TEST(SimulatedExoskeleton, ShowsTheOpenHandAndWhatFollowsWhereItHasNoSensor) {
  Exoskeleton exo = held_device();  // the DIP is half the PIP plus 0.1
  exo.controller.copy[2] = {.of = 1, .gain = 1.0};
  exo.controller.copy[4] = {.of = 1, .gain = 0.5};
  const JointArray open = open_hand();
  SimulatedExoskeleton device(exo, no_patient(), open, posture(0.3, 0.4), 1);
  device.begin_tick();
  const JointArray& q = device.sample().angle;
  EXPECT_EQ(q[at(kMcp)], 0.3);
  EXPECT_EQ(q[at(kPip)], 0.4);
  EXPECT_DOUBLE_EQ(q[at(kOtherJoint)], 0.3);
  EXPECT_EQ(q[at(5)], 0.05);                                       // index abduction: not sensed
  for (int j = 0; j < 4; ++j) EXPECT_EQ(q[at(j)], open[at(j)]);    // thumb
  for (int j = 12; j < 16; ++j) EXPECT_EQ(q[at(j)], open[at(j)]);  // ring
  EXPECT_DOUBLE_EQ(q[at(8)], 0.08 + (0.3 - 0.04));                 // middle
  EXPECT_DOUBLE_EQ(q[at(11)], 0.11 + (0.3 - 0.07));
  EXPECT_DOUBLE_EQ(q[at(16)], 0.16 + 0.5 * (0.3 - 0.04));  // little
  EXPECT_DOUBLE_EQ(q[at(18)], 0.18 + 0.5 * (0.4 - 0.06));

  const AngleOrigins& origin = device.sample().angle_origin;
  for (const int j : {kMcp, kPip}) EXPECT_EQ(origin[at(j)], AngleOrigin::kMeasured);
  for (const int j : {kOtherJoint, 8, 10, 11, 16, 18, 19})
    EXPECT_EQ(origin[at(j)], AngleOrigin::kCompleted) << j;
  for (const int j : {0, 3, 5, 9, 12, 15, 17}) EXPECT_EQ(origin[at(j)], AngleOrigin::kFixed) << j;
}

TEST(SimulatedExoskeleton, StampsEachSampleWithTheTimeOfItsTick) {
  Exoskeleton exo = held_device();
  exo.controller.rate_hz = 500.0;
  SimulatedExoskeleton device(exo, no_patient(), {}, {}, 1);
  for (int tick = 0; tick < 4; ++tick) {
    device.begin_tick();
    EXPECT_DOUBLE_EQ(device.sample().time_s, 2e-3 * tick);
    device.end_tick({});
  }
}

TEST(SimulatedExoskeleton, RoundsToTheSensorsLeastSignificantBit) {
  Exoskeleton exo = held_device();
  exo.joints[0].sensor_lsb = 0.25;
  SimulatedExoskeleton device(exo, no_patient(), {}, posture(0.4, 0.4), 1);
  device.begin_tick();
  EXPECT_EQ(device.sample().angle[at(kMcp)], 0.5);
  EXPECT_EQ(device.sample().angle[at(kPip)], 0.4);
  SimulatedExoskeleton above(exo, no_patient(), {}, posture(-0.35, 0.4), 1);
  above.begin_tick();
  EXPECT_EQ(above.sample().angle[at(kMcp)], -0.25);
}

struct Spread {
  double mean, rms;
};

/// Of the MCP's measured angle about its true one, 0.3 rad.
Spread measured_spread(const Exoskeleton& exo, std::uint64_t seed) {
  SimulatedExoskeleton device(exo, no_patient(), {}, posture(0.3, 0.4), seed);
  constexpr int kTicks = 40000;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kTicks; ++i) {
    device.begin_tick();  // the plant does not move
    const double error = device.sample().angle[at(kMcp)] - 0.3;
    sum += error;
    squares += error * error;
  }
  return {sum / kTicks, std::sqrt(squares / kTicks)};
}

// 40,000 normal numbers of rms s have a mean within 5 s / 200 and an rms within 5 s / 283.
// A quantum q adds q^2 / 12 to the square where the noise is not far below it.
TEST(SimulatedExoskeleton, AddsNormalNoiseOfTheStatedStrengthBeforeItRounds) {
  Exoskeleton exo = held_device();
  exo.joints[0].sensor_noise = 1e-3;
  const Spread plain = measured_spread(exo, 7);
  EXPECT_NEAR(plain.mean, 0.0, 2.5e-5);
  EXPECT_NEAR(plain.rms, 1e-3, 1.8e-5);
  exo.joints[0].sensor_lsb = 2e-3;
  EXPECT_NEAR(measured_spread(exo, 7).rms, std::sqrt(1e-6 + 4e-6 / 12.0), 2.5e-5);
}

TEST(SimulatedExoskeleton, MeasuresTheTendonsTorqueOnlyWhereItHasASensor) {
  Exoskeleton exo = two_joint_device();
  exo.joints[0].torque_sensor = true;
  SimulatedExoskeleton device(exo, no_patient(), {}, {}, 1);
  device.begin_tick();
  EXPECT_EQ(device.sample().measured_torque[at(kMcp)], 0.0);
  device.send(torque_command(-0.05), 0.0);
  for (int i = 0; i < 20; ++i) {
    device.end_tick({});
    device.begin_tick();
  }
  EXPECT_EQ(device.sample().measured_torque[at(kMcp)], device.plant().tendon_torque()[at(kMcp)]);
  EXPECT_LT(device.sample().measured_torque[at(kMcp)], 0.0);
  EXPECT_TRUE(std::isnan(device.sample().measured_torque[at(kPip)]));
}

// At 1 kHz and 2 ms back: finished at 1.2 ms it arrives at 3.2 ms, in force from tick 4; finished at 2 ms it
// arrives at tick 4 exactly, in force at that tick.
TEST(SimulatedExoskeleton, UsesACommandFromTheFirstTickAtOrAfterItsArrivalAndHoldsIt) {
  for (const double finished : {1.2e-3, 2e-3}) {
    Exoskeleton exo = held_device();
    exo.controller.return_delay = 2e-3;
    SimulatedExoskeleton device(exo, no_patient(), {}, {}, 1);
    device.send(torque_command(-0.05), finished);
    for (int tick = 0; tick < 10; ++tick)
      EXPECT_EQ(rendered_at_next(device), tick < 4 ? 0.0 : -0.05) << finished << " tick " << tick;
  }
}

TEST(SimulatedExoskeleton, WithoutDelayUsesACommandAtTheNextTick) {
  SimulatedExoskeleton device(held_device(), no_patient(), {}, {}, 1);
  device.begin_tick();
  device.send(torque_command(-0.05), device.time_s());
  EXPECT_EQ(device.rendered().torque[at(kMcp)], 0.0);
  device.end_tick({});
  EXPECT_EQ(rendered_at_next(device), -0.05);
}

TEST(SimulatedExoskeleton, CommandsActInTheOrderInWhichTheyWereSent) {
  Exoskeleton exo = held_device();
  exo.controller.return_delay = 1e-3;
  SimulatedExoskeleton device(exo, no_patient(), {}, {}, 1);
  device.send(torque_command(-0.01), 0.0);
  device.send(torque_command(-0.02), 1.1e-3);
  device.send(torque_command(-0.03), 1.9e-3);  // for the same tick as the one before
  device.send(torque_command(-0.04), 3e-3);
  device.send(torque_command(-0.05), std::numeric_limits<double>::quiet_NaN());  // dropped
  for (const double torque : {0.0, -0.01, -0.01, -0.03, -0.04, -0.04})
    EXPECT_EQ(rendered_at_next(device), torque);
}

// 0.4 s of delay at 1 kHz: 400 commands are on their way, and each arrives.
TEST(SimulatedExoskeleton, ALongDelayLosesNoCommand) {
  Exoskeleton exo = held_device();
  exo.controller.return_delay = 0.4;
  exo.controller.compute_delay = 0.0045;
  SimulatedExoskeleton device(exo, no_patient(), {}, {}, 1);
  for (int tick = 0; tick < 1000; ++tick) {
    const double expected = tick < 405 ? 0.0 : -1e-4 * (tick - 405);
    EXPECT_NEAR(rendered_at_next(device), expected, 1e-15) << tick;
    device.send(torque_command(-1e-4 * tick), 1e-3 * tick + exo.controller.compute_delay);
  }
}

// Room for 2 without delays: of commands for ever later ticks the newest takes the last place.
TEST(SimulatedExoskeleton, WithoutRoomTheNewestCommandTakesThePlaceOfTheOneBeforeIt) {
  SimulatedExoskeleton device(held_device(), no_patient(), {}, {}, 1);
  for (int i = 1; i <= 5; ++i) device.send(torque_command(-0.01 * i), 1e-3 * i);
  for (const double torque : {0.0, -0.01, -0.01, -0.01, -0.01, -0.05})
    EXPECT_EQ(rendered_at_next(device), torque);
}

// 0.3 N of bias on a tendon that only pulls: the motor is commanded it at rest.
TEST(SimulatedExoskeleton, HoldsTheBiasOfATendonThatOnlyPulls) {
  Exoskeleton exo = held_device();
  exo.motors[0].pull_only = true;
  exo.motors[0].bias = 0.3;
  SimulatedExoskeleton device(exo, no_patient(), {}, {}, 1);
  device.begin_tick();
  device.end_tick({});
  EXPECT_EQ(device.plant().tendon(0).motor_force, 0.3);
  EXPECT_EQ(device.plant().tendon(1).motor_force, 0.0);
}

TEST(SimulatedExoskeleton, MovesThePatientsIntentFromTheBeginningToTheEndOfTheTick) {
  PatientParameters patient = no_patient();
  patient.damping[at(kMcp)] = 50.0;  // drags the joint along: its time constant is 2 us
  Exoskeleton exo = two_joint_device();
  exo.motors.clear();
  SimulatedExoskeleton device(exo, patient, {}, {}, 1);
  device.begin_tick();
  device.end_tick({.from = posture(0.0, 0.0), .to = posture(2e-3, 0.0), .push = {}});
  EXPECT_NEAR(device.plant().angle()[at(kMcp)], 2e-3, 1e-4);
  EXPECT_EQ(device.plant().angle()[at(kPip)], 0.0);
}

/// Two joints in a noisy loop with a sampled spring of the host.
JointArray after_a_noisy_loop(std::uint64_t seed) {
  Exoskeleton exo = two_joint_device();
  for (ExoJoint& joint : exo.joints) {
    joint.sensor_noise = 1e-4;
    joint.damping = 1e-2;
  }
  exo.controller.return_delay = 1e-3;
  SimulatedExoskeleton device(exo, no_patient(), {}, posture(0.05, 0.0), seed);
  for (int tick = 0; tick < 500; ++tick) {
    device.begin_tick();
    device.send(torque_command(-0.5 * device.sample().angle[at(kMcp)]), device.time_s());
    device.end_tick({});
  }
  return device.plant().angle();
}

TEST(SimulatedExoskeleton, RepeatsItselfToTheLastBitWithTheSameSeedOnly) {
  EXPECT_EQ(after_a_noisy_loop(11), after_a_noisy_loop(11));
  EXPECT_NE(after_a_noisy_loop(11), after_a_noisy_loop(12));
}

}  // namespace
}  // namespace phalanx
