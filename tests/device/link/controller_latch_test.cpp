// SPDX-License-Identifier: Apache-2.0
// What latches the controller, and what it takes to leave the latch.
#include "device/link/controller_rig.h"

namespace phalanx::link_test {
namespace {

class LinkLatch : public LinkController {
 protected:
  phx_received reset() { return rig.send(rig.frame(PHX_RESET)); }
  void expect_latched(int fault) {
    EXPECT_EQ(rig.sample.state, PHX_STATE_LATCHED);
    EXPECT_EQ(rig.sample.fault, fault);
    EXPECT_EQ(rig.sample.factor, 0.0F);
    EXPECT_EQ(rig.output.torque[kJoint], 0.0F);
  }
  void latch_by_age() {
    rig.open_and_act(0.3F);
    rig.silent(20);
    expect_latched(PHX_FAULT_STEP_TOO_OLD);
  }
};

TEST_F(LinkLatch, TheEmergencyStopLatchesWithinItsTick) {
  rig.open_and_act(0.3F);
  rig.estop = true;
  EXPECT_EQ(rig.drive(0.3F, 1), 0.0F);
  expect_latched(PHX_FAULT_EMERGENCY_STOP);
  EXPECT_EQ(rig.sample.flags, PHX_SAMPLE_ESTOP | PHX_SAMPLE_CONFIGURED);
  rig.estop = false;
  EXPECT_EQ(rig.drive(0.3F, 50), 0.0F);  // released: still latched
  expect_latched(PHX_FAULT_EMERGENCY_STOP);
  EXPECT_EQ(rig.sample.flags, PHX_SAMPLE_CONFIGURED);
}

TEST_F(LinkLatch, ADriveFaultLatchesWithinItsTick) {
  rig.open_and_act(0.3F);
  rig.drive_fault = true;
  EXPECT_EQ(rig.drive(0.3F, 1), 0.0F);
  expect_latched(PHX_FAULT_DRIVE);
}

TEST_F(LinkLatch, ASensorOutOfRangeLatchesAtTheThirdTickRunningAndIsNamed) {
  for (const std::int32_t value : {4096, -1, INT32_MAX, INT32_MIN}) {
    rig = Rig();
    rig.open_and_act(0.3F);
    rig.raw[2] = value;
    EXPECT_FLOAT_EQ(rig.drive(0.3F, 2), 0.3F);
    EXPECT_EQ(rig.drive(0.3F, 1), 0.0F);
    expect_latched(PHX_FAULT_SENSOR_RANGE);
    EXPECT_EQ(rig.sample.fault_channel, 2);
  }
}

TEST_F(LinkLatch, ASensorOutOfRangeInTwoTicksOfThreeDoesNotLatch) {
  rig.open_and_act(0.3F);
  for (int i = 0; i < 300; ++i) {
    rig.raw[2] = i % 3 == 0 ? 100 : 4096;
    ASSERT_FLOAT_EQ(rig.drive(0.3F, 1), 0.3F);
  }
}

TEST_F(LinkLatch, TheEndsOfASensorsRangeAreGood) {
  rig.open_and_act(0.3F);
  rig.raw = {4000, -4000, 4095};
  EXPECT_FLOAT_EQ(rig.drive(0.3F, 10), 0.3F);
  rig.raw[2] = 0;
  EXPECT_FLOAT_EQ(rig.drive(0.3F, 10), 0.3F);
}

TEST_F(LinkLatch, AChannelThatTheDeviceHasNotIsNotJudged) {
  rig.open_and_act(0.3F);
  for (std::size_t i = 3; i < PHX_CHANNELS; ++i) rig.raw[i] = INT32_MAX;
  EXPECT_FLOAT_EQ(rig.drive(0.3F, 10), 0.3F);
  EXPECT_EQ(rig.sample.raw[3], 0);
}

TEST_F(LinkLatch, FaultsAreJudgedAlwaysButLatchOnlyWhileASessionIsOpen) {
  rig.raw[0] = 5000;
  rig.silent(10);
  EXPECT_EQ(rig.controller.state, PHX_STATE_NO_SESSION);
  rig.hello();
  rig.tick();  // the sensor was bad before: no further three ticks
  expect_latched(PHX_FAULT_SENSOR_RANGE);
}

TEST_F(LinkLatch, TheFirstFaultIsTheOneThatIsReported) {
  latch_by_age();
  rig.estop = true;
  rig.silent(5);
  expect_latched(PHX_FAULT_STEP_TOO_OLD);
}

TEST_F(LinkLatch, FreshCommandsChangeNothingWhileLatched) {
  latch_by_age();
  const std::uint64_t acted = rig.sample.acted_tick;
  EXPECT_EQ(rig.drive(0.3F, 100), 0.0F);
  expect_latched(PHX_FAULT_STEP_TOO_OLD);
  EXPECT_EQ(rig.sample.acted_tick, acted);
  EXPECT_EQ(rig.sample.outdated, 0U);
}

TEST_F(LinkLatch, ResetLeadsToReadyAndANewerStepToANewStartRamp) {
  latch_by_age();
  EXPECT_EQ(reset(), PHX_USED);
  EXPECT_EQ(rig.controller.state, PHX_STATE_READY) << "before the tick, too";
  rig.silent(3);
  EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
  EXPECT_EQ(rig.sample.fault, PHX_FAULT_NONE);
  EXPECT_EQ(rig.sample.acted_tick, 0U);
  for (int i = 1; i <= 50; ++i)
    EXPECT_NEAR(rig.drive(0.3F, 1), 0.3F * static_cast<float>(i) / 1000.0F, 1e-6F);
  EXPECT_EQ(rig.sample.state, PHX_STATE_STARTING);
}

TEST_F(LinkLatch, ACommandFromASampleOfBeforeTheResetDoesNotStart) {
  latch_by_age();
  const phx_message before = rig.next_command(0.3F);
  rig.now += 500;  // between two ticks
  reset();
  EXPECT_EQ(rig.send(before), PHX_DROPPED);
  EXPECT_EQ(rig.controller.outdated, 1U);
  EXPECT_EQ(rig.tick(500), 0.0F);
  EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
  rig.drive(0.3F, 1);
  EXPECT_EQ(rig.sample.state, PHX_STATE_STARTING);
}

TEST_F(LinkLatch, ARepetitionOfTheLastStepDoesNotStartAfterReset) {
  rig.open_and_act(0.3F);
  const phx_message last = rig.next_command(0.3F);
  rig.send(last);
  rig.estop = true;
  rig.tick();
  rig.estop = false;
  rig.tick();
  reset();
  for (int i = 0; i < 10; ++i) {
    rig.send(last);
    EXPECT_EQ(rig.tick(), 0.0F);
    EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
  }
}

TEST_F(LinkLatch, ResetWaitsUntilTheEmergencyStopIsReleased) {
  rig.open_and_act(0.3F);
  rig.estop = true;
  rig.tick();
  reset();
  rig.tick();
  expect_latched(PHX_FAULT_EMERGENCY_STOP);
  rig.estop = false;
  reset();  // the controller has not seen the release yet
  rig.tick();
  expect_latched(PHX_FAULT_EMERGENCY_STOP);
  reset();
  rig.tick();
  EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
}

TEST_F(LinkLatch, ResetWaitsUntilTheDriveIsGood) {
  rig.open_and_act(0.3F);
  rig.drive_fault = true;
  rig.tick();
  reset();
  rig.tick();
  expect_latched(PHX_FAULT_DRIVE);
  rig.drive_fault = false;
  rig.tick();
  reset();
  rig.tick();
  EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
}

TEST_F(LinkLatch, ResetWaitsUntilTheSensorsAreGood) {
  rig.open_and_act(0.3F);
  rig.raw[1] = 5000;
  rig.silent(5);
  reset();
  rig.tick();
  expect_latched(PHX_FAULT_SENSOR_RANGE);
  rig.raw[1] = 0;
  rig.tick();
  reset();
  rig.tick();
  EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
}

// 256 bad ticks are one more than a byte counts to.
TEST_F(LinkLatch, ASensorThatIsBadForLongIsNotTakenForAGoodOne) {
  rig.open_and_act(0.3F);
  rig.raw[1] = 5000;
  rig.silent(256);
  reset();
  rig.tick();
  expect_latched(PHX_FAULT_SENSOR_RANGE);
  EXPECT_EQ(rig.sample.fault_channel, 1);
}

TEST_F(LinkLatch, ResetChangesNothingWhileNothingIsLatched) {
  rig.open_and_act(0.3F);
  reset();
  EXPECT_FLOAT_EQ(rig.drive(0.3F, 1), 0.3F);
  EXPECT_EQ(rig.sample.state, PHX_STATE_ACTIVE);
}

TEST_F(LinkLatch, SurvivesANewSessionAndAnotherHost) {
  latch_by_age();
  rig.hello();
  EXPECT_EQ(rig.controller.state, PHX_STATE_LATCHED) << "before the tick, too";
  rig.configure();
  rig.tick();
  expect_latched(PHX_FAULT_STEP_TOO_OLD);
  EXPECT_EQ(rig.drive(0.3F, 20), 0.0F);
  rig.silent(1000);
  EXPECT_FALSE(rig.has_sample);
  EXPECT_EQ(rig.controller.state, PHX_STATE_LATCHED);
  rig.hello(99);
  rig.epoch = rig.reply->header.epoch;
  rig.tick();
  expect_latched(PHX_FAULT_STEP_TOO_OLD);
  reset();
  rig.tick();
  EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
}

TEST_F(LinkLatch, SurvivesAGoodbye) {
  latch_by_age();
  rig.send(rig.frame(PHX_GOODBYE));
  EXPECT_EQ(rig.controller.state, PHX_STATE_LATCHED) << "before the tick, too";
  rig.tick();
  EXPECT_EQ(rig.controller.state, PHX_STATE_LATCHED);
  EXPECT_FALSE(rig.has_sample);
}

TEST_F(LinkLatch, AHostThatDiesWhileItActsLatchesAndThenLosesTheSession) {
  rig.open_and_act(0.3F);
  rig.silent(1100);
  EXPECT_EQ(rig.controller.state, PHX_STATE_LATCHED);
  EXPECT_FALSE(rig.has_sample);
}

}  // namespace
}  // namespace phalanx::link_test
