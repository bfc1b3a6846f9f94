// SPDX-License-Identifier: Apache-2.0
// Which commands act, and for how long: ticks, ages, repetitions, the fade, the start ramp.
#include "device/link/controller_rig.h"

namespace phalanx::link_test {
namespace {

class LinkAge : public LinkController {};

// The command of age 0 is sent between two ticks: the n-th tick after it sees it n ms old.
TEST_F(LinkAge, HoldsTheTorqueTo14MsThenFallsInAStraightLineToZeroAt20MsAndLatches) {
  rig.open_and_act(0.3F);
  rig.command(0.3F);
  for (int age = 1; age <= 30; ++age) {
    const float torque = rig.tick();
    const float factor = age <= 14 ? 1.0F : age >= 20 ? 0.0F : static_cast<float>(20 - age) / 6.0F;
    EXPECT_NEAR(torque, 0.3F * factor, 1e-6F) << "age " << age << " ms";
    EXPECT_NEAR(rig.sample.factor, factor, 1e-6F) << "age " << age << " ms";
    EXPECT_EQ(rig.sample.acted_age_us, static_cast<std::uint32_t>(1000 * age));
    EXPECT_EQ(rig.sample.state, age <= 14  ? PHX_STATE_ACTIVE
                                : age < 20 ? PHX_STATE_FADING
                                           : PHX_STATE_LATCHED)
        << "age " << age << " ms";
    EXPECT_EQ(rig.sample.fault, age < 20 ? PHX_FAULT_NONE : PHX_FAULT_STEP_TOO_OLD);
  }
}

TEST_F(LinkAge, IsNotRefreshedByRepetitionsNorAreThoseCountedAsOutdated) {
  rig.open_and_act(0.3F);
  phx_message repeated = rig.next_command(0.3F);
  for (int age = 1; age <= 20; ++age) {
    EXPECT_EQ(rig.send(repeated), PHX_USED);
    repeated.header.sequence = 0;
    rig.tick();
  }
  EXPECT_EQ(rig.output.torque[kJoint], 0.0F);
  EXPECT_EQ(rig.sample.fault, PHX_FAULT_STEP_TOO_OLD);
  EXPECT_EQ(rig.sample.outdated, 0U);
}

TEST_F(LinkAge, IsNotRefreshedByATickThatWasTakenEvenIfItNamesANewerSample) {
  rig.open_and_act(0.3F);
  const phx_message taken = rig.next_command(0.3F);
  rig.send(taken);
  for (int age = 1; age <= 20; ++age) {
    rig.tick();
    phx_message repeated = taken;
    repeated.as.command.sample_time_us = rig.sample.time_us;
    rig.send(repeated);
  }
  EXPECT_EQ(rig.sample.fault, PHX_FAULT_STEP_TOO_OLD);
}

TEST_F(LinkAge, DropsACommandThatIsOlderThanTheOneActedOn) {
  rig.open_and_act(0.3F);
  const phx_message late = rig.next_command(-0.3F);
  rig.command(0.3F);
  rig.tick();
  EXPECT_EQ(rig.send(late), PHX_DROPPED);
  EXPECT_FLOAT_EQ(rig.tick(), 0.3F);
  EXPECT_EQ(rig.sample.outdated, 1U);
  EXPECT_EQ(rig.sample.acted_tick, late.as.command.tick + 1);
}

TEST_F(LinkAge, CountsACommandOfAge20MsAsOutdatedAndTakesOneJustBelow) {
  rig.open();
  const std::uint64_t old = rig.sample.time_us;
  rig.silent(20);
  phx_message command = rig.next_command(0.3F);
  command.as.command.sample_time_us = old;
  EXPECT_EQ(rig.send(command), PHX_DROPPED);
  EXPECT_EQ(rig.controller.outdated, 1U);
  EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
  command.header.sequence = 0;
  command.as.command.sample_time_us = old + 1;
  EXPECT_EQ(rig.send(command), PHX_USED);
  EXPECT_EQ(rig.controller.outdated, 1U);
}

TEST_F(LinkAge, CountsACommandFromTheFutureAsCorrupt) {
  rig.open();
  phx_message command = rig.next_command(0.3F);
  command.as.command.sample_time_us = rig.now + 1;
  EXPECT_EQ(rig.send(command), PHX_DROPPED);
  EXPECT_EQ(rig.controller.corrupt, 1U);
  EXPECT_EQ(rig.tick(), 0.0F);
}

// A host stopped for 50 ms finds its queue sent at once when it goes on.
TEST_F(LinkAge, LetsNoBurstOfOldCommandsActAfterTheHostWasStopped) {
  rig.open_and_act(0.3F);
  std::vector<phx_message> queue;
  for (int i = 0; i < 50; ++i) {
    queue.push_back(rig.next_command(0.5F));
    rig.tick();
  }
  EXPECT_EQ(rig.sample.state, PHX_STATE_LATCHED);
  for (const phx_message& command : queue) {
    rig.send(command);
    EXPECT_EQ(rig.tick(), 0.0F);
  }
  EXPECT_EQ(rig.sample.state, PHX_STATE_LATCHED);
}

TEST_F(LinkAge, AppliesInABurstWithinTheHoldOnlyTheNewest) {
  rig.open_and_act(0.3F);
  std::vector<phx_message> queue;
  for (int i = 0; i < 5; ++i) {
    queue.push_back(rig.next_command(i == 4 ? 0.3F : -0.5F));
    rig.tick();
  }
  for (auto command = queue.rbegin(); command != queue.rend(); ++command) rig.send(*command);
  EXPECT_FLOAT_EQ(rig.tick(), 0.3F);
  EXPECT_EQ(rig.sample.outdated, 4U);
  EXPECT_EQ(rig.sample.acted_age_us, 2000U);
}

TEST_F(LinkAge, RisesAfterAFadeFromWhatWasSentAndByTheRateLimit) {
  rig.open_and_act(0.3F);
  rig.command(0.3F);
  float sent = rig.silent(19);
  EXPECT_NEAR(sent, 0.05F, 1e-6F);
  for (int i = 0; i < 24; ++i) {
    const float next = rig.drive(0.3F, 1);
    EXPECT_NEAR(next, sent + 0.01F, 1e-6F);
    EXPECT_EQ(rig.sample.state, PHX_STATE_ACTIVE);
    EXPECT_FLOAT_EQ(rig.sample.factor, 1.0F);
    sent = next;
  }
  EXPECT_FLOAT_EQ(rig.drive(0.3F, 2), 0.3F);
}

// At 19 ms a sixth of 0.3 Nm is sent, 0.05 Nm. The fresher step is itself 17 ms old at the next tick, a half:
// before its fade the torque goes on from 0.05 / 0.5 = 0.1 Nm, rises by the rate's 0.01 Nm, and half of that
// is sent.
TEST_F(LinkAge, RisesFromWhatWasSentAlsoIfTheFresherStepFades) {
  rig.open_and_act(0.3F);
  rig.command(0.3F);
  EXPECT_NEAR(rig.silent(19), 0.05F, 1e-6F);
  phx_message fresher = rig.next_command(0.3F);
  fresher.as.command.sample_time_us -= 16000;
  ASSERT_EQ(rig.send(fresher), PHX_USED);
  EXPECT_NEAR(rig.tick(), 0.055F, 1e-6F);
  EXPECT_EQ(rig.sample.state, PHX_STATE_FADING);
}

// 10 ms jitter of a slow host, 5 ms steps: nothing fades, nothing latches.
TEST_F(LinkAge, RunsOnWithAStepEvery5MsOfWhichTwoInThreeAreLost) {
  rig.open_and_act(0.3F);
  for (int i = 0; i < 2000; ++i) {
    if (i % 14 == 0) rig.command(0.3F);
    ASSERT_FLOAT_EQ(rig.tick(), 0.3F) << "tick " << i;
  }
  EXPECT_EQ(rig.sample.state, PHX_STATE_ACTIVE);
}

TEST_F(LinkAge, LatchesIfTheClockRunsBehindTheSampleOfTheStep) {
  rig.open_and_act(0.3F);
  rig.now -= 5000;
  EXPECT_EQ(rig.tick(), 0.0F);
  EXPECT_EQ(rig.sample.fault, PHX_FAULT_STEP_TOO_OLD);
}

TEST_F(LinkAge, ActsOnNothingBeforeConfigure) {
  rig.hello();
  rig.tick();
  EXPECT_EQ(rig.drive(0.3F, 10), 0.0F);
  EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
  EXPECT_EQ(rig.sample.acted_tick, 0U);
  rig.configure();
  rig.drive(0.3F, 10);
  EXPECT_EQ(rig.sample.state, PHX_STATE_STARTING);
}

TEST_F(LinkAge, StartsWithARampOfOneSecond) {
  rig.open();
  for (int i = 1; i <= 1000; ++i) {
    const float torque = rig.drive(0.4F, 1);
    ASSERT_NEAR(torque, 0.4F * static_cast<float>(i) / 1000.0F, 2e-6F) << "tick " << i;
    ASSERT_NEAR(rig.sample.factor, static_cast<float>(i) / 1000.0F, 1e-6F);
    ASSERT_EQ(rig.sample.state, i < 1000 ? PHX_STATE_STARTING : PHX_STATE_ACTIVE) << "tick " << i;
  }
}

TEST_F(LinkAge, GoesToZeroByTheRateLimitWhenTheHostDisablesAndHasNoFault) {
  rig.open_and_act(0.05F);
  for (int i = 1; i <= 8; ++i) {
    rig.disable();
    EXPECT_NEAR(rig.tick(), std::max(0.0F, 0.05F - 0.01F * static_cast<float>(i)), 1e-6F);
    EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
  }
  rig.silent(100);
  EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
  EXPECT_EQ(rig.sample.fault, PHX_FAULT_NONE);
}

// 0.5 Nm would take 50 ms to zero by the rate; a host that dies while it disables is still at zero by 20 ms.
TEST_F(LinkAge, IsAtZeroBy20MsEvenIfTheHostDiesWhileItDisables) {
  rig.open_and_act(0.5F);
  rig.disable();
  EXPECT_GT(rig.silent(14), 0.3F);
  EXPECT_EQ(rig.silent(6), 0.0F);
  EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
}

TEST_F(LinkAge, StartsWithANewRampAfterEveryDisable) {
  rig.open_and_act(0.3F);
  rig.disable();
  rig.silent(100);
  EXPECT_NEAR(rig.drive(0.3F, 1), 0.3F / 1000.0F, 1e-6F);
  EXPECT_EQ(rig.sample.state, PHX_STATE_STARTING);
}

TEST_F(LinkAge, FadesInTheStartRampToo) {
  rig.open();
  rig.drive(0.4F, 500);
  rig.command(0.4F);
  EXPECT_NEAR(rig.silent(17), 0.4F * 0.517F * 0.5F, 1e-5F);
  EXPECT_EQ(rig.sample.state, PHX_STATE_FADING);
  EXPECT_NEAR(rig.sample.factor, 0.517F * 0.5F, 1e-5F);
  rig.drive(0.4F, 100);
  EXPECT_EQ(rig.sample.state, PHX_STATE_STARTING);
}

TEST_F(LinkAge, DropsACommandWithANumberThatIsNotFiniteAndFades) {
  rig.open_and_act(0.3F);
  for (int age = 1; age <= 20; ++age) {
    EXPECT_EQ(rig.command(std::nanf("")), PHX_DROPPED);
    rig.tick();
  }
  EXPECT_EQ(rig.sample.corrupt, 20U);
  EXPECT_EQ(rig.sample.fault, PHX_FAULT_STEP_TOO_OLD);
}

}  // namespace
}  // namespace phalanx::link_test
