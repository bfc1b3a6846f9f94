// SPDX-License-Identifier: Apache-2.0
// Every frame byte by byte, from the tables of docs/link.md and, for some, from Python's struct and zlib.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iterator>
#include <utility>

#include "device/link/frame_bytes.h"

namespace phalanx::link_test {
namespace {

phx_message empty(std::uint8_t type, std::uint32_t epoch, std::uint32_t sequence) {
  phx_message message{};
  message.header.type = type;
  message.header.epoch = epoch;
  message.header.sequence = sequence;
  return message;
}

Bytes from_hex(const char* text) {
  Bytes bytes;
  for (std::string_view rest(text); rest.size() >= 2; rest.remove_prefix(rest.size() > 2 ? 3 : 2))
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(std::string(rest.substr(0, 2)), nullptr, 16)));
  return bytes;
}

TEST(LinkFrame, OfTheTestHasTheCheckValueOfItsCrc) {
  const std::string_view digits = "123456789";
  EXPECT_EQ(crc_of(Bytes(digits.begin(), digits.end())), 0xCBF43926U);
}

TEST(LinkFrame, OfHelloIsThese28Bytes) {
  phx_message message = empty(PHX_HELLO, 0, 1);
  message.as.hello.host_id = 0x1122334455667788U;
  EXPECT_EQ(encoded(message), from_hex("50 58 01 01 1C 00 00 00 00 00 00 00 01 00 00 00 "
                                       "88 77 66 55 44 33 22 11 4A 80 C6 A6"));
}

TEST(LinkFrame, OfRefusedIsThese30Bytes) {
  phx_message message = empty(PHX_REFUSED, 0, 1);
  message.as.refused = {0x1122334455667788U, PHX_REFUSED_BUSY, 1};
  EXPECT_EQ(encoded(message), from_hex("50 58 01 03 1E 00 00 00 00 00 00 00 01 00 00 00 "
                                       "88 77 66 55 44 33 22 11 01 01 28 8B 2D 0B"));
}

TEST(LinkFrame, OfResetIsThese20Bytes) {
  EXPECT_EQ(encoded(empty(PHX_RESET, 7, 3)),
            from_hex("50 58 01 08 14 00 00 00 07 00 00 00 03 00 00 00 EB E9 90 B5"));
}

TEST(LinkFrame, OfGoodbyeHasNoPayload) {
  EXPECT_EQ(encoded(empty(PHX_GOODBYE, 7, 3)), FrameBytes(9, 20, 7, 3).closed());
}

TEST(LinkFrame, OfPingIsThese36BytesAndPongTheSameButForItsType) {
  phx_message message = empty(PHX_PING, 0, 9);
  message.as.ping = {42, 0};
  EXPECT_EQ(encoded(message), from_hex("50 58 01 0A 24 00 00 00 00 00 00 00 09 00 00 00 "
                                       "2A 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 29 9C 84 98"));
  message.header.type = PHX_PONG;
  message.as.ping.time_us = 77;
  EXPECT_EQ(encoded(message), FrameBytes(11, 36, 0, 9).u64(42).u64(77).closed());
}

// 189 bytes; the CRC 0x7D00F682 is zlib's.
TEST(LinkFrame, OfASampleIsItsTableInOrder) {
  phx_message message = empty(PHX_SAMPLE, 7, 4);
  message.as.sample = {.time_us = 5000000,
                       .acted_tick = 999,
                       .acted_age_us = 2000,
                       .state = PHX_STATE_ACTIVE,
                       .flags = PHX_SAMPLE_CONFIGURED,
                       .fault = 0,
                       .fault_channel = 0,
                       .factor = 0.5F,
                       .corrupt = 1,
                       .refused = 2,
                       .outdated = 3,
                       .raw = {2048, -1}};
  FrameBytes frame(5, 189, 7, 4);
  frame.u64(5000000).u64(999).u32(2000).u8(3).u8(2).u16(0).u8(0).f32(0.5F).u32(1).u32(2).u32(3);
  frame.i32(2048).i32(-1).zeros(30U * 4U).u32(0x7D00F682U);
  Bytes expected = frame.closed();
  expected.resize(189);  // its own CRC, put in by hand above, is the last
  EXPECT_EQ(encoded(message), expected);
}

// 117 bytes; the CRC 0x95A14CDB is zlib's. 0.25 is 00 00 80 3E.
TEST(LinkFrame, OfACommandIsItsTableInOrder) {
  phx_message message = empty(PHX_COMMAND, 7, 2);
  message.as.command = {1000, 5000000, PHX_COMMAND_ENABLE, {}};
  message.as.command.torque[5] = 0.25F;
  FrameBytes frame(6, 117, 7, 2);
  frame.u64(1000).u64(5000000).u8(1).zeros(5U * 4U).u8(0).u8(0).u8(0x80).u8(0x3E).zeros(14U * 4U);
  Bytes expected = frame.u32(0x95A14CDBU).closed();
  expected.resize(117);
  EXPECT_EQ(encoded(message), expected);
}

