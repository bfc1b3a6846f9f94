// SPDX-License-Identifier: Apache-2.0
#include "device/link/link_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <map>

#include "device/link/session_bench.h"

namespace phalanx {
namespace {

using test::SessionBench;
using Phase = LinkSession::Phase;

TEST(LinkSession, OpensASessionAndRepeatsConfigureUntilItHasArrived) {
  SessionBench bench(1);
  bench.faults.drop = 0.5;
  bench.open();
  bench.faults.drop = 0.0;
  bench.run(20);
  bench.take_samples();
  ASSERT_FALSE(bench.samples.empty());
  EXPECT_EQ(bench.samples.back().state, DeviceState::kReady);
  const int configures = bench.sent(PHX_CONFIGURE);
  bench.run(200);
  EXPECT_EQ(bench.sent(PHX_CONFIGURE), configures);
  EXPECT_EQ(bench.controller.configure.torque_rate, 10.0f);
}

TEST(LinkSession, BeginsWithNothingCountedAndNothingRefused) {
  const LinkCounters c;
  for (const auto* counter : {&c.received, &c.lost, &c.outdated, &c.corrupt, &c.refused, &c.overflowed,
                              &c.sent, &c.device_corrupt, &c.device_refused, &c.device_outdated})
    EXPECT_EQ(counter->load(), 0U);
  EXPECT_EQ(LinkSession::Refusal{}.reason, 0);
  EXPECT_EQ(LinkSession::Refusal{}.version, 0);
}

TEST(LinkSession, AHelloAndAPingBelongToNoSessionAndAllElseToTheOneThatIsOpen) {
  SessionBench bench(32);
  bench.open();
  bench.run_commanding(20);
  bench.faults.cut_to_host = true;
  bench.run(30);
  std::map<int, int> seen;
  for (const phx_message& message : bench.controller_got) {
    const int type = message.header.type;
    ++seen[type];
    EXPECT_EQ(message.header.epoch, type == PHX_HELLO || type == PHX_PING ? 0U : bench.controller.epoch)
        << type;
  }
  for (const int type : {PHX_HELLO, PHX_CONFIGURE, PHX_COMMAND, PHX_PING}) EXPECT_GE(seen[type], 1) << type;
}

TEST(LinkSession, SamplesAreConnectingUntilTheControllerIsConfigured) {
  SessionBench bench(2);
  bench.session().ask(bench.now());
  bench.run(1);
  bench.faults.cut_to_controller = true;  // HELLO is through, CONFIGURE will not be
  bench.run(5);
  ASSERT_EQ(bench.session().phase(), Phase::kRunning);
  bench.take_samples();
  ASSERT_FALSE(bench.samples.empty());
  for (const DeviceSample& sample : bench.samples) EXPECT_EQ(sample.state, DeviceState::kConnecting);
}

// A session ends at the controller after 1 s without a frame of its host: a host that only looks keeps it.
TEST(LinkSession, KeepsTheSessionWithoutACommand) {
  SessionBench bench(3);
  bench.open();
  for (int second = 0; second < 5; ++second) {
    bench.run(1000);
    bench.take_samples();
    EXPECT_TRUE(bench.controller.session);
  }
  EXPECT_EQ(bench.sent(PHX_COMMAND), 0);
  EXPECT_EQ(bench.fault(), Fault::kNone);
}

// Two HELLOs on their way make two sessions; the host lives in the one that the controller has.
TEST(LinkSession, FollowsTheLaterOfTwoWelcomes) {
  SessionBench bench(4);
  bench.faults.delay = 0.3;  // answers take longer than HELLO's period
  bench.open();
  bench.faults.delay = 0.0;
  bench.run(700);
  bench.take_samples();
  bench.run_commanding(100);
  EXPECT_EQ(bench.fault(), Fault::kNone);
  EXPECT_EQ(bench.samples.back().state, DeviceState::kStarting);
}

TEST(LinkSession, DeliversEverySampleInOrderOnAGoodWire) {
  SessionBench bench(5);
  bench.open();
  bench.run_commanding(1000);
  bench.take_samples();
  for (std::size_t i = 1; i < bench.samples.size(); ++i) {
    ASSERT_EQ(bench.samples[i].sequence, bench.samples[i - 1].sequence + 1);
    ASSERT_EQ(bench.samples[i].raw[0], bench.samples[i - 1].raw[0] + 1);
  }
  EXPECT_EQ(bench.counters().received, bench.samples.size());
  EXPECT_EQ(bench.counters().lost + bench.counters().outdated + bench.counters().corrupt, 0u);
}

class LinkSessionOnABadWire : public testing::TestWithParam<std::uint64_t> {};

// 10 % lost, 10 % twice, 2 % corrupt, up to 5 ms late: what is given is newer and newer, and whole.
TEST_P(LinkSessionOnABadWire, GivesOnlyNewerSamplesAndTheControllerOnlyNewerSteps) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  SessionBench bench(GetParam());
  bench.open();
  bench.faults = {.drop = 0.1, .duplicate = 0.1, .corrupt = 0.02, .delay = 5e-3};
  bench.run_commanding(5000);
  bench.take_samples();
  for (std::size_t i = 1; i < bench.samples.size(); ++i) {
    ASSERT_GT(bench.samples[i].sequence, bench.samples[i - 1].sequence);
    ASSERT_GT(bench.samples[i].time_us, bench.samples[i - 1].time_us);
    ASSERT_GE(bench.samples[i].acted_tick, bench.samples[i - 1].acted_tick);
  }
  const LinkCounters& counters = bench.counters();
  EXPECT_EQ(counters.received, bench.samples.size());
  EXPECT_GT(counters.lost, 0u);
  EXPECT_GT(counters.outdated, 0u);
  EXPECT_GT(counters.corrupt, 0u);
  EXPECT_EQ(bench.fault(), Fault::kNone);
  EXPECT_EQ(bench.controller.state, PHX_STATE_ACTIVE);
}

// Lost: never came, corrupt ones among them. The wire's own count is the truth.
TEST_P(LinkSessionOnABadWire, CountsLossesTwinsAndCorruptFramesExactly) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  SessionBench bench(GetParam());
  bench.open();
  bench.run(10);
  const std::uint32_t begin = bench.controller.sample_sequence;
  const std::uint64_t received = bench.counters().received;
  bench.faults = {.drop = 0.1, .corrupt = 0.05};
  bench.run(3000);
  bench.faults = {};
  bench.run(100);  // the last losses leave the window
  const std::uint64_t sent = bench.controller.sample_sequence - begin;
  const std::uint64_t came = bench.counters().received - received;
  EXPECT_EQ(bench.counters().lost, sent - came);
  EXPECT_GE(bench.counters().lost, bench.counters().corrupt);
  EXPECT_EQ(bench.counters().outdated, 0u);
  bench.faults = {.duplicate = 1.0};
  bench.run(100);
  EXPECT_EQ(bench.counters().outdated, 100u);
  EXPECT_EQ(bench.counters().lost, sent - came);
}

