// SPDX-License-Identifier: Apache-2.0
// What the host's side repeats and for how long, and which frames of others it believes; time is a number.
#include <gtest/gtest.h>

#include <cmath>

#include "device/link/link_session.h"
#include "device/link/session_bench.h"

namespace phalanx {
namespace {

using test::SessionBench;
using Phase = LinkSession::Phase;

constexpr std::uint64_t kBenchHost = 77;

/// A frame that the controller did not send reaches the host.
void forge(SessionBench& bench, phx_message message) {
  std::array<std::uint8_t, PHX_FRAME_MAX> frame{};
  const std::size_t size = phx_encode(&message, frame.data(), frame.size());
  ASSERT_GT(size, 0U);
  bench.to_host(frame.data(), size);
}

phx_message forged(std::uint8_t type, std::uint32_t epoch) {
  phx_message message{};
  message.header.type = type;
  message.header.epoch = epoch;
  return message;
}

/// Open, commanded, and latched by an emergency stop that is released again.
void latch(SessionBench& bench) {
  bench.open();
  bench.run_commanding(100);
  bench.estop = true;
  bench.run_commanding(5);
  bench.estop = false;
  bench.run_commanding(5);
  ASSERT_EQ(bench.controller.state, PHX_STATE_LATCHED);
}

// ---- reset ----

// 0.2 s: a stop that is let go of within that time clears, one that is let go of later needs another reset.
TEST(LinkRepeat, AResetIsRepeatedForTwoTenthsOfASecond) {
  for (const int released_after : {150, 250}) {
    SessionBench bench(40);
    bench.open();
    bench.run_commanding(100);
    bench.estop = true;
    bench.run(20);
    bench.reset();
    bench.run(released_after);
    bench.estop = false;
    bench.run(300);
    EXPECT_EQ(bench.controller.state, released_after < 200 ? PHX_STATE_READY : PHX_STATE_LATCHED)
        << released_after;
    if (released_after < 200) continue;
    EXPECT_GE(bench.sent(PHX_RESET), 34) << "every 5 ms, or by a rounding every 6";
    EXPECT_LE(bench.sent(PHX_RESET), 41);
  }
}

// Once a sample says that the latch is off no RESET is on its way any more that could clear the next latch.
TEST(LinkRepeat, AResetThatHasWorkedDoesNotClearTheNextLatch) {
  SessionBench bench(41);
  latch(bench);
  bench.reset();
  bench.run(20);
  ASSERT_EQ(bench.controller.state, PHX_STATE_READY);
  bench.estop = true;
  bench.run(10);
  bench.estop = false;
  bench.run(300);
  EXPECT_EQ(bench.controller.state, PHX_STATE_LATCHED);
}

// The step of before a reset is younger than 20 ms, and must not go out again: neither the one that is
// repeated nor one that was written and not sent yet.
TEST(LinkRepeat, NothingThatWasCommandedBeforeAResetIsSentAfterIt) {
  SessionBench bench(42);
  bench.open();
  bench.run_commanding(100);
  const int before = bench.sent(PHX_COMMAND);
  bench.reset();
  bench.run(15);
  EXPECT_EQ(bench.sent(PHX_COMMAND), before);
  bench.command(true);
  bench.reset();
  bench.run(15);
  EXPECT_EQ(bench.sent(PHX_COMMAND), before);
  bench.command(true);
  bench.run(3);
  EXPECT_EQ(bench.sent(PHX_COMMAND), before + 3) << "what comes after it is";
}

// The session that a reset asks for opens half a second later: the RESET itself has its time from there.
TEST(LinkRepeat, AResetThatOpensTheSessionAgainClearsTheLatchInItHoweverLongThatTakes) {
  SessionBench bench(43);
  latch(bench);
  bench.faults.cut_to_controller = true;
  bench.run(1300);
  ASSERT_FALSE(bench.controller.session);
  bench.faults.cut_to_controller = false;
  bench.run(300);
  ASSERT_EQ(bench.fault(), Fault::kControllerRestarted);
  bench.faults.cut_to_controller = true;
  const int hellos = bench.sent(PHX_HELLO);
  bench.reset();
  bench.run(500);
  ASSERT_EQ(bench.session().phase(), Phase::kAsking);
  EXPECT_EQ(bench.sent(PHX_HELLO), hellos + 5) << "every 0.1 s";
  bench.faults.cut_to_controller = false;
  bench.run(300);
  EXPECT_EQ(bench.fault(), Fault::kNone);
  EXPECT_EQ(bench.controller.fault, PHX_FAULT_NONE);
  EXPECT_EQ(bench.controller.state, PHX_STATE_READY);
}

// What was asked for before the host forgot its session, sent already or not, was not meant for the next one.
TEST(LinkRepeat, AResetOfBeforeASessionClearsNoLatchInIt) {
  for (const bool sent : {true, false}) {
    SessionBench bench(51);
    bench.open();
    bench.run_commanding(100);
    bench.estop = true;
    bench.run(20);
    ASSERT_EQ(bench.controller.state, PHX_STATE_LATCHED);
    if (sent) {
      bench.reset();
      bench.run(3);
    }
    bench.session().forget();
    if (!sent) bench.reset();
    bench.estop = false;
    bench.open();
    bench.run(100);
    EXPECT_EQ(bench.controller.state, PHX_STATE_LATCHED) << sent;
    EXPECT_EQ(bench.controller.fault, PHX_FAULT_EMERGENCY_STOP) << sent;
  }
}

// The session opens again a few milliseconds after the reset. Before a sample of it says that CONFIGURE has
// come, a later HELLO of ours, of which the host knows nothing any more, opens another one: that counts.
TEST(LinkRepeat, OfTwoSessionsAfterAResetTheLaterOneCounts) {
  SessionBench bench(53);
  bench.open();
  bench.run_commanding(50);
  bench.restart(70);
  bench.run_commanding(60);
  ASSERT_EQ(bench.fault(), Fault::kControllerRestarted);
  bench.reset();
  bench.run(2);
  ASSERT_EQ(bench.session().phase(), Phase::kRunning);
  ASSERT_EQ(bench.controller.epoch, 71U);
  ASSERT_FALSE(bench.controller.configured);
  phx_message hello = forged(PHX_HELLO, 0);
  hello.header.sequence = 1000;
  hello.as.hello.host_id = kBenchHost;
  std::array<std::uint8_t, PHX_FRAME_MAX> frame{}, reply{};
  const std::size_t size = phx_encode(&hello, frame.data(), frame.size());
  std::size_t reply_size = 0;
  ASSERT_EQ(phx_controller_receive(&bench.controller, frame.data(), size, bench.time_us(), reply.data(),
                                   &reply_size),
            PHX_NEW_SESSION);
  bench.to_host(reply.data(), reply_size);
  bench.run(100);
  EXPECT_EQ(bench.fault(), Fault::kNone);
  EXPECT_EQ(bench.session().phase(), Phase::kRunning);
  EXPECT_EQ(bench.controller.epoch, 72U);
  EXPECT_TRUE(bench.controller.configured);
}

// ---- commands ----

// A command that was written before the session was asked for, and one that was sent in the session before:
// both are younger than 20 ms.
TEST(LinkRepeat, NothingThatWasCommandedBeforeASessionIsSentInIt) {
  SessionBench bench(52);
  bench.command(true);
  bench.open();
  bench.run(5);
  EXPECT_EQ(bench.sent(PHX_COMMAND), 0);
  bench.run_commanding(100);
  const int before = bench.sent(PHX_COMMAND);
  EXPECT_GT(before, 0);
  bench.session().forget();
  bench.open();
  bench.run(5);
  EXPECT_EQ(bench.sent(PHX_COMMAND), before);
}

// However many commands came within a millisecond, the last one is repeated 1.5 ms later and from then on
// each millisecond.
TEST(LinkRepeat, TheLastCommandOfALoopThatIsFasterThanTheRepetitionIsRepeatedAfterOneAndAHalfPeriods) {
  SessionBench bench(58);
  bench.open();
  for (int i = 0; i < 200; ++i) {
    bench.command(true);
    bench.session().send_due(bench.now());
  }
  const std::uint64_t before = bench.counters().sent;
  const double last = bench.now();
  bench.session().send_due(last + 1.49e-3);
  EXPECT_EQ(bench.counters().sent, before);
  bench.session().send_due(last + 1.51e-3);
  EXPECT_EQ(bench.counters().sent, before + 1);
  bench.session().send_due(last + 2.49e-3);
  EXPECT_EQ(bench.counters().sent, before + 1);
  bench.session().send_due(last + 2.52e-3);
  EXPECT_EQ(bench.counters().sent, before + 2);
}

TEST(LinkRepeat, TheLastCommandsOfAHostSayFaultWithANewerTick) {
  SessionBench bench(44);
  bench.open();
  bench.run_commanding(50);
  const std::uint64_t newest = bench.controller.step.command.tick;
  const std::uint64_t sent = bench.counters().sent;
  bench.controller_got.clear();
  bench.session().send_disabled();
  EXPECT_EQ(bench.counters().sent, sent + 1);
  bench.controller_tick();
  ASSERT_FALSE(bench.controller_got.empty());
  const phx_message& message = bench.controller_got.back();
  EXPECT_EQ(message.header.type, PHX_COMMAND);
  EXPECT_EQ(message.as.command.flags, PHX_COMMAND_FAULT);
  EXPECT_GT(message.as.command.tick, newest);
  EXPECT_EQ(message.as.command.sample_time_us, bench.time_us()) << "of the newest sample";
  EXPECT_EQ(bench.controller.step.command.tick, message.as.command.tick) << "so that it is not outdated";
  for (const float torque : message.as.command.torque) EXPECT_EQ(torque, 0.0F);
}

// A command that was late by 0.7 ms: the next one half a period after it, 0.5 ms, and not a whole one.
TEST(LinkRepeat, TheNextCommandIsDueWithinAPeriodAndSoonerAfterALateOne) {
  SessionBench bench(45);
  bench.open();
  EXPECT_NEAR(bench.session().next_due(bench.now()), bench.now() + 1e-3, 1e-12) << "nothing to repeat";
  bench.run_commanding(10);
  const double late = bench.session().next_due(bench.now()) + 0.7e-3;
  bench.session().send_due(late);
  EXPECT_NEAR(bench.session().next_due(late), late + 0.5e-3, 1e-9);
}

// A command is repeated for 20 ms. After that its time of repetition lies in the past, and a link thread that
// slept until then would not sleep at all.
TEST(LinkRepeat, ACommandThatIsNoLongerRepeatedIsNotWaitedFor) {
  SessionBench bench(45);
  bench.open();
  bench.run_commanding(10);
  bench.run(25);
  EXPECT_NEAR(bench.session().next_due(bench.now()), bench.now() + 1e-3, 1e-12);
}

// ---- frames of others ----

TEST(LinkRepeat, AWelcomeOfALaterEpochIsNotBelievedOnceTheSessionIsSettled) {
  SessionBench bench(46);
  bench.open();
  bench.run_commanding(50);
  phx_message welcome = forged(PHX_WELCOME, bench.controller.epoch + 1);
  welcome.as.welcome = bench.session().welcome();
  welcome.as.welcome.host_id = kBenchHost;
  const std::uint64_t refused = bench.counters().refused;
  forge(bench, welcome);
  bench.run_commanding(50);
  EXPECT_EQ(bench.counters().refused, refused + 1);
  EXPECT_EQ(bench.controller.refused, 0U) << "and nothing was sent in its epoch";
  EXPECT_EQ(bench.session().phase(), Phase::kRunning);
  EXPECT_EQ(bench.fault(), Fault::kNone);
}

// While samples come a refusal is the late answer to an earlier HELLO; in silence another host has the
// device.
TEST(LinkRepeat, ARefusalCountsOnlyInSilence) {
  SessionBench bench(47);
  bench.open();
  bench.run_commanding(50);
  phx_message refusal = forged(PHX_REFUSED, 0);
  refusal.as.refused = {.host_id = kBenchHost, .reason = PHX_REFUSED_BUSY, .version = PHX_VERSION};
  forge(bench, refusal);
  bench.run_commanding(5);
  EXPECT_EQ(bench.fault(), Fault::kNone);
  bench.controller_off = true;
  bench.run_commanding(30);
  ASSERT_EQ(bench.fault(), Fault::kNone);
  refusal.as.refused.host_id = kBenchHost + 1;
  forge(bench, refusal);
  bench.run_commanding(2);
  EXPECT_EQ(bench.fault(), Fault::kNone) << "to another host";
  refusal.as.refused.host_id = kBenchHost;
  forge(bench, refusal);
  bench.run_commanding(2);
  EXPECT_EQ(bench.fault(), Fault::kRefused);
  bench.controller_off = false;
  const std::uint64_t received = bench.counters().received;
  bench.run(5);
  EXPECT_EQ(bench.counters().received, received) << "what comes of a session that is over";
}

// What is no frame says nothing of versions, and what was refused once may be granted the next time.
TEST(LinkRepeat, ARefusalIsOneThatWasSaidSinceTheLastQuestion) {
  SessionBench bench(54);
  bench.controller_off = true;
  bench.session().ask(bench.now());
  const std::array<std::uint8_t, 40> noise{1, 2, 3};
  bench.to_host(noise.data(), noise.size());
  bench.run(1);
  EXPECT_EQ(bench.counters().corrupt, 1U);
  EXPECT_FALSE(bench.session().refusal().has_value());
  phx_message refusal = forged(PHX_REFUSED, 0);
  refusal.as.refused = {.host_id = kBenchHost, .reason = PHX_REFUSED_VERSION, .version = 9};
  forge(bench, refusal);
  bench.run(1);
  ASSERT_TRUE(bench.session().refusal().has_value());
  EXPECT_EQ(bench.session().refusal()->reason, PHX_REFUSED_VERSION);
  EXPECT_EQ(bench.session().refusal()->version, 9);
  bench.session().ask(bench.now());
  EXPECT_FALSE(bench.session().refusal().has_value());
}

// Another session's sample among ours is one that was late; in silence our session is over.
TEST(LinkRepeat, ASampleOfAnotherSessionCountsOnlyInSilence) {
  SessionBench bench(57);
  bench.open();
  bench.run(50);
  const phx_message sample = forged(PHX_SAMPLE, bench.controller.epoch + 1);
  forge(bench, sample);
  bench.run(1);
  EXPECT_EQ(bench.counters().refused, 1U);
  EXPECT_EQ(bench.fault(), Fault::kNone);
  bench.controller_off = true;
  bench.run(15);
  ASSERT_EQ(bench.fault(), Fault::kNone);
  forge(bench, sample);
  bench.run(1);
  EXPECT_EQ(bench.fault(), Fault::kControllerRestarted);
}

// A PONG whose clock has begun again says that the controller restarted, but only one that answers a PING of
// ours since the last sample.
TEST(LinkRepeat, APongOfNoPingOfOursSaysNothing) {
  SessionBench bench(48);
  bench.open();
  bench.run_commanding(500);
  bench.controller_off = true;
  bench.run(30);
  const auto pings = static_cast<std::uint64_t>(bench.sent(PHX_PING));
  ASSERT_GE(pings, 1U);
  phx_message pong = forged(PHX_PONG, 0);
  pong.as.ping.time_us = 1;
  for (const std::uint64_t stamp : {kBenchHost, kBenchHost + pings + 100, kBenchHost - 1}) {
    pong.as.ping.stamp = stamp;
    forge(bench, pong);
    bench.run(1);
    EXPECT_EQ(bench.fault(), Fault::kNone) << stamp;
  }
  pong.as.ping.stamp = kBenchHost + 1;
  forge(bench, pong);
  bench.run(1);
  EXPECT_EQ(bench.fault(), Fault::kControllerRestarted);
}

// The PING of an earlier silence is answered late: that says nothing of this one. And the 0.1 s in which
// PONGs may come without a sample begin with the first PONG of this one.
TEST(LinkRepeat, APongOfAnEarlierSilenceSaysNothingOfThisOne) {
  SessionBench bench(56);
  bench.open();
  bench.run(500);
  phx_message pong = forged(PHX_PONG, 0);
  const auto answered = [&](int ping, std::uint64_t time_us) {
    pong.as.ping = {.stamp = kBenchHost + static_cast<std::uint64_t>(ping), .time_us = time_us};
    forge(bench, pong);
    bench.run(1);
    return bench.fault();
  };
  bench.controller_off = true;
  bench.run(15);
  const int first = bench.sent(PHX_PING);
  ASSERT_GE(first, 1);
  EXPECT_EQ(answered(first, bench.time_us()), Fault::kNone);
  bench.controller_off = false;
  bench.run(200);
  bench.controller_off = true;
  bench.run(15);
  const int second = bench.sent(PHX_PING);
  ASSERT_EQ(second, first + 1);
  EXPECT_EQ(answered(first, 1), Fault::kNone);
  EXPECT_EQ(answered(second, bench.time_us()), Fault::kNone);
  EXPECT_EQ(answered(second, 1), Fault::kControllerRestarted);
}

// After 10 ms, or three periods of a slower controller, and then every 10 ms: 9 or 10 in the 98 ms after the
// first two, depending on how the sum of milliseconds is rounded.
TEST(LinkRepeat, SilenceIsAskedAboutAfterThreePeriodsAndEveryTenMilliseconds) {
  for (const auto& [rate_hz, silence_ms] : {std::pair{1000, 10}, std::pair{100, 30}}) {
    SessionBench bench(55);
    bench.device_.rate_hz = static_cast<std::uint16_t>(rate_hz);
    bench.restart(100);
    bench.open();
    bench.run(20);
    const int before = bench.sent(PHX_PING);
    bench.controller_off = true;
    bench.run(silence_ms - 1);
    EXPECT_EQ(bench.sent(PHX_PING), before) << rate_hz;
    bench.run(3);
    EXPECT_EQ(bench.sent(PHX_PING), before + 1) << rate_hz;
    bench.run(98);
    EXPECT_GE(bench.sent(PHX_PING), before + 10) << rate_hz;
    EXPECT_LE(bench.sent(PHX_PING), before + 11) << rate_hz;
  }
}

// Of 96 Hz they are exactly 1/32 s, which a double between 1 and 2 takes without rounding.
TEST(LinkRepeat, ThreePeriodsThemselvesAreNoSilenceYet) {
  SessionBench bench(60);
  bench.device_.rate_hz = 96;
  bench.restart(100);
  bench.open();
  bench.run(5);
  const double late = bench.session().heard() + 3.0 / 96.0;
  ASSERT_LT(late, 2.0);
  const int before = bench.sent(PHX_PING);
  bench.session().send_due(late);
  EXPECT_EQ(bench.sent(PHX_PING), before);
  bench.session().send_due(std::nextafter(late, 2.0));
  EXPECT_EQ(bench.sent(PHX_PING), before + 1);
}

// The controller has restarted, WELCOME comes, and no sample. Its clock is behind that of the last session's
// samples, which means nothing in this one; but after 0.1 s of PONGs alone it is asked for the session again.
TEST(LinkRepeat, ASessionThatBringsNoSampleIsAskedForAgain) {
  SessionBench bench(59);
  bench.open();
  bench.run(500);
  bench.restart(70);
  bench.run_commanding(60);
  ASSERT_EQ(bench.fault(), Fault::kControllerRestarted);
  bench.controller_off = true;
  bench.reset();
  bench.run(1);
  ASSERT_EQ(bench.session().phase(), Phase::kAsking);
  phx_message welcome = forged(PHX_WELCOME, 200);
  welcome.as.welcome = bench.session().welcome();
  forge(bench, welcome);
  bench.run(1);
  ASSERT_EQ(bench.session().phase(), Phase::kRunning);
  bench.run(15);
  phx_message pong = forged(PHX_PONG, 0);
  const auto after_pong = [&] {
    pong.as.ping = {.stamp = kBenchHost + static_cast<std::uint64_t>(bench.sent(PHX_PING)), .time_us = 1};
    forge(bench, pong);
    bench.run(1);
    return bench.session().phase();
  };
  EXPECT_EQ(after_pong(), Phase::kRunning);
  bench.run(110);
  EXPECT_EQ(after_pong(), Phase::kAsking);
  EXPECT_EQ(bench.fault(), Fault::kNone);
}

// ---- who is there after a reset ----

// Another rate, another channel, another range or another kind are another device, whose gains nobody has
// measured.
TEST(LinkRepeat, ADeviceThatHasChangedInAnythingIsAnotherOne) {
  for (int change = 0; change < 7; ++change) {
    SessionBench bench(49);
    bench.open();
    bench.run_commanding(50);
    if (change == 1) bench.device_.rate_hz = 500;
    if (change == 2) bench.device_.channel_count = 1;
    if (change == 3) bench.device_.channel[1].raw_max = 999999;
    if (change == 4) bench.device_.channel[1].raw_min = -999;
    if (change == 5) bench.device_.channel[1].index = 7;
    if (change == 6) bench.device_.channel[1].kind = PHX_CHANNEL_TORQUE;
    bench.restart(70);
    bench.run_commanding(60);
    ASSERT_EQ(bench.fault(), Fault::kControllerRestarted) << change;
    bench.reset();
    bench.run_commanding(60);
    EXPECT_EQ(bench.fault(), change == 0 ? Fault::kNone : Fault::kDeviceLost) << change;
    EXPECT_EQ(bench.controller.session, change == 0) << change;
  }
}

// What was lost in the session before stays counted in the next.
TEST(LinkRepeat, LossesAreCountedOverSessions) {
  SessionBench bench(50);
  bench.open();
  bench.faults.cut_to_host = true;
  bench.run(9);
  bench.faults.cut_to_host = false;
  bench.run(100);
  ASSERT_EQ(bench.counters().lost, 9U);
  bench.restart(70);
  bench.run_commanding(60);
  bench.reset();
  bench.run_commanding(100);
  ASSERT_EQ(bench.fault(), Fault::kNone);
  EXPECT_EQ(bench.counters().lost, 9U);
}

}  // namespace
}  // namespace phalanx
