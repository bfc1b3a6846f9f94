// SPDX-License-Identifier: Apache-2.0
// Two causes in one tick, a RESET before anything is at rest, and what a latch and a host in fault leave
// behind.
#include "device/link/controller_rig.h"

namespace phalanx::link_test {
namespace {

class LinkReset : public LinkController {
 protected:
  phx_received reset() { return rig.send(rig.frame(PHX_RESET)); }
  void expect_latched(int fault, int channel = 0) {
    EXPECT_EQ(rig.controller.state, PHX_STATE_LATCHED);
    EXPECT_EQ(rig.sample.fault, fault);
    EXPECT_EQ(rig.sample.fault_channel, channel);
    for (const float torque : rig.output.torque) EXPECT_EQ(torque, 0.0F);
  }
  /// The next command is the host's own fault.
  phx_message fault_command(std::uint8_t flags) {
    phx_message message = rig.next_command(kLimit);
    message.as.command.flags = flags;
    return message;
  }
};

// ---- several causes in one tick ----

// The third tick of a bad sensor brings the emergency stop, and the drive too: the stop is named; without it
// the drive; and RESET waits until each of them is gone.
TEST_F(LinkReset, TheEmergencyStopIsNamedBeforeTheDriveAndTheDriveBeforeASensorOfTheSameTick) {
  for (const bool estop : {true, false}) {
    rig = Rig();
    rig.open_and_act(0.3F);
    rig.raw[2] = 4096;
    rig.drive(0.3F, 2);
    ASSERT_EQ(rig.sample.state, PHX_STATE_ACTIVE);
    rig.estop = estop;
    rig.drive_fault = true;
    rig.drive(0.3F, 1);
    expect_latched(estop ? PHX_FAULT_EMERGENCY_STOP : PHX_FAULT_DRIVE);
    for (int still = estop ? 0 : 1; still < 3; ++still) {
      reset();
      rig.tick();
      expect_latched(estop ? PHX_FAULT_EMERGENCY_STOP : PHX_FAULT_DRIVE);
      if (still == 0) rig.estop = false;
      if (still == 1) rig.drive_fault = false;
      if (still == 2) rig.raw[2] = 100;
      rig.tick();
    }
    reset();
    rig.tick();
    EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
    EXPECT_EQ(rig.sample.fault, PHX_FAULT_NONE);
  }
}

// A step of 20 ms and a sensor's third bad tick come together: the sensor is named, with its channel, which a
// RESET clears.
TEST_F(LinkReset, ASensorIsNamedBeforeAStepThatIsTooOld) {
  rig.open_and_act(0.3F);
  rig.command(0.3F);
  rig.silent(17);
  rig.raw[2] = -1;
  rig.silent(3);
  expect_latched(PHX_FAULT_SENSOR_RANGE, 2);
  rig.raw[2] = 0;
  rig.tick();
  reset();
  rig.tick();
  EXPECT_EQ(rig.sample.fault, PHX_FAULT_NONE);
  EXPECT_EQ(rig.sample.fault_channel, 0);
}

// ---- RESET and what is not at rest ----

// One bad sample is not a fault and yet no time to start: RESET waits for a tick in which all are good.
TEST_F(LinkReset, WaitsForASensorThatIsBadForTheFirstTime) {
  for (int bad_for = 1; bad_for <= 2; ++bad_for) {
    rig = Rig();
    rig.open_and_act(0.3F);
    rig.estop = true;
    rig.tick();
    rig.estop = false;
    rig.raw[0] = 5000;
    rig.silent(bad_for);
    reset();
    rig.raw[0] = 0;
    rig.tick();
    expect_latched(PHX_FAULT_EMERGENCY_STOP);
    reset();
    rig.tick();
    EXPECT_EQ(rig.sample.state, PHX_STATE_READY) << bad_for;
  }
}

// The latch has zeroed the torque in its own tick. So a RESET right after it finds it at rest, and what acts
// next begins with the first thousandth of its ramp: nothing is left of the 0.5 Nm, nor of the fade.
TEST_F(LinkReset, RightAfterTheLatchFindsTheTorqueAtRest) {
  rig.open_and_act(kLimit);
  rig.command(kLimit);
  rig.silent(17);  // the fade has come to a half
  rig.estop = true;
  EXPECT_EQ(rig.tick(), 0.0F);
  rig.estop = false;
  EXPECT_EQ(rig.tick(), 0.0F);
  reset();
  EXPECT_EQ(rig.tick(), 0.0F);
  EXPECT_EQ(rig.sample.factor, 0.0F);
  for (int i = 1; i <= 3; ++i)
    EXPECT_NEAR(rig.drive(-kLimit, 1), -kLimit * 1e-3F * static_cast<float>(i), 1e-7F);
}

// 0.3 Nm on all twenty: half of it at 17 ms, one step of the rate more with the next command, nothing with
// the latch, and a thousandth at the beginning of the next ramp.
TEST_F(LinkReset, EveryJointFadesAndRisesAndComesToRest) {
  const auto drive_all = [&] {
    phx_message message = rig.next_command(0.3F);
    for (float& torque : message.as.command.torque) torque = 0.3F;
    rig.send(message);
  };
  const auto expect_all = [&](float expected) {
    for (const float torque : rig.output.torque) EXPECT_NEAR(torque, expected, 1e-6F);
  };
  rig.open();
  for (int i = 0; i <= 1000; ++i) {
    drive_all();
    rig.tick();
  }
  expect_all(0.3F);
  drive_all();
  rig.silent(17);
  expect_all(0.15F);
  drive_all();
  rig.tick();
  expect_all(0.16F);
  rig.estop = true;
  rig.tick();
  expect_all(0.0F);
  rig.estop = false;
  rig.tick();
  reset();
  rig.tick();
  drive_all();
  rig.tick();
  expect_all(0.3e-3F);
}

// Between two ticks nothing is latched yet: the RESET does nothing, and the tick latches all the same.
TEST_F(LinkReset, BeforeTheTickThatSeesTheStopChangesNothing) {
  rig.open_and_act(0.3F);
  rig.estop = true;
  EXPECT_EQ(reset(), PHX_USED);
  rig.tick();
  expect_latched(PHX_FAULT_EMERGENCY_STOP);
}

// A host in fault is not a latch: a RESET in the middle of its 5 ms leaves the torque on its way, 0.1 Nm a
// tick.
TEST_F(LinkReset, WhileTheHostsFaultBringsTheTorqueDownChangesNothing) {
  rig.open_and_act(kLimit);
  for (int i = 1; i <= 5; ++i) {
    rig.send(fault_command(PHX_COMMAND_FAULT));
    EXPECT_EQ(reset(), PHX_USED);
    EXPECT_NEAR(rig.tick(), kLimit - 0.1F * static_cast<float>(i), 1e-6F) << i;
    EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
  }
  EXPECT_EQ(rig.output.torque[kJoint], 0.0F);
}

// A sample of the very moment of the RESET is not older than it.
TEST_F(LinkReset, ACommandFromTheSampleOfTheResetsOwnMomentStarts) {
  rig.open_and_act(0.3F);
  rig.silent(20);
  expect_latched(PHX_FAULT_STEP_TOO_OLD);
  reset();  // at the time of the newest sample
  EXPECT_EQ(rig.command(0.3F), PHX_USED);
  rig.tick();
  EXPECT_EQ(rig.sample.state, PHX_STATE_STARTING);
  EXPECT_EQ(rig.sample.outdated, 0U);
}

// ---- limits around a latch and a fault ----

// While the device is latched nothing acts, so that CONFIGURE is taken: what starts after the RESET has 0.1
// Nm.
TEST_F(LinkReset, ALatchedDeviceTakesNewLimits) {
  rig.open_and_act(0.3F);
  rig.estop = true;
  rig.tick();
  rig.configure(0.1F, kRate);
  rig.estop = false;
  rig.tick();
  reset();
  rig.tick();
  EXPECT_FLOAT_EQ(rig.drive(0.3F, 1001), 0.1F);
}

// The host has disabled and the torque is still on its way down from 0.5 Nm by 0.01 Nm a tick: a limit of 0.1
// Nm that comes now holds at the next tick.
TEST_F(LinkReset, ANewLimitHoldsAtOnceForATorqueOnItsWayDown) {
  rig.open_and_act(kLimit);
  rig.disable();
  EXPECT_NEAR(rig.tick(), 0.49F, 1e-6F);
  rig.configure(0.1F, kRate);
  EXPECT_NEAR(rig.tick(), 0.1F, 1e-6F);
}

// Of the time before the very first tick nothing can be said: one period counts, 1 mNm at 1 Nm/s. The ramp
// alone would let through 5 mNm after 10 ms.
TEST_F(LinkReset, TheFirstTickOfAllCountsOnePeriod) {
  rig.hello();
  rig.configure(kLimit, 1.0F);
  phx_message first = rig.next_command(kLimit);
  first.as.command.sample_time_us = rig.now;
  ASSERT_EQ(rig.send(first), PHX_USED);
  EXPECT_NEAR(rig.tick(10 * kPeriod), 1e-3F, 1e-8F);
}

// ENABLE beside FAULT is FAULT.
TEST_F(LinkReset, AHostInFaultIsNotEnabledWhateverEnableSays) {
  rig.open_and_act(kLimit);
  for (int i = 1; i <= 5; ++i) {
    rig.send(fault_command(PHX_COMMAND_ENABLE | PHX_COMMAND_FAULT));
    EXPECT_NEAR(rig.tick(), kLimit - 0.1F * static_cast<float>(i), 1e-6F) << i;
    EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
  }
  EXPECT_EQ(rig.drive(kLimit, 1), kLimit / 1000.0F) << "a ramp from the beginning";
}

// 1000 Nm/s are 1 Nm a tick: a host's fault must not make that the 0.1 Nm of its 5 ms.
TEST_F(LinkReset, AHostsFaultNeverSlowsTheTorqueDown) {
  phx_device device = bench_device();
  device.torque_rate = 1000.0F;
  rig = Rig(device);
  rig.hello();
  rig.configure(kLimit, 1000.0F);
  rig.tick();
  rig.drive(kLimit, 1001);
  ASSERT_FLOAT_EQ(rig.output.torque[kJoint], kLimit);
  rig.send(fault_command(PHX_COMMAND_FAULT));
  EXPECT_EQ(rig.tick(), 0.0F);
}

}  // namespace
}  // namespace phalanx::link_test