INSTANTIATE_TEST_SUITE_P(Seeds, LinkSessionOnABadWire, testing::Values(11u, 12u, 13u, 14u, 15u));

TEST(LinkSession, RepeatsTheNewestCommandEveryMillisecondWithItsTick) {
  SessionBench bench(6);
  bench.open();
  bench.run_commanding(100);
  bench.controller_got.clear();
  bench.run_commanding(100);
  std::map<std::uint64_t, int> repetitions;
  std::uint64_t newest = 0;
  for (const phx_message& message : bench.controller_got) {
    if (message.header.type != PHX_COMMAND) continue;
    EXPECT_GE(message.as.command.tick, newest);
    newest = message.as.command.tick;
    ++repetitions[newest];
  }
  ASSERT_EQ(repetitions.size(), 20u);
  repetitions.erase(repetitions.begin());
  repetitions.erase(std::prev(repetitions.end()));
  for (const auto& [tick, count] : repetitions) EXPECT_EQ(count, 5) << tick;
}

TEST(LinkSession, StopsRepeatingACommandTwentyMillisecondsAfterItsStep) {
  SessionBench bench(7);
  bench.open();
  bench.run_commanding(100);
  const int before = bench.sent(PHX_COMMAND);
  bench.run(100);  // the loop is stuck, the link's thread is not
  EXPECT_LE(bench.sent(PHX_COMMAND) - before, 20);
  EXPECT_GE(bench.sent(PHX_COMMAND) - before, 15);
  EXPECT_EQ(bench.controller.fault, PHX_FAULT_STEP_TOO_OLD);
}