TEST(LinkFrame, OfWelcomeIsItsTableInOrderWithZerosForTheChannelsThatTheDeviceHasNot) {
  phx_message message = empty(PHX_WELCOME, 7, 1);
  phx_welcome& welcome = message.as.welcome;
  welcome = {.host_id = 3,
             .serial = {'P', 'H', 'X'},
             .rate_hz = 1000,
             .channel_count = 2,
             .flags = 0,
             .channel = {}};
  welcome.channel[0] = {PHX_CHANNEL_ANGLE, 19, -5, 4095, 0.5F, -1.0F};
  welcome.channel[1] = {PHX_CHANNEL_FORCE, 4, 0, 70000, 2.0F, 0.0F};
  welcome.channel[2] = {9, 9, 9, 9, 9.0F, 9.0F};  // left over: not the device's
  FrameBytes frame(2, 623, 7, 1);
  frame.u64(3).text("PHX").zeros(13).u16(1000).u8(2);
  frame.u8(0).u8(19).i32(-5).i32(4095).f32(0.5F).f32(-1.0F);
  frame.u8(2).u8(4).i32(0).i32(70000).f32(2.0F).f32(0.0F).zeros(30U * 18U);
  EXPECT_EQ(encoded(message), frame.closed());
}

TEST(LinkFrame, OfWelcomeStatesASimulatedDeviceInTheHeadersFlags) {
  phx_message message = empty(PHX_WELCOME, 7, 1);
  message.as.welcome.rate_hz = 1000;
  const Bytes real = encoded(message);
  EXPECT_EQ(real.at(6), 0);
  message.as.welcome.flags = PHX_WELCOME_SIMULATED;
  Bytes simulated = encoded(message);
  EXPECT_EQ(simulated.size(), 623U);
  EXPECT_EQ(simulated.at(6), 1);
  EXPECT_EQ(simulated.at(7), 0);
  phx_message read{};
  ASSERT_EQ(phx_decode(simulated.data(), simulated.size(), &read), PHX_OK);
  EXPECT_EQ(read.as.welcome.flags, PHX_WELCOME_SIMULATED);
  ASSERT_EQ(phx_decode(real.data(), real.size(), &read), PHX_OK);
  EXPECT_EQ(read.as.welcome.flags, 0);
  simulated[6] = 0;
  close_again(simulated);
  EXPECT_EQ(simulated, real) << "nothing else states it";
}

TEST(LinkFrame, OfConfigureIsItsTableInOrder) {
  phx_message message = empty(PHX_CONFIGURE, 7, 1);
  FrameBytes frame(4, 284, 7, 1);
  for (std::size_t i = 0; i < PHX_CHANNELS; ++i) {
    message.as.configure.gain[i] = 1.0F + static_cast<float>(i);
    message.as.configure.offset[i] = -static_cast<float>(i);
    frame.f32(1.0F + static_cast<float>(i));
  }
  for (std::size_t i = 0; i < PHX_CHANNELS; ++i) frame.f32(-static_cast<float>(i));
  message.as.configure.torque_limit = 0.5F;
  message.as.configure.torque_rate = 10.0F;
  EXPECT_EQ(encoded(message), frame.f32(0.5F).f32(10.0F).closed());
}

TEST(LinkFrame, OfACommandWithWallsIsItsTableInOrder) {
  phx_message message = empty(PHX_COMMAND_WALLS, 7, 1);
  phx_command_walls& walls = message.as.walls;
  walls.command = {12, 34, PHX_COMMAND_ENABLE, {}};
  walls.valid_us = 6000;
  FrameBytes frame(7, 681, 7, 1);
  frame.u64(12).u64(34).u8(1).zeros(20U * 4U).u32(6000);
  for (std::size_t i = 0; i < PHX_JOINTS; ++i) {
    walls.q_ref[i] = 0.1F * static_cast<float>(i);
    frame.f32(walls.q_ref[i]);
  }
  for (std::size_t w = 0; w < PHX_WALLS; ++w) {
    const auto n = static_cast<float>(w);
    walls.wall[w] = {{n, n + 0.25F, n + 0.5F, n + 0.75F}, 0.002F, 500.0F, 5.0F, 1.0F};
    frame.f32(n).f32(n + 0.25F).f32(n + 0.5F).f32(n + 0.75F).f32(0.002F).f32(500.0F).f32(5.0F).f32(1.0F);
  }
  EXPECT_EQ(encoded(message), frame.closed());
}

