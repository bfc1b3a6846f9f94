// SPDX-License-Identifier: Apache-2.0
#include "device/faulty_wire.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <string>
#include <vector>

#include "support/count_allocations.h"

namespace phalanx {
namespace {

constexpr std::uint64_t kLineSeed = 3;
constexpr double kLinePeriod = 1e-3;

/// A packet that says its number.
std::array<std::uint8_t, 4> packet(int number) {
  return {static_cast<std::uint8_t>(number % 256), static_cast<std::uint8_t>(number / 256), 0xaa, 0x55};
}

struct Came {
  int number;
  int tick;
  std::array<std::uint8_t, 4> bytes;
};

/// One packet a tick into the line; what came out of it and when, until long after the last.
std::vector<Came> through(const PacketFaults& faults, int packets) {
  FaultyLine line(kLineSeed);
  std::vector<Came> out;
  std::array<std::uint8_t, PHX_FRAME_MAX> bytes{};
  Peer peer = 0;
  for (int tick = 0; tick < packets + 100; ++tick) {
    const double t = kLinePeriod * tick;
    if (tick < packets) line.put(t, faults, packet(tick), 77);
    while (const std::size_t size = line.take(t, bytes, peer)) {
      EXPECT_EQ(size, 4U);
      EXPECT_EQ(peer, 77U);
      out.push_back({bytes[0] + 256 * bytes[1], tick, {bytes[0], bytes[1], bytes[2], bytes[3]}});
    }
  }
  return out;
}

TEST(FaultyLine, WithoutAFaultEveryPacketComesAtOnceAndInOrder) {
  const std::vector<Came> came = through({}, 300);
  ASSERT_EQ(came.size(), 300U);
  for (int i = 0; i < 300; ++i) {
    EXPECT_EQ(came[static_cast<std::size_t>(i)].number, i);
    EXPECT_EQ(came[static_cast<std::size_t>(i)].tick, i);
  }
}

// Binomial: within 5 standard deviations.
TEST(FaultyLine, LosesAndDoublesAsManyAsItIsTold) {
  constexpr int kPackets = 10000;
  const double spread = 5.0 * std::sqrt(kPackets * 0.1 * 0.9);
  EXPECT_NEAR(static_cast<double>(through({.drop = 0.1}, kPackets).size()), 0.9 * kPackets, spread);
  EXPECT_NEAR(static_cast<double>(through({.duplicate = 0.1}, kPackets).size()), 1.1 * kPackets, spread);
  EXPECT_TRUE(through({.drop = 1.0}, 100).empty());
}

TEST(FaultyLine, DelaysEachByTheSame) {
  const std::vector<Came> came = through({.delay = 0.005 - 1e-9}, 100);
  ASSERT_EQ(came.size(), 100U);
  for (const Came& c : came) EXPECT_EQ(c.tick, c.number + 5);
}

TEST(FaultyLine, JitterComesWithinItsBoundAndReorders) {
  const std::vector<Came> came = through({.jitter = 0.005}, 1000);
  ASSERT_EQ(came.size(), 1000U);
  int largest = 0;
  bool reordered = false;
  for (std::size_t i = 0; i < came.size(); ++i) {
    EXPECT_GE(came[i].tick, came[i].number);
    EXPECT_LE(came[i].tick, came[i].number + 5);
    largest = std::max(largest, came[i].tick - came[i].number);
    reordered = reordered || (i > 0 && came[i].number < came[i - 1].number);
  }
  EXPECT_EQ(largest, 5);
  EXPECT_TRUE(reordered);
}

TEST(FaultyLine, AReorderedPacketComesRightBehindTheNext) {
  const std::vector<Came> came = through({.reorder = 0.2}, 1000);
  ASSERT_GE(came.size(), 999U) << "only the last can wait for ever";
  int behind = 0;
  for (std::size_t i = 1; i < came.size(); ++i) {
    if (came[i].number > came[i - 1].number) continue;
    ++behind;
    EXPECT_EQ(came[i].tick, came[i - 1].tick);
  }
  EXPECT_NEAR(behind, 0.2 * 0.8 * 1000.0, 75.0) << "held ones in a row come out together";
}

TEST(FaultyLine, ACorruptPacketDiffersByOneBit) {
  const std::vector<Came> came = through({.corrupt = 1.0}, 200);
  ASSERT_EQ(came.size(), 200U);
  for (std::size_t i = 0; i < came.size(); ++i) {
    const auto sent = packet(static_cast<int>(i));
    int bits = 0;
    for (std::size_t b = 0; b < sent.size(); ++b)
      bits += std::popcount(static_cast<unsigned>(sent[b] ^ came[i].bytes[b]));
    EXPECT_EQ(bits, 1) << i;
  }
}

TEST(FaultyLine, TheSameSeedDoesTheSame) {
  const auto numbers = [] {
    std::vector<int> out;
    for (const Came& c : through({.drop = 0.1, .duplicate = 0.1, .reorder = 0.1, .jitter = 0.005}, 1000))
      out.push_back(c.number);
    return out;
  };
  EXPECT_EQ(numbers(), numbers());
}

TEST(FaultyLine, KeepsNoMoreThanItHasRoomForAndAllocatesNothing) {
  FaultyLine line(kLineSeed);
  std::array<std::uint8_t, PHX_FRAME_MAX> bytes{};
  const std::vector<std::uint8_t> too_large(PHX_FRAME_MAX + 1, 1);
  Peer peer = 0;
  const std::size_t before = test::allocations_of_this_thread();
  for (std::size_t i = 0; i < 2 * FaultyLine::kRoom; ++i) line.put(0.0, {}, packet(static_cast<int>(i)), 1);
  std::size_t count = 0;
  while (line.take(0.0, bytes, peer) > 0) ++count;
  line.put(0.0, {}, too_large, 1);
  const std::size_t after = line.take(0.0, bytes, peer);
  EXPECT_EQ(test::allocations_of_this_thread(), before);
  EXPECT_EQ(count, FaultyLine::kRoom);
  EXPECT_EQ(after, 0U);
}

/// What was sent, and what is to be received.
class MemoryTransport final : public Transport {
 public:
  std::size_t receive(std::span<std::uint8_t> out, Peer& from) noexcept override {
    if (incoming.empty()) return 0;
    const auto frame = incoming.front();
    incoming.pop_front();
    std::copy(frame.begin(), frame.end(), out.begin());
    from = 5;
    return frame.size();
  }
  bool send(std::span<const std::uint8_t> frame, Peer) noexcept override {
    sent.emplace_back(frame.begin(), frame.end());
    return true;
  }
  bool wait(double) noexcept override { return false; }
  bool lost() const noexcept override { return false; }
  std::uint64_t dropped() const noexcept override { return 0; }
  std::string address() const override { return "memory"; }