// SIGSTOP: both threads stand still. Afterwards there is neither a burst nor what was meant before.
TEST(LinkSession, SendsNoBurstAndNothingOldAfterTheHostStoodStill) {
  SessionBench bench(8);
  bench.open();
  bench.run_commanding(100);
  const int before = bench.sent(PHX_COMMAND);
  const std::uint64_t old_tick = bench.controller.step.command.tick;
  bench.host_stopped = true;
  bench.run(50);
  EXPECT_EQ(bench.controller.fault, PHX_FAULT_STEP_TOO_OLD);
  bench.host_stopped = false;
  bench.run(1);
  EXPECT_EQ(bench.sent(PHX_COMMAND), before);
  bench.controller_got.clear();
  bench.run_commanding(5);
  bench.run(1);
  int commands = 0;
  for (const phx_message& message : bench.controller_got) {
    if (message.header.type != PHX_COMMAND) continue;
    ++commands;
    EXPECT_GT(message.as.command.tick, old_tick);
  }
  EXPECT_GE(commands, 1);
  EXPECT_LE(commands, 6);
}

TEST(LinkSession, SendsWallsOnlyWhileTheyHold) {
  SessionBench bench(9);
  bench.open();
  DeviceCommand command;
  command.tick = 1;
  command.enable = true;
  command.sample_time_us = bench.time_us();
  command.wall[4] = {.active = true,
                     .g = {0.01, 0.0, 0.02, 0.0},
                     .d_ref = 1e-3,
                     .stiffness = 500.0,
                     .force_max = 5.0,
                     .host_force = 0.5};
  command.wall_valid_for = 0.01;
  const auto send = [&](SessionBench& b) {
    LinkShared* shared = &b.shared();
    shared->command.write({.command = command, .at = b.now()});
  };
  bench.tick(send);
  bench.run(1);
  ASSERT_EQ(bench.sent(PHX_COMMAND_WALLS), 2);
  EXPECT_EQ(bench.controller.step.valid_us, 10000u);
  EXPECT_EQ(bench.controller.step.wall[4].stiffness, 500.0f);
  EXPECT_EQ(bench.controller.step.wall[3].stiffness, 0.0f);
  command.tick = 2;
  command.wall_valid_for = 0.0;
  bench.tick(send);
  EXPECT_EQ(bench.sent(PHX_COMMAND_WALLS), 2);
  EXPECT_EQ(bench.sent(PHX_COMMAND), 1);
}

// ---- restart, refusal, reset ----

TEST(LinkSession, FindsThatTheControllerRestartedAndSendsNothingUntilReset) {
  SessionBench bench(20);
  bench.open();
  bench.run_commanding(200);
  bench.restart(5000);
  bench.run_commanding(60);
  EXPECT_EQ(bench.fault(), Fault::kControllerRestarted);
  const int commands = bench.sent(PHX_COMMAND);
  const int hellos = bench.sent(PHX_HELLO);
  bench.run_commanding(500);
  EXPECT_EQ(bench.sent(PHX_COMMAND), commands);
  EXPECT_EQ(bench.sent(PHX_HELLO), hellos);
  EXPECT_FALSE(bench.controller.session);
  EXPECT_GT(bench.controller.refused, 0u);  // commands of the session before

  bench.reset();
  bench.run_commanding(100);
  EXPECT_EQ(bench.fault(), Fault::kNone);
  EXPECT_EQ(bench.controller.epoch, 5001u);
  EXPECT_GT(bench.sent(PHX_COMMAND), commands);
  EXPECT_EQ(bench.controller.state, PHX_STATE_STARTING);
  EXPECT_EQ(bench.samples.back().state, DeviceState::kStarting);
}

