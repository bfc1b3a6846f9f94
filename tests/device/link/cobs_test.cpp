// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numeric>

#include "device/link/frame_bytes.h"

namespace phalanx::link_test {
namespace {

Bytes counted(int first, int last) {
  Bytes bytes(static_cast<std::size_t>(last - first + 1));
  std::iota(bytes.begin(), bytes.end(), static_cast<std::uint8_t>(first));
  return bytes;
}

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Bytes stuffed(const Bytes& frame) {
  Bytes out(PHX_COBS_MAX);
  out.resize(phx_cobs_encode(frame.data(), frame.size(), out.data(), out.size()));
  return out;
}

/// All frames that a receiver finds in a stream.
std::vector<Bytes> received(phx_receiver& receiver, const Bytes& stream) {
  std::vector<Bytes> frames;
  for (const std::uint8_t byte : stream) {
    const std::size_t size = phx_receiver_take(&receiver, byte);
    if (size != 0) frames.emplace_back(receiver.frame, receiver.frame + size);
  }
  return frames;
}

class Cobs : public testing::Test {
 protected:
  Cobs() { phx_receiver_init(&receiver_); }
  std::vector<Bytes> take(const Bytes& stream) { return received(receiver_, stream); }
  phx_receiver receiver_{};
};

// The examples of the paper's encoding that are commonly published.
TEST_F(Cobs, EncodesTheKnownExamples) {
  const std::pair<Bytes, Bytes> examples[] = {
      {{0x00}, {0x01, 0x01, 0x00}},
      {{0x00, 0x00}, {0x01, 0x01, 0x01, 0x00}},
      {{0x00, 0x11, 0x00}, {0x01, 0x02, 0x11, 0x01, 0x00}},
      {{0x11, 0x22, 0x00, 0x33}, {0x03, 0x11, 0x22, 0x02, 0x33, 0x00}},
      {{0x11, 0x22, 0x33, 0x44}, {0x05, 0x11, 0x22, 0x33, 0x44, 0x00}},
      {{0x11, 0x00, 0x00, 0x00}, {0x02, 0x11, 0x01, 0x01, 0x01, 0x00}},
      {counted(1, 254), Bytes{0xFF} + counted(1, 254) + Bytes{0x00}},
      {Bytes{0} + counted(1, 254), Bytes{0x01, 0xFF} + counted(1, 254) + Bytes{0x00}},
      {counted(1, 255), Bytes{0xFF} + counted(1, 254) + Bytes{0x02, 0xFF, 0x00}},
      {counted(2, 255) + Bytes{0}, Bytes{0xFF} + counted(2, 255) + Bytes{0x01, 0x01, 0x00}},
      {counted(3, 255) + Bytes{0, 1}, Bytes{0xFE} + counted(3, 255) + Bytes{0x02, 0x01, 0x00}},
  };
  for (const auto& [frame, expected] : examples) {
    EXPECT_EQ(stuffed(frame), expected);
    EXPECT_EQ(take(expected), std::vector<Bytes>{frame});
  }
  EXPECT_EQ(receiver_.dropped, 0U);
}

TEST_F(Cobs, WritesNothingBeyondItsCapacityAndFitsExactlyIntoItsSize) {
  for (const Bytes& frame : {Bytes{}, Bytes{7}, Bytes{0}, counted(0, 10), counted(1, 254), counted(1, 255),
                             Bytes(600, 7), Bytes(600, 0)}) {
    const std::size_t size = stuffed(frame).size();
    for (std::size_t capacity = 0; capacity <= size; ++capacity) {
      Bytes out(capacity + 4, 0xEE);
      EXPECT_EQ(phx_cobs_encode(frame.data(), frame.size(), out.data(), capacity),
                capacity == size ? size : 0U);
      EXPECT_EQ(Bytes(out.end() - 4, out.end()), Bytes(4, 0xEE)) << size << " into " << capacity;
    }
  }
}

TEST_F(Cobs, OfTheLargestFrameFitsIntoTheStatedMost) {
  EXPECT_LE(stuffed(Bytes(PHX_FRAME_MAX, 1)).size(), PHX_COBS_MAX);
  EXPECT_GT(stuffed(Bytes(PHX_FRAME_MAX, 1)).size(), PHX_FRAME_MAX);
}

TEST_F(Cobs, TakesRandomFramesBackAsTheyWere) {
  std::mt19937_64 random(621);
  for (int round = 0; round < 2000; ++round) {
    Bytes frame(1 + random() % PHX_FRAME_MAX);
    const std::uint64_t kinds = 1 + random() % 255;  // few kinds: many zeros
    for (std::uint8_t& byte : frame) byte = static_cast<std::uint8_t>(random() % kinds);
    ASSERT_EQ(take(stuffed(frame)), std::vector<Bytes>{frame}) << "seed 621, round " << round;
  }
  EXPECT_EQ(receiver_.dropped, 0U);
}

TEST_F(Cobs, IgnoresZerosBetweenFrames) {
  const Bytes frame = counted(0, 20);
  EXPECT_EQ(take(Bytes{0, 0} + stuffed(frame) + Bytes{0, 0, 0} + stuffed(frame)),
            (std::vector<Bytes>{frame, frame}));
  EXPECT_EQ(receiver_.dropped, 0U);
}

TEST_F(Cobs, FindsEveryFrameAgainBehindNoiseThatEndsInAZero) {
  std::mt19937_64 random(622);
  for (int round = 0; round < 500; ++round) {
    const Bytes frame = encoded(random_message(kAllTypes[random() % std::size(kAllTypes)], random));
    Bytes noise(random() % 3000);
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
    const std::vector<Bytes> frames = take(noise + Bytes{0} + stuffed(frame));
    ASSERT_FALSE(frames.empty()) << "seed 622, round " << round;
    ASSERT_EQ(frames.back(), frame) << "seed 622, round " << round;
    for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
      phx_message message;
      ASSERT_NE(phx_decode(frames[i].data(), frames[i].size(), &message), PHX_OK);
    }
  }
}

TEST_F(Cobs, LosesOnlyTheFrameThatWasCutOff) {
  const Bytes frame = counted(1, 40);
  const Bytes whole = stuffed(frame);
  const Bytes cut(whole.begin(), whole.begin() + 12);
  EXPECT_EQ(take(cut + Bytes{0} + whole), std::vector<Bytes>{frame});
  EXPECT_EQ(receiver_.dropped, 1U);
}

TEST_F(Cobs, DropsAFrameLargerThanTheLargestOnceHoweverLongItIs) {
  Bytes endless(100000, 0x11);
  EXPECT_TRUE(take(endless + Bytes{0}).empty());
  EXPECT_EQ(receiver_.dropped, 1U);
  EXPECT_TRUE(take(Bytes(PHX_FRAME_MAX + 3, 1) + Bytes{0}).empty());  // zeros only, one too many
  EXPECT_EQ(receiver_.dropped, 2U);
  const Bytes frame(PHX_FRAME_MAX, 0x22);
  EXPECT_EQ(take(stuffed(frame)), std::vector<Bytes>{frame});
}

TEST_F(Cobs, AReceiverThatIsInitialisedHasForgottenWhatItWasIn) {
  receiver_.size = 9;
  receiver_.left = 7;
  receiver_.broken = true;
  receiver_.begun = true;
  receiver_.dropped = 3;
  phx_receiver_init(&receiver_);
  const Bytes frame = counted(0, 20);
  EXPECT_EQ(take(stuffed(frame)), std::vector<Bytes>{frame});
  EXPECT_EQ(receiver_.dropped, 0U);
}

TEST_F(Cobs, CountsAFrameOfNoBytesAsBroken) {
  EXPECT_TRUE(take({0x01, 0x00}).empty());
  EXPECT_EQ(receiver_.dropped, 1U);
}

}  // namespace
}  // namespace phalanx::link_test
