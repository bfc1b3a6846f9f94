// SPDX-License-Identifier: Apache-2.0
// Who may speak to the controller: HELLO, epochs, a second host, versions, PING, GOODBYE.
#include "device/link/controller_rig.h"

namespace phalanx::link_test {
namespace {

class LinkControllerSession : public LinkController {};

TEST_F(LinkControllerSession, OpensWithAWelcomeThatSaysWhoTheControllerIsAndTheNextEpoch) {
  EXPECT_EQ(rig.hello(), PHX_NEW_SESSION);
  ASSERT_TRUE(rig.reply);
  EXPECT_EQ(rig.reply->header.type, PHX_WELCOME);
  EXPECT_EQ(rig.reply->header.epoch, 101U);
  EXPECT_EQ(rig.reply->as.welcome.host_id, kHost);
  EXPECT_EQ(rig.reply->as.welcome.serial[0], 'B');
  EXPECT_EQ(rig.reply->as.welcome.rate_hz, 1000);
  EXPECT_EQ(rig.reply->as.welcome.channel_count, 3);
  EXPECT_EQ(rig.reply->as.welcome.channel[0].index, 4);
  EXPECT_EQ(rig.reply->as.welcome.channel[0].raw_max, 4000);
  EXPECT_EQ(rig.reply->as.welcome.channel[2].kind, PHX_CHANNEL_FORCE);
  EXPECT_EQ(rig.controller.state, PHX_STATE_READY);
}

TEST_F(LinkControllerSession, HasNoMoreChannelsThanAWelcomeHasRoomFor) {
  phx_device device = bench_device();
  const phx_channel same = device.channel[0];
  for (phx_channel& channel : device.channel) channel = same;
  device.channel_count = 33;
  rig = Rig(device);
  ASSERT_EQ(rig.controller.device.channel_count, 32);
  ASSERT_EQ(rig.hello(), PHX_NEW_SESSION);
  ASSERT_TRUE(rig.reply);
  EXPECT_EQ(rig.reply->as.welcome.channel_count, 32);
}

TEST_F(LinkControllerSession, AnswersWithTheSequenceOfTheQuestion) {
  phx_message hello = rig.frame(PHX_HELLO);
  hello.header.sequence = 4711;
  rig.send(hello);
  EXPECT_EQ(rig.reply->header.sequence, 4711U);
}

// The size of the reply is written for each frame; 99 is the size that an earlier frame left.
TEST_F(LinkControllerSession, SaysOfEveryFrameThatIsNotAnsweredThatThereIsNoAnswer) {
  rig.open();
  const Bytes good = encoded(rig.next_command(0.1F));
  Bytes damaged = good;
  damaged[20] ^= 1U;
  std::array<std::uint8_t, PHX_FRAME_MAX> answer{};
  for (const Bytes& frame : {damaged, good}) {
    std::size_t size = 99;
    EXPECT_EQ(
        phx_controller_receive(&rig.controller, frame.data(), frame.size(), rig.now, answer.data(), &size),
        frame == good ? PHX_USED : PHX_DROPPED);
    EXPECT_EQ(size, 0U);
  }
}

TEST_F(LinkControllerSession, SendsASampleEveryTickWhileItIsOpenAndNoneBefore) {
  rig.raw[1] = 123;
  rig.tick();
  EXPECT_FALSE(rig.has_sample);
  rig.hello();
  for (std::uint32_t i = 1; i <= 5; ++i) {
    rig.tick();
    ASSERT_TRUE(rig.has_sample);
    phx_message message{};
    ASSERT_EQ(phx_decode(rig.output.sample, rig.output.sample_size, &message), PHX_OK);
    EXPECT_EQ(message.header.epoch, rig.epoch);
    EXPECT_EQ(message.header.sequence, i);
    EXPECT_EQ(message.as.sample.time_us, rig.now);
    EXPECT_EQ(message.as.sample.raw[1], 123);
    EXPECT_EQ(message.as.sample.state, PHX_STATE_READY);
  }
}

TEST_F(LinkControllerSession, SaysOnceConfigureHasArrived) {
  rig.hello();
  rig.tick();
  EXPECT_EQ(rig.sample.flags, 0);
  rig.configure();
  rig.tick();
  EXPECT_EQ(rig.sample.flags, PHX_SAMPLE_CONFIGURED);
}

// A controller that was switched on in this moment: its clock stands at 0, as its first sample does.
TEST_F(LinkControllerSession, TakesACommandFromTheSampleOfTimeZero) {
  rig.now = 0;
  rig.hello();
  rig.configure();
  rig.tick(0);
  ASSERT_EQ(rig.sample.time_us, 0U);
  EXPECT_EQ(rig.command(0.1F), PHX_USED);
  EXPECT_EQ(rig.controller.outdated, 0U);
}

TEST_F(LinkControllerSession, IsRefusedToASecondHostWhileTheFirstIsHeard) {
  rig.open_and_act(0.2F);
  EXPECT_EQ(rig.hello(99), PHX_ANSWERED);
  ASSERT_TRUE(rig.reply);
  EXPECT_EQ(rig.reply->header.type, PHX_REFUSED);
  EXPECT_EQ(rig.reply->header.epoch, 0U);
  EXPECT_EQ(rig.reply->as.refused.reason, PHX_REFUSED_BUSY);
  EXPECT_EQ(rig.reply->as.refused.version, PHX_VERSION);
  EXPECT_EQ(rig.reply->as.refused.host_id, 99U);
  EXPECT_FLOAT_EQ(rig.drive(0.2F, 5), 0.2F);  // and the first goes on undisturbed
}

// Neither belongs to a session, whatever epoch the question names.
TEST_F(LinkControllerSession, ARefusalAndAPongHaveEpochZero) {
  rig.open();
  for (const std::uint8_t type : {PHX_HELLO, PHX_PING}) {
    phx_message question = rig.frame(type);
    question.header.epoch = 7;
    if (type == PHX_HELLO) question.as.hello.host_id = 99;
    EXPECT_EQ(rig.send(question), PHX_ANSWERED);
    ASSERT_TRUE(rig.reply);
    EXPECT_EQ(rig.reply->header.type, type == PHX_HELLO ? PHX_REFUSED : PHX_PONG);
    EXPECT_EQ(rig.reply->header.epoch, 0U);
  }
}

TEST_F(LinkControllerSession, GoesToAnotherHostOnceTheFirstWasSilentForASecond) {
  rig.open();
  rig.silent(998);  // one tick in open()
  EXPECT_EQ(rig.hello(99), PHX_ANSWERED);
  rig.tick();
  EXPECT_EQ(rig.hello(99), PHX_NEW_SESSION);
  EXPECT_EQ(rig.reply->header.epoch, rig.epoch + 1);
}

TEST_F(LinkControllerSession, ThatExpiresWithNothingEnabledEndsWithoutAFault) {
  rig.open();
  rig.silent(998);
  EXPECT_EQ(rig.controller.state, PHX_STATE_READY);
  EXPECT_TRUE(rig.has_sample);
  rig.tick();
  EXPECT_EQ(rig.controller.state, PHX_STATE_NO_SESSION);
  EXPECT_EQ(rig.controller.fault, PHX_FAULT_NONE);
  EXPECT_FALSE(rig.has_sample);
}

TEST_F(LinkControllerSession, IsKeptByAnyFrameOfItsHost) {
  rig.open();
  for (int i = 0; i < 5; ++i) {
    rig.silent(900);
    rig.configure();
  }
  EXPECT_EQ(rig.controller.state, PHX_STATE_READY);
}

TEST_F(LinkControllerSession, BeginsAnewForTheSameHostAndStopsWhatActed) {
  rig.open_and_act(0.2F);
  const std::uint32_t before = rig.epoch;
  EXPECT_EQ(rig.hello(), PHX_NEW_SESSION);
  EXPECT_EQ(rig.epoch, before + 1);
  EXPECT_EQ(rig.tick(), 0.0F);
  EXPECT_EQ(rig.sample.state, PHX_STATE_READY);
  EXPECT_EQ(rig.sample.flags, 0);
  EXPECT_EQ(rig.sample.acted_tick, 0U);
  EXPECT_EQ(rig.sample.acted_age_us, 0U);
}

TEST_F(LinkControllerSession, IsNotDisturbedByAHelloThatTheNetworkHasDoubledOrDelayed) {
  phx_message hello = rig.frame(PHX_HELLO);
  hello.header.epoch = 0;
  hello.as.hello.host_id = kHost;
  for (const std::uint32_t sequence : {5U, 6U}) {
    hello.header.sequence = sequence;
    EXPECT_EQ(rig.send(hello), PHX_NEW_SESSION);
    rig.epoch = rig.reply->header.epoch;
  }
  rig.configure();
  rig.tick();
  rig.drive(0.2F, 1001);
  for (const std::uint32_t sequence : {5U, 6U}) {
    hello.header.sequence = sequence;
    EXPECT_EQ(rig.send(hello), PHX_USED);
    ASSERT_TRUE(rig.reply);
    EXPECT_EQ(rig.reply->header.type, PHX_WELCOME);
    EXPECT_EQ(rig.reply->header.epoch, rig.epoch);
    EXPECT_FLOAT_EQ(rig.drive(0.2F, 1), 0.2F);
  }
}

TEST_F(LinkControllerSession, NeverHasEpochZero) {
  const phx_device device = bench_device();
  phx_controller_init(&rig.controller, &device, 0xFFFFFFFFU);
  rig.hello();
  EXPECT_EQ(rig.epoch, 1U);
}

TEST_F(LinkControllerSession, RefusesAndCountsEveryFrameOfAnotherEpoch) {
  rig.open_and_act(0.2F);
  const std::uint32_t right = rig.epoch;
  std::uint32_t count = 0;
  for (const std::uint32_t other : {0U, right - 1, right + 1}) {
    rig.epoch = other;
    EXPECT_EQ(rig.command(-0.2F), PHX_DROPPED);
    EXPECT_EQ(rig.configure(), PHX_DROPPED);
    EXPECT_EQ(rig.send(rig.frame(PHX_RESET)), PHX_DROPPED);
    EXPECT_EQ(rig.send(rig.frame(PHX_GOODBYE)), PHX_DROPPED);
    EXPECT_EQ(rig.controller.refused, count += 4);
  }
  rig.epoch = right;
  EXPECT_FLOAT_EQ(rig.drive(0.2F, 1), 0.2F);
  EXPECT_EQ(rig.sample.refused, count);
}

TEST_F(LinkControllerSession, RefusesTheEpochOfBeforeARestart) {
  rig.open_and_act(0.2F);
  const phx_device device = bench_device();
  phx_controller_init(&rig.controller, &device, 500);
  EXPECT_EQ(rig.command(0.2F), PHX_DROPPED);
  EXPECT_EQ(rig.tick(), 0.0F);
  EXPECT_EQ(rig.hello(), PHX_NEW_SESSION);
  EXPECT_EQ(rig.epoch, 501U);
}

TEST_F(LinkControllerSession, RefusesAHelloOfAnotherVersionEvenIfTheRestOfItIsUnknown) {
  rig.open_and_act(0.2F);
  Bytes hello{'P', 'X', 2, PHX_HELLO, 1, 2, 3, 4, 5, 0, 0, 0, 0};
  close_again(hello);
  EXPECT_EQ(rig.receive(hello), PHX_ANSWERED);
  ASSERT_TRUE(rig.reply);
  EXPECT_EQ(rig.reply->header.type, PHX_REFUSED);
  EXPECT_EQ(rig.reply->as.refused.reason, PHX_REFUSED_VERSION);
  EXPECT_EQ(rig.reply->as.refused.version, PHX_VERSION);
  EXPECT_EQ(rig.reply->as.refused.host_id, 0U) << "13 bytes have no room for one";
  EXPECT_FLOAT_EQ(rig.drive(0.2F, 1), 0.2F);
}

// A HELLO of 28 bytes, header, host_id and CRC, says whom to answer; one that is a byte shorter does not.
TEST_F(LinkControllerSession, NamesTheHostOfAHelloOfAnotherVersionIfThatIsWhole) {
  phx_message message = rig.frame(PHX_HELLO);
  message.as.hello.host_id = 0x0102030405060708U;
  Bytes hello = encoded(message);
  ASSERT_EQ(hello.size(), 28U);
  hello[2] = 2;
  close_again(hello);
  EXPECT_EQ(rig.receive(hello), PHX_ANSWERED);
  ASSERT_TRUE(rig.reply);
  EXPECT_EQ(rig.reply->as.refused.host_id, 0x0102030405060708U);
  hello.erase(hello.begin() + 16);
  close_again(hello);
  EXPECT_EQ(rig.receive(hello), PHX_ANSWERED);
  ASSERT_TRUE(rig.reply);
  EXPECT_EQ(rig.reply->as.refused.host_id, 0U);
}

TEST_F(LinkControllerSession, DropsAndCountsOtherFramesOfAnotherVersion) {
  rig.open();
  Bytes frame = encoded(rig.next_command(0.1F));
  frame[2] = 2;
  close_again(frame);
  EXPECT_EQ(rig.receive(frame), PHX_DROPPED);
  EXPECT_EQ(rig.controller.corrupt, 1U);
  EXPECT_FALSE(rig.reply);
}

TEST_F(LinkControllerSession, AnswersAPingOfAnybodyAndIsNotKeptByIt) {
  phx_message ping = rig.frame(PHX_PING);
  ping.as.ping.stamp = 0xFEED;
  EXPECT_EQ(rig.send(ping), PHX_ANSWERED);
  ASSERT_TRUE(rig.reply);
  EXPECT_EQ(rig.reply->header.type, PHX_PONG);
  EXPECT_EQ(rig.reply->as.ping.stamp, 0xFEEDU);
  EXPECT_EQ(rig.reply->as.ping.time_us, rig.now);
  rig.open();
  for (int i = 0; i < 999; ++i) {
    EXPECT_EQ(rig.send(ping), PHX_ANSWERED);
    rig.tick();
  }
  EXPECT_EQ(rig.controller.state, PHX_STATE_NO_SESSION);
}

TEST_F(LinkControllerSession, EndsWithGoodbyeAndZeroTorqueAtTheNextTick) {
  rig.open_and_act(0.2F);
  EXPECT_EQ(rig.send(rig.frame(PHX_GOODBYE)), PHX_USED);
  EXPECT_EQ(rig.controller.state, PHX_STATE_NO_SESSION) << "before the tick, too";
  EXPECT_FALSE(rig.controller.configured);
  EXPECT_EQ(rig.tick(), 0.0F);
  EXPECT_EQ(rig.controller.state, PHX_STATE_NO_SESSION);
  EXPECT_FALSE(rig.has_sample);
  EXPECT_EQ(rig.command(0.2F), PHX_DROPPED);
  EXPECT_EQ(rig.controller.refused, 1U);
  EXPECT_EQ(rig.hello(99), PHX_NEW_SESSION);  // another may have it at once
}

TEST_F(LinkControllerSession, DropsAndCountsItsOwnFramesComingBack) {
  rig.open();
  std::mt19937_64 random(631);
  for (const std::uint8_t type : {PHX_WELCOME, PHX_REFUSED, PHX_SAMPLE, PHX_PONG}) {
    phx_message echo = random_message(type, random);
    echo.header.epoch = rig.epoch;
    EXPECT_EQ(rig.send(echo), PHX_DROPPED);
    EXPECT_FALSE(rig.reply);
  }
  EXPECT_EQ(rig.controller.corrupt, 4U);
}

TEST_F(LinkControllerSession, DropsAndCountsCorruptFramesAndGoesOn) {
  rig.open_and_act(0.2F);
  std::mt19937_64 random(632);
  for (std::uint32_t i = 1; i <= 200; ++i) {
    Bytes frame = encoded(rig.next_command(-0.2F));
    frame[random() % frame.size()] ^= static_cast<std::uint8_t>(1 + random() % 255);
    const phx_received received = rig.receive(frame);
    EXPECT_EQ(received, PHX_DROPPED) << "seed 632, frame " << i;
    EXPECT_EQ(rig.controller.corrupt, i);
    EXPECT_FLOAT_EQ(rig.drive(0.2F, 1), 0.2F);
  }
}

}  // namespace
}  // namespace phalanx::link_test
