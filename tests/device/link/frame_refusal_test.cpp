// SPDX-License-Identifier: Apache-2.0
// What phx_decode() does not take. Every frame lies in memory of its exact size, for AddressSanitizer.
#include <gtest/gtest.h>

#include <limits>

#include "device/link/frame_bytes.h"

namespace phalanx::link_test {
namespace {

phx_decoded decoded(const Bytes& frame) {
  const Bytes exact(frame.begin(), frame.end());
  phx_message message;
  return phx_decode(exact.data(), exact.size(), &message);
}

TEST(LinkDecode, RefusesEverySingleBitThatIsFlipped) {
  std::mt19937_64 random(611);
  for (const std::uint8_t type : kAllTypes) {
    Bytes frame = encoded(random_message(type, random));
    for (std::size_t bit = 0; bit < 8 * frame.size(); ++bit) {
      const auto mask = static_cast<std::uint8_t>(1U << (bit % 8));
      frame[bit / 8] ^= mask;
      const phx_decoded result = decoded(frame);
      ASSERT_TRUE(result == PHX_NOT_A_FRAME || result == PHX_BAD_CRC)
          << "type " << int{type} << ", bit " << bit;
      frame[bit / 8] ^= mask;
    }
    ASSERT_EQ(decoded(frame), PHX_OK);
  }
}

TEST(LinkDecode, RefusesEveryOtherLength) {
  std::mt19937_64 random(612);
  for (const std::uint8_t type : kAllTypes) {
    const Bytes frame = encoded(random_message(type, random));
    for (std::size_t size = 0; size < 1100; ++size) {
      if (size == frame.size()) continue;
      Bytes other = frame;
      other.resize(size);
      if (size > PHX_CRC_SIZE) close_again(other);
      ASSERT_EQ(decoded(other), PHX_NOT_A_FRAME) << "type " << int{type} << ", size " << size;
    }
  }
}

TEST(LinkDecode, RefusesAFrameOfWhichOnlyOneOfTheFirstTwoBytesIsRight) {
  std::mt19937_64 random(617);
  const Bytes frame = encoded(random_message(PHX_COMMAND, random));
  for (const std::size_t at : {0U, 1U}) {
    Bytes other = frame;
    other[at] ^= 1U;
    close_again(other);
    EXPECT_EQ(decoded(other), PHX_NOT_A_FRAME) << "byte " << at;
  }
}

TEST(LinkDecode, RefusesAWelcomeWithAnUnknownFlag) {
  std::mt19937_64 random(618);
  phx_message message = random_message(PHX_WELCOME, random);
  message.as.welcome.flags = PHX_WELCOME_SIMULATED;
  ASSERT_EQ(decoded(encoded(message)), PHX_OK);
  const Bytes frame = encoded(message);
  for (const std::size_t at : {6U, 7U}) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      if (at == 6 && bit == 0) continue;  // PHX_WELCOME_SIMULATED
      Bytes other = frame;
      other[at] ^= static_cast<std::uint8_t>(1U << bit);
      close_again(other);
      EXPECT_EQ(decoded(other), PHX_NOT_A_FRAME) << "byte " << at << ", bit " << bit;
    }
  }
  message.as.welcome.flags = 0xFF;  // the encoder leaves out what it does not know
  EXPECT_EQ(encoded(message), frame);
}

TEST(LinkDecode, RefusesASizeFieldThatIsNotTheFramesAndReservedBytesThatAreNotZero) {
  std::mt19937_64 random(613);
  const Bytes frame = encoded(random_message(PHX_COMMAND, random));
  for (const std::size_t at : {4U, 5U, 6U, 7U}) {
    Bytes other = frame;
    other[at] ^= 1U;
    close_again(other);
    EXPECT_EQ(decoded(other), PHX_NOT_A_FRAME) << "byte " << at;
  }
}

TEST(LinkDecode, TakesNoRandomBytesForAFrame) {
  std::mt19937_64 random(614);
  for (int round = 0; round < 20000; ++round) {
    Bytes bytes(random() % 1100);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    if (bytes.size() > 4 && round % 2 == 0) {  // half of them begin like one
      bytes[0] = 'P';
      bytes[1] = 'X';
      bytes[2] = 1;
      bytes[3] = kAllTypes[random() % std::size(kAllTypes)];
      bytes.resize(phx_frame_size(bytes[3]));
    }
    ASSERT_NE(decoded(bytes), PHX_OK) << "seed 614, round " << round;
  }
}

