// SPDX-License-Identifier: Apache-2.0
// The host's Device on a wire in memory: the controller ticks when the link's thread looks, and its clock
// counts these ticks. So what is lost, doubled or damaged is counted to the frame on a busy machine too.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <thread>
#include <utility>

#include "device/link/session_bench.h"
#include "phalanx/device/clock.h"
#include "phalanx/device/link/link_device.h"

namespace phalanx {
namespace {

/// What happens to every tenth sample of the controller.
enum class Mishap { kNone, kTwice, kDropped, kDamaged, kForeign };

class MemoryWire final : public Transport {
 public:
  MemoryWire() {
    device_ = test::bench_device();
    phx_controller_init(&controller_, &device_, 100);
  }

  std::atomic<Mishap> mishap{Mishap::kNone};
  std::atomic<bool> restarted{false};  ///< the controller begins anew
  std::atomic<bool> held{false};       ///< the link's thread stands still in receive()
  std::atomic<bool> standing{false};   ///< and is there now
  std::atomic<bool> complaining{
      false};  ///< the controller has dropped 3, refused 5 and found 7 outdated frames
  std::atomic<std::uint64_t> no_frames{0};  ///< pieces of the wire that were none
  std::atomic<int> lost_goodbyes{0};        ///< so many do not arrive
  // What the host has sent last; to be read once its thread has ended.
  int farewells = 0;  ///< commands in a row that said FAULT, before GOODBYE
  int goodbyes = 0;
  int waits_after_goodbye = 0;
  bool newer = true;  ///< each of these commands had a newer tick

  [[nodiscard]] std::size_t receive(std::span<std::uint8_t> out, Peer&) noexcept override {
    while (held) {
      standing = true;
      std::this_thread::yield();
    }
    standing = false;
    if (waiting_.empty()) {
      if (ticked_) {
        ticked_ = false;  // one sample for each look
        return 0;
      }
      tick();
      ticked_ = true;
    }
    if (waiting_.empty()) return 0;
    const test::WireBytes frame = waiting_.front();
    waiting_.pop_front();
    std::copy(frame.begin(), frame.end(), out.begin());
    return frame.size();
  }
  bool send(std::span<const std::uint8_t> frame, Peer) noexcept override {
    phx_message message{};
    phx_decode(frame.data(), frame.size(), &message);
    if (message.header.type == PHX_GOODBYE && ++goodbyes <= lost_goodbyes) return true;
    if (message.header.type == PHX_COMMAND) {
      const phx_command& command = message.as.command;
      farewells = command.flags == PHX_COMMAND_FAULT && goodbyes == 0 ? farewells + 1 : 0;
      newer = newer && (farewells <= 1 || command.tick > last_tick_);
      last_tick_ = command.tick;
    }
    std::array<std::uint8_t, PHX_FRAME_MAX> reply{};
    std::size_t size = 0;
    phx_controller_receive(&controller_, frame.data(), frame.size(), time_us_, reply.data(), &size);
    if (size > 0) waiting_.emplace_back(reply.begin(), reply.begin() + static_cast<std::ptrdiff_t>(size));
    return true;
  }
  /// After a millisecond there is a sample.
  bool wait(double seconds) noexcept override {
    if (goodbyes > 0) ++waits_after_goodbye;
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(seconds, 1e-3)));
    return true;
  }
  [[nodiscard]] bool lost() const noexcept override { return false; }
  [[nodiscard]] std::uint64_t dropped() const noexcept override { return no_frames; }
  [[nodiscard]] std::string address() const override { return "memory"; }

 private:
  void tick() {
    if (restarted.exchange(false)) {
      phx_controller_init(&controller_, &device_, 1000);
      time_us_ = 0;
    }
    if (complaining) {
      controller_.corrupt = 3;
      controller_.refused = 5;
      controller_.outdated = 7;
    }
    time_us_ += 1000;
    const std::array<std::int32_t, PHX_CHANNELS> raw{};
    phx_output output{};
    phx_controller_tick(&controller_, time_us_, raw.data(), false, false, &output);
    if (output.sample_size == 0) return;
    test::WireBytes sample(output.sample, output.sample + output.sample_size);
    const Mishap now = ++samples_ % 10 == 0 ? mishap.load() : Mishap::kNone;
    if (now == Mishap::kDropped) return;
    if (now == Mishap::kDamaged) sample[20] ^= 1U;
    waiting_.push_back(sample);
    if (now == Mishap::kTwice) waiting_.push_back(sample);
    if (now != Mishap::kForeign) return;
    phx_message message{};
    phx_decode(sample.data(), sample.size(), &message);
    message.header.epoch += 500;
    phx_encode(&message, sample.data(), sample.size());
    waiting_.push_back(sample);
  }