// Off for 100 ms, then on: the host's PING finds it.
TEST(LinkSession, ReportsTheRestartOnceTheControllerIsBack) {
  SessionBench bench(21);
  bench.open();
  bench.run_commanding(200);
  bench.controller_off = true;
  bench.run_commanding(100);
  EXPECT_EQ(bench.fault(), Fault::kNone);  // silence alone is the station's to judge
  bench.controller_off = false;
  bench.restart(9);
  bench.run_commanding(30);
  EXPECT_EQ(bench.fault(), Fault::kControllerRestarted);
}

TEST(LinkSession, SilenceOfTheWireIsNotARestart) {
  SessionBench bench(22);
  bench.open();
  bench.run_commanding(200);
  bench.faults.cut_to_host = true;
  bench.run_commanding(300);
  bench.faults.cut_to_host = false;
  bench.run_commanding(10);
  EXPECT_EQ(bench.fault(), Fault::kNone);
  EXPECT_GT(bench.counters().lost + 64, 300u);
}

// The controller's clock goes on, but the session is over: it answers PING and sends no sample.
TEST(LinkSession, FindsThatItsSessionIsOver) {
  SessionBench bench(23);
  bench.open();
  bench.run_commanding(100);
  bench.faults.cut_to_controller = true;
  bench.run(1200);
  EXPECT_FALSE(bench.controller.session);
  bench.faults.cut_to_controller = false;
  bench.run(300);
  EXPECT_EQ(bench.fault(), Fault::kControllerRestarted);
  bench.reset();
  bench.run(50);
  EXPECT_EQ(bench.fault(), Fault::kNone);
  EXPECT_TRUE(bench.controller.session);
  EXPECT_EQ(bench.controller.fault, PHX_FAULT_NONE);  // the reset has cleared the latch of the silence, too
}

TEST(LinkSession, IsRefusedAfterARestartIfAnotherHostWasFaster) {
  SessionBench bench(24);
  bench.open();
  bench.run_commanding(100);
  bench.restart(70);
  phx_message hello{};
  hello.header.type = PHX_HELLO;
  hello.header.sequence = 1;
  hello.as.hello.host_id = 4711;
  std::array<std::uint8_t, PHX_FRAME_MAX> frame{}, reply{};
  const std::size_t size = phx_encode(&hello, frame.data(), frame.size());
  std::size_t reply_size = 0;
  ASSERT_EQ(phx_controller_receive(&bench.controller, frame.data(), size, bench.time_us(), reply.data(),
                                   &reply_size),
            PHX_NEW_SESSION);
  bench.run_commanding(30);
  EXPECT_EQ(bench.fault(), Fault::kControllerRestarted);
  bench.reset();
  bench.run(20);
  EXPECT_EQ(bench.fault(), Fault::kRefused);
  EXPECT_EQ(bench.controller.host_id, 4711u);
}

TEST(LinkSession, RefusesAnotherDeviceInThePlaceOfTheFirst) {
  SessionBench bench(25);
  bench.open();
  bench.run_commanding(100);
  write_serial("BENCH-2", bench.device_.serial);
  bench.restart(70);
  bench.run_commanding(60);
  ASSERT_EQ(bench.fault(), Fault::kControllerRestarted);
  bench.reset();
  bench.run_commanding(60);
  EXPECT_EQ(bench.fault(), Fault::kDeviceLost);
  EXPECT_FALSE(bench.controller.session);
}