TEST(LinkDecode, NamesAnotherVersionAndWhoAsksIfTheCrcIsRight) {
  phx_message hello{};
  hello.header.type = PHX_HELLO;
  hello.as.hello.host_id = 0xABCDEF0123456789U;
  Bytes frame = encoded(hello);
  frame[2] = 2;
  EXPECT_EQ(decoded(frame), PHX_BAD_CRC);
  frame.insert(frame.begin() + 24, 11, 0x55);  // a later version may be longer
  close_again(frame);
  phx_message message{};
  message.header.size = 7;  // of the last one, and so are the next two
  message.header.epoch = 5;
  message.header.sequence = 6;
  EXPECT_EQ(phx_decode(frame.data(), frame.size(), &message), PHX_OTHER_VERSION);
  EXPECT_EQ(message.header.size, 39);  // 28 + 11
  EXPECT_EQ(message.header.epoch, 0U);
  EXPECT_EQ(message.header.sequence, 0U);
  EXPECT_EQ(message.header.version, 2);
  EXPECT_EQ(message.header.type, PHX_HELLO);
  EXPECT_EQ(message.as.hello.host_id, 0xABCDEF0123456789U);
}

TEST(LinkDecode, OfAnotherVersionReadsNothingBeyondTheShortestFrame) {
  Bytes frame{'P', 'X', 9, PHX_HELLO, 0, 0, 0, 0};
  close_again(frame);
  phx_message message{};
  EXPECT_EQ(phx_decode(frame.data(), frame.size(), &message), PHX_OTHER_VERSION);
  EXPECT_EQ(message.as.hello.host_id, 0U);
}

TEST(LinkDecode, OfAnotherVersionReadsTheLargestFrameAndNoLargerOne) {
  for (const std::size_t more : {0U, 1U}) {
    Bytes frame(PHX_FRAME_MAX + more, 0);
    frame[0] = 'P';
    frame[1] = 'X';
    frame[2] = 9;
    frame[3] = PHX_HELLO;
    close_again(frame);
    EXPECT_EQ(decoded(frame), more == 0 ? PHX_OTHER_VERSION : PHX_NOT_A_FRAME);
  }
}

struct Floats {
  std::uint8_t type;
  std::size_t first;  // offset of the first float
  std::size_t count;
  std::size_t stride;
};

TEST(LinkDecode, RefusesEveryFloatThatIsNotFinite) {
  const Floats places[] = {{PHX_WELCOME, 16 + 27 + 10, 32, 18},
                           {PHX_WELCOME, 16 + 27 + 14, 32, 18},
                           {PHX_CONFIGURE, 16, 66, 4},
                           {PHX_SAMPLE, 41, 1, 4},
                           {PHX_COMMAND, 33, 20, 4},
                           {PHX_COMMAND_WALLS, 33, 20, 4},
                           {PHX_COMMAND_WALLS, 117, 140, 4}};
  std::mt19937_64 random(615);
  for (const Floats& place : places) {
    phx_message message = random_message(place.type, random);
    if (place.type == PHX_WELCOME) {
      message.as.welcome.channel_count = 32;
      for (phx_channel& channel : message.as.welcome.channel) channel = {0, 0, 0, 1, 1.0F, 0.0F};
    }
    for (std::size_t i = 0; i < place.count; ++i) {
      for (const std::uint32_t bits : {0x7FC00000U, 0x7F800001U, 0xFFFFFFFFU, 0x7F800000U, 0xFF800000U}) {
        Bytes frame = encoded(message);
        for (std::size_t k = 0; k < 4; ++k)
          frame[place.first + i * place.stride + k] = static_cast<std::uint8_t>((bits >> (8 * k)) & 0xFFU);
        close_again(frame);
        ASSERT_EQ(decoded(frame), PHX_BAD_NUMBER) << "type " << int{place.type} << ", float " << i;
      }
    }
  }
}

TEST(LinkDecode, IgnoresWhatStandsInAWelcomeBehindItsChannels) {
  phx_message message{};
  message.header.type = PHX_WELCOME;
  message.as.welcome.rate_hz = 1000;
  message.as.welcome.channel_count = 1;
  message.as.welcome.channel[0] = {PHX_CHANNEL_ANGLE, 0, 0, 1, 1.0F, 0.0F};
  Bytes frame = encoded(message);
  for (std::size_t i = 16 + 27 + 18; i < frame.size(); ++i) frame[i] = 0xFF;
  close_again(frame);
  phx_message read{};
  for (phx_channel& channel : read.as.welcome.channel) channel = {9, 9, 9, 9, 9.0F, 9.0F};  // of another use
  ASSERT_EQ(phx_decode(frame.data(), frame.size(), &read), PHX_OK);
  EXPECT_EQ(read.as.welcome.channel[1].index, 0);
  EXPECT_EQ(read.as.welcome.channel[1].gain, 0.0F);
}