TEST(LinkFrame, DecodesASampleToTheNumbersThatItHolds) {
  FrameBytes frame(5, 189, 70000, 80000);
  frame.u64(0x0102030405060708U).u64(5).u32(6).u8(5).u8(1).u16(2).u8(7).f32(0.25F).u32(8).u32(9).u32(10);
  for (int i = 0; i < 32; ++i) frame.i32(1000 * i - 16000);
  const Bytes bytes = frame.closed();
  phx_message message{};
  ASSERT_EQ(phx_decode(bytes.data(), bytes.size(), &message), PHX_OK);
  EXPECT_EQ(message.header.type, PHX_SAMPLE);
  EXPECT_EQ(message.header.version, PHX_VERSION);
  EXPECT_EQ(message.header.size, 189);
  EXPECT_EQ(message.header.epoch, 70000U);
  EXPECT_EQ(message.header.sequence, 80000U);
  const phx_sample& sample = message.as.sample;
  EXPECT_EQ(sample.time_us, 0x0102030405060708U);
  EXPECT_EQ(sample.acted_tick, 5U);
  EXPECT_EQ(sample.acted_age_us, 6U);
  EXPECT_EQ(sample.state, PHX_STATE_LATCHED);
  EXPECT_EQ(sample.flags, PHX_SAMPLE_ESTOP);
  EXPECT_EQ(sample.fault, PHX_FAULT_SENSOR_RANGE);
  EXPECT_EQ(sample.fault_channel, 7);
  EXPECT_EQ(sample.factor, 0.25F);
  EXPECT_EQ(sample.corrupt, 8U);
  EXPECT_EQ(sample.refused, 9U);
  EXPECT_EQ(sample.outdated, 10U);
  EXPECT_EQ(sample.raw[0], -16000);
  EXPECT_EQ(sample.raw[31], 15000);
}

// The tables of docs/link.md: firmware that others wrote knows the numbers and not their names.
TEST(LinkFrame, NumbersAreThoseOfTheDocumentation) {
  unsigned next = 1;
  for (const std::uint8_t type : kAllTypes) EXPECT_EQ(unsigned{type}, next++);
  const std::pair<unsigned, unsigned> numbers[] = {
      {PHX_REFUSED_BUSY, 1},       {PHX_REFUSED_VERSION, 2},    {PHX_CHANNEL_ANGLE, 0},
      {PHX_CHANNEL_TORQUE, 1},     {PHX_CHANNEL_FORCE, 2},      {PHX_CHANNEL_MOTOR, 3},
      {PHX_CHANNEL_CURL, 4},       {PHX_CHANNEL_SPLAY, 5},      {PHX_FAULT_NONE, 0},
      {PHX_FAULT_STEP_TOO_OLD, 1}, {PHX_FAULT_SENSOR_RANGE, 2}, {PHX_FAULT_EMERGENCY_STOP, 3},
      {PHX_FAULT_DRIVE, 4},        {PHX_STATE_NO_SESSION, 0},   {PHX_STATE_READY, 1},
      {PHX_STATE_STARTING, 2},     {PHX_STATE_ACTIVE, 3},       {PHX_STATE_FADING, 4},
      {PHX_STATE_LATCHED, 5},      {PHX_SAMPLE_ESTOP, 1},       {PHX_SAMPLE_CONFIGURED, 2},
      {PHX_COMMAND_ENABLE, 1},     {PHX_COMMAND_FAULT, 2}};
  for (std::size_t i = 0; i < std::size(numbers); ++i)
    EXPECT_EQ(numbers[i].first, numbers[i].second) << "row " << i;
}

TEST(LinkFrame, OfEveryTypeComesBackAsItWas) {
  std::mt19937_64 random(601);
  for (int round = 0; round < 300; ++round) {
    for (const std::uint8_t type : kAllTypes) {
      const Bytes frame = encoded(random_message(type, random));
      ASSERT_EQ(frame.size(), phx_frame_size(type)) << "seed 601, round " << round;
      phx_message message{};
      ASSERT_EQ(phx_decode(frame.data(), frame.size(), &message), PHX_OK) << "seed 601, round " << round;
      ASSERT_EQ(encoded(message), frame) << "seed 601, round " << round << ", type " << int{type};
    }
  }
}

TEST(LinkFrame, IsNotWrittenForAnUnknownTypeOrIntoTooLittleSpace) {
  std::mt19937_64 random(602);
  Bytes out(PHX_FRAME_MAX, 0xEE);
  for (const int type : {0, 12, 255}) {
    EXPECT_EQ(phx_frame_size(static_cast<std::uint8_t>(type)), 0U);
    const phx_message message = empty(static_cast<std::uint8_t>(type), 0, 0);
    EXPECT_EQ(phx_encode(&message, out.data(), out.size()), 0U);
  }
  for (const std::uint8_t type : kAllTypes) {
    const phx_message message = random_message(type, random);
    EXPECT_LE(phx_frame_size(type), PHX_FRAME_MAX);
    EXPECT_EQ(phx_encode(&message, out.data(), phx_frame_size(type) - 1), 0U);
  }
  EXPECT_THAT(out, testing::Each(0xEE));
}

}  // namespace
}  // namespace phalanx::link_test