TEST(LinkSession, ResetsALatchAndTheStepsBeforeStayForgotten) {
  SessionBench bench(26);
  bench.faults.drop = 0.3;
  bench.open();
  bench.run_commanding(100);
  bench.run(100);
  ASSERT_EQ(bench.controller.state, PHX_STATE_LATCHED);
  bench.command(true);  // before the reset: must not act after it
  const std::uint64_t old_tick = bench.controller.step.command.tick;
  bench.reset();
  bench.run(100);
  EXPECT_EQ(bench.controller.state, PHX_STATE_READY);
  EXPECT_EQ(bench.controller.step.command.tick, old_tick);
  const int resets = bench.sent(PHX_RESET);
  bench.run(500);
  EXPECT_EQ(bench.sent(PHX_RESET), resets);
}

// Whoever resets while the emergency stop is pressed must do it again after letting it go.
TEST(LinkSession, AResetDoesNotWaitForTheEmergencyStop) {
  SessionBench bench(27);
  bench.open();
  bench.run_commanding(100);
  bench.estop = true;
  bench.run_commanding(20);
  bench.reset();
  bench.run(500);
  EXPECT_EQ(bench.controller.state, PHX_STATE_LATCHED);
  bench.estop = false;
  bench.run(500);
  EXPECT_EQ(bench.controller.state, PHX_STATE_LATCHED);
  bench.reset();
  bench.run(50);
  EXPECT_EQ(bench.controller.state, PHX_STATE_READY);
}

TEST(LinkSession, AControllerThatComesBackLongAfterAResetWaitsForAnother) {
  SessionBench bench(28);
  bench.open();
  bench.run_commanding(100);
  bench.restart(40);
  bench.run_commanding(60);
  ASSERT_EQ(bench.fault(), Fault::kControllerRestarted);
  bench.controller_off = true;
  bench.reset();
  bench.run(4000);  // longer than hello_timeout
  bench.controller_off = false;
  bench.run(500);
  EXPECT_EQ(bench.fault(), Fault::kControllerRestarted);
  EXPECT_FALSE(bench.controller.session);
  bench.reset();
  bench.run(50);
  EXPECT_EQ(bench.fault(), Fault::kNone);
}

TEST(LinkSession, AnUnpluggedPortIsADeviceLost) {
  SessionBench bench(29);
  bench.open();
  bench.unplugged = true;
  bench.run(1);
  EXPECT_EQ(bench.fault(), Fault::kDeviceLost);
  bench.reset();
  bench.run(10);
  EXPECT_EQ(bench.fault(), Fault::kDeviceLost);
}

// 1,024 frames arrive, twice as many as samples can be stored: the link's thread still sends what is due.
TEST(LinkSession, TakesNoMoreThanSoManyFramesAtATime) {
  SessionBench bench(31);
  bench.open();
  constexpr std::uint64_t kMost = 1024;
  const std::array<std::uint8_t, 3> noise{1, 2, 3};
  for (std::uint64_t i = 0; i < kMost + 5; ++i) bench.to_host(noise.data(), noise.size());
  bench.session().receive(bench.now());
  EXPECT_EQ(bench.counters().corrupt, kMost);
  bench.session().receive(bench.now());
  EXPECT_EQ(bench.counters().corrupt, kMost + 5);
}

TEST(LinkSession, DropsRandomBytesAndOtherVersionsAndGoesOn) {
  constexpr std::uint64_t kSeed = 30;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  SessionBench bench(kSeed);
  bench.open();
  std::mt19937_64 random(kSeed);
  std::uint64_t pieces = 0;
  for (int i = 0; i < 500; ++i) {
    std::vector<std::uint8_t> noise(1 + random() % PHX_FRAME_MAX);
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
    if (random() % 2 == 0) {
      noise[0] = 'P';
      if (noise.size() > 2) noise[1] = 'X';
    }
    bench.to_host(noise.data(), noise.size());
    ++pieces;
    bench.run_commanding(1);
  }
  bench.run_commanding(5);
  EXPECT_EQ(bench.counters().corrupt, pieces);
  EXPECT_EQ(bench.fault(), Fault::kNone);
  EXPECT_EQ(bench.counters().lost, 0u);
}

}  // namespace
}  // namespace phalanx