template <typename Change>
void expect_bad_number(std::uint8_t type, const char* what, const Change& change) {
  std::mt19937_64 random(616);
  phx_message message = random_message(type, random);
  change(message.as);
  EXPECT_EQ(decoded(encoded(message)), PHX_BAD_NUMBER) << what;
}

TEST(LinkDecode, RefusesAWelcomeOfAnImpossibleDevice) {
  const auto welcome = [](const char* what, const auto& change) {
    expect_bad_number(PHX_WELCOME, what, [&](auto& as) {
      as.welcome.rate_hz = 1000;
      as.welcome.channel_count = 2;
      for (phx_channel& channel : as.welcome.channel) channel = {0, 0, 0, 1, 1.0F, 0.0F};
      change(as.welcome);
    });
  };
  welcome("rate 0", [](phx_welcome& w) { w.rate_hz = 0; });
  welcome("33 channels", [](phx_welcome& w) { w.channel_count = 33; });
  welcome("kind 6", [](phx_welcome& w) { w.channel[1].kind = 6; });
  welcome("kind 6 of the first", [](phx_welcome& w) { w.channel[0].kind = 6; });
  welcome("joint 20", [](phx_welcome& w) { w.channel[1].index = 20; });
  welcome("torque 20", [](phx_welcome& w) { w.channel[1] = {PHX_CHANNEL_TORQUE, 20, 0, 1, 1.0F, 0.0F}; });
  welcome("force 5", [](phx_welcome& w) { w.channel[1] = {PHX_CHANNEL_FORCE, 5, 0, 1, 1.0F, 0.0F}; });
  welcome("motor 32", [](phx_welcome& w) { w.channel[1] = {PHX_CHANNEL_MOTOR, 32, 0, 1, 1.0F, 0.0F}; });
  welcome("curl 5", [](phx_welcome& w) { w.channel[1] = {PHX_CHANNEL_CURL, 5, 0, 1, 1.0F, 0.0F}; });
  welcome("splay 5", [](phx_welcome& w) { w.channel[1] = {PHX_CHANNEL_SPLAY, 5, 0, 1, 1.0F, 0.0F}; });
  welcome("no range", [](phx_welcome& w) { w.channel[1].raw_min = 2; });
  welcome("gain 0", [](phx_welcome& w) { w.channel[1].gain = 0.0F; });
}

// A channel that can read one number only is a poor one, but not an impossible one: the host's map refuses
// it.
TEST(LinkDecode, TakesAWelcomeAtTheEdgesOfWhatIsPossible) {
  phx_message message{};
  message.header.type = PHX_WELCOME;
  message.as.welcome.rate_hz = 1;
  message.as.welcome.channel_count = 2;
  message.as.welcome.channel[0] = {PHX_CHANNEL_ANGLE, PHX_JOINTS - 1, 7, 7, -1e-30F, 0.0F};
  message.as.welcome.channel[1] = {PHX_CHANNEL_MOTOR, PHX_CHANNELS - 1, INT32_MIN, INT32_MAX, 1.0F, 0.0F};
  EXPECT_EQ(decoded(encoded(message)), PHX_OK);
}

TEST(LinkDecode, RefusesNegativeLimitsAndWallsThatPull) {
  expect_bad_number(PHX_CONFIGURE, "limit", [](auto& as) { as.configure.torque_limit = -0.1F; });
  expect_bad_number(PHX_CONFIGURE, "rate", [](auto& as) { as.configure.torque_rate = -0.1F; });
  expect_bad_number(PHX_COMMAND_WALLS, "stiffness", [](auto& as) { as.walls.wall[14].stiffness = -1.0F; });
  expect_bad_number(PHX_COMMAND_WALLS, "force_max", [](auto& as) { as.walls.wall[0].force_max = -1.0F; });
  expect_bad_number(PHX_COMMAND_WALLS, "host_force", [](auto& as) { as.walls.wall[7].host_force = -1.0F; });
}

TEST(LinkDecode, RefusesASampleOfAnUnknownStateChannelOrFactor) {
  expect_bad_number(PHX_SAMPLE, "state", [](auto& as) { as.sample.state = 6; });
  expect_bad_number(PHX_SAMPLE, "channel", [](auto& as) { as.sample.fault_channel = 32; });
  expect_bad_number(PHX_SAMPLE, "factor", [](auto& as) { as.sample.factor = 1.5F; });
  expect_bad_number(PHX_SAMPLE, "factor", [](auto& as) { as.sample.factor = -0.5F; });
}

}  // namespace
}  // namespace phalanx::link_test