  std::deque<std::array<std::uint8_t, 4>> incoming;
  std::vector<std::vector<std::uint8_t>> sent;
};

TEST(FaultyWire, InSilenceNothingIsSentOrHeardAndNothingComesLater) {
  MemoryTransport transport;
  FaultyWire wire(transport, kLineSeed);
  std::array<std::uint8_t, PHX_FRAME_MAX> out{};
  Peer from = 0;
  wire.send(0.0, {.delay = 0.01}, packet(1), 5);  // is on its way when the cable is pulled
  transport.incoming.push_back(packet(2));
  const PacketFaults silence{.silence = true};
  EXPECT_EQ(wire.receive(0.001, silence, out, from), 0U);
  wire.send(0.001, silence, packet(3), 5);
  wire.flush(0.001, silence, 5);
  wire.flush(1.0, {}, 5);
  EXPECT_EQ(wire.receive(1.0, {}, out, from), 0U);
  EXPECT_TRUE(transport.sent.empty());
  transport.incoming.push_back(packet(4));
  EXPECT_EQ(wire.receive(1.001, {}, out, from), 4U);
  EXPECT_EQ(from, 5U);
  wire.send(1.001, {}, packet(5), 5);
  wire.flush(1.001, {}, 5);
  EXPECT_EQ(transport.sent.size(), 1U);
}

TEST(FaultyWire, NoiseGoesBothWaysBesideTheRest) {
  MemoryTransport transport;
  FaultyWire wire(transport, kLineSeed);
  std::array<std::uint8_t, PHX_FRAME_MAX> out{};
  Peer from = 0;
  const PacketFaults noise{.noise_bytes = true};
  wire.send(0.0, noise, packet(1), 5);
  wire.flush(0.0, noise, 5);
  ASSERT_EQ(transport.sent.size(), 2U);
  EXPECT_GT(wire.receive(0.001, noise, out, from), 0U);
  wire.flush(0.001, noise, std::nullopt);
  EXPECT_EQ(transport.sent.size(), 2U) << "nobody is there";
}

}  // namespace
}  // namespace phalanx