  phx_device device_{};
  phx_controller controller_{};
  std::deque<test::WireBytes> waiting_;
  std::uint64_t time_us_ = 0;
  std::uint64_t samples_ = 0;
  std::uint64_t last_tick_ = 0;
  bool ticked_ = false;
};

/// A device whose session is open, and its wire.
struct OnMemory {
  OnMemory() {
    auto made = std::make_unique<MemoryWire>();
    wire = made.get();
    device = make_link_device(std::move(made), clock, {});
    device->open();
    EXPECT_TRUE(eventually([&] { return fetch() > 0; }));
  }
  std::size_t fetch() {
    std::array<DeviceSample, 64> out{};
    return device->receive(0.0, out);
  }
  /// Polls; false after 5 minutes.
  static bool eventually(const std::function<bool()>& holds) {
    for (int i = 0; i < 300000; ++i) {
      if (holds()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  /// Until `more` samples have been taken in, with this mishap; then what the link's thread has counted.
  LinkStatistics after(Mishap mishap, std::uint64_t more = 200) {
    const std::uint64_t goal = device->statistics().received + more;
    wire->mishap = mishap;
    EXPECT_TRUE(eventually([&] {
      static_cast<void>(fetch());
      return device->statistics().received >= goal;
    }));
    wire->mishap = Mishap::kNone;
    return device->statistics();
  }

  Clock clock;
  MemoryWire* wire = nullptr;  ///< the device's
  std::unique_ptr<LinkDevice> device;
};

TEST(LinkStatistics, SamplesThatComeTwiceAreOutdatedAndNothingIsLost) {
  OnMemory bench;
  const LinkStatistics counted = bench.after(Mishap::kTwice);
  EXPECT_GE(counted.outdated, 19U);
  EXPECT_EQ(counted.lost, 0U);
  EXPECT_EQ(counted.corrupt, 0U);
  EXPECT_EQ(counted.refused, 0U);
}

TEST(LinkStatistics, SamplesThatDoNotComeAreLostAndNothingIsOutdated) {
  OnMemory bench;
  const LinkStatistics counted = bench.after(Mishap::kDropped);
  EXPECT_GE(counted.lost, 10U) << "those of the last 64 may still come";
  EXPECT_EQ(counted.outdated, 0U);
  EXPECT_EQ(counted.corrupt, 0U);
}

TEST(LinkStatistics, DamagedSamplesAreCorruptAndLost) {
  OnMemory bench;
  const LinkStatistics counted = bench.after(Mishap::kDamaged);
  EXPECT_GE(counted.corrupt, 20U);
  EXPECT_GE(counted.lost, 10U);
  EXPECT_EQ(counted.outdated, 0U);
  EXPECT_EQ(counted.refused, 0U);
}

TEST(LinkStatistics, SamplesOfAnotherSessionAreRefused) {
  OnMemory bench;
  const LinkStatistics counted = bench.after(Mishap::kForeign);
  EXPECT_GE(counted.refused, 19U);
  EXPECT_EQ(counted.corrupt, 0U);
  EXPECT_EQ(counted.outdated, 0U);
}

TEST(LinkStatistics, WhatTheControllerHasCountedIsPassedOnByItsName) {
  OnMemory bench;
  bench.wire->complaining = true;
  const LinkStatistics counted = bench.after(Mishap::kNone, 20);
  EXPECT_EQ(counted.device_corrupt, 3U);
  EXPECT_EQ(counted.device_refused, 5U);
  EXPECT_EQ(counted.device_outdated, 7U);
  EXPECT_EQ(counted.sent, 0U);
}

// 512 samples have room; a loop that fetches none loses what comes after, and then the oldest of those for
// which its own array has no room.
TEST(LinkStatistics, SamplesThatTheLoopDoesNotFetchOverflow) {
  OnMemory bench;
  const LinkStatistics before = bench.device->statistics();
  ASSERT_TRUE(OnMemory::eventually(
      [&] { return bench.device->statistics().received >= before.received + SampleQueue::kCapacity + 100; }));
  const std::uint64_t overflowed = bench.device->statistics().overflowed;
  EXPECT_GE(overflowed, before.overflowed + 99);
  EXPECT_EQ(bench.fetch(), 64U);
  EXPECT_GE(bench.device->statistics().overflowed, overflowed + SampleQueue::kCapacity - 64);
}

// A hundred samples of the earlier session have not been fetched. The new session's controller counts from 1
// again, and its first sample is fetched first.
TEST(LinkStatistics, ADeviceThatIsOpenedAgainBeginsWithTheFirstSampleOfItsSession) {
  OnMemory bench;
  const LinkStatistics before = bench.device->statistics();
  ASSERT_TRUE(
      OnMemory::eventually([&] { return bench.device->statistics().received >= before.received + 100; }));
  bench.device->close();
  bench.device->open();
  std::array<DeviceSample, 64> out{};
  ASSERT_TRUE(OnMemory::eventually([&] { return bench.device->receive(0.0, out) > 0; }));
  EXPECT_EQ(out[0].sequence, 1U);
}

// The wire itself has dropped 3 pieces: that is counted once, however often it is asked.
TEST(LinkStatistics, WhatTheWireHasDroppedIsCountedOnce) {
  OnMemory bench;
  bench.wire->no_frames = 3;
  EXPECT_EQ(bench.after(Mishap::kNone, 50).corrupt, 3U);
  bench.wire->no_frames = 4;
  EXPECT_EQ(bench.after(Mishap::kNone, 50).corrupt, 4U);
}

// Closing sends 50 commands with the flag FAULT, one a millisecond with increasing ticks, and then GOODBYE,
// so that no single lost frame leaves a torque.
TEST(LinkStatistics, AClosedDeviceHasSaidFaultFiftyTimesAndThenGoodbye) {
  OnMemory bench;
  DeviceCommand command;
  command.tick = 7;
  command.enable = true;
  bench.device->send(command);
  const double began = bench.clock.now();
  bench.device->close();
  EXPECT_GT(bench.clock.now() - began, 0.049);
  EXPECT_LT(bench.clock.now() - began, 0.058);
  EXPECT_EQ(bench.wire->farewells, 50);
  EXPECT_TRUE(bench.wire->newer);
  EXPECT_EQ(bench.wire->goodbyes, 1) << "no sample has come since";
  EXPECT_GE(bench.wire->waits_after_goodbye, 1) << "for samples that go on";
}

// GOODBYE is sent again while samples still arrive, five times at most.
TEST(LinkStatistics, AGoodbyeThatIsLostIsSaidAgain) {
  for (const auto& [lost, said] : {std::pair{1, 2}, std::pair{3, 4}, std::pair{100, 5}}) {
    OnMemory bench;
    bench.wire->lost_goodbyes = lost;
    bench.device->close();
    EXPECT_EQ(bench.wire->goodbyes, said) << lost;
  }
}

// Between reset() and the moment in which the link's thread sees it, the fault of before is not there any
// more: a station would take it for a new one.
TEST(LinkStatistics, AResetTakesTheConnectionsFaultAwayBeforeTheLinksThreadSeesIt) {
  OnMemory bench;
  ASSERT_TRUE(OnMemory::eventually([&] {
    DeviceCommand command;
    command.tick = 1;
    bench.device->send(command);
    return bench.device->statistics().sent > 0;
  }));
  bench.wire->restarted = true;
  ASSERT_TRUE(
      OnMemory::eventually([&] { return bench.device->connection_fault() == Fault::kControllerRestarted; }));
  bench.wire->held = true;
  ASSERT_TRUE(OnMemory::eventually([&] { return bench.wire->standing.load(); }));
  bench.device->reset();
  EXPECT_EQ(bench.device->connection_fault(), Fault::kNone);
  bench.wire->held = false;
  const std::uint64_t received = bench.device->statistics().received;
  EXPECT_TRUE(OnMemory::eventually([&] { return bench.device->statistics().received > received + 5; }));
  EXPECT_EQ(bench.device->connection_fault(), Fault::kNone);
}

}  // namespace
}  // namespace phalanx
