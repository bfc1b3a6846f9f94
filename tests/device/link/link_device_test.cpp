// SPDX-License-Identifier: Apache-2.0
// The host's Device against the reference controller, each in threads of its own, over real sockets and
// pseudo-terminals, under a held clock.
#include "phalanx/device/link/link_device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>

#include "device/link/controller_thread.h"
#include "device/link/frame_bytes.h"
#include "support/count_allocations.h"

namespace phalanx {
namespace {

using test::ControllerThread;
using testing::HasSubstr;

constexpr double kPatience = 2.0;  // [s] of the held clock

enum class Wire { kUdp, kPseudoTerminal };

std::unique_ptr<Transport> controllers_end(Wire wire) {
  return wire == Wire::kUdp ? listen_udp("127.0.0.1:0") : open_pseudo_terminal();
}
std::unique_ptr<Transport> hosts_end(Wire wire, const ControllerThread& controller) {
  return wire == Wire::kUdp ? connect_udp(controller.after_scheme()) : open_serial(controller.after_scheme());
}

/// A loop at 1 kHz that commands after every sample, as a station does.
class Loop {
 public:
  Loop(Device& device, const Clock& clock) : device_(device), clock_(clock) {}

  /// @returns whether `done` came true
  bool until(const std::function<bool()>& done, bool commanding = true) {
    const double begin = clock_.now();
    for (double next = begin; next < begin + kPatience; next += 1e-3) {
      std::array<DeviceSample, 64> out{};
      const std::size_t count = device_.receive(clock_.now(), out);
      for (std::size_t i = 0; i < count; ++i) take(out[i]);
      if (done()) return true;
      if (commanding && count > 0) command(true);
      clock_.sleep_until(next);
    }
    return false;
  }
  /// Until the controller has acted on five commands.
  bool until_acting() {
    if (!until([&] { return newest.state == DeviceState::kReady; }, false)) return false;
    const std::uint64_t goal = tick_ + 5;
    return until([&] { return newest.acted_tick >= goal; });
  }
  void command(bool enable) {
    DeviceCommand command;
    command.tick = ++tick_;
    command.enable = enable;
    command.sample_time_us = newest.time_us;
    command.torque[4] = 0.1;
    device_.send(command);
  }

  DeviceSample newest;
  std::uint64_t samples = 0;
  std::uint64_t wrong_order = 0;

 private:
  void take(const DeviceSample& sample) {
    if (samples > 0 && (sample.raw[0] <= newest.raw[0] || sample.raw[0] != sample.raw[1])) ++wrong_order;
    newest = sample;
    ++samples;
  }

  Device& device_;
  const Clock& clock_;
  std::uint64_t tick_ = 0;
};

std::string message_of_open(Device& device) {
  try {
    device.open();
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "opened";
}

class LinkDeviceOn : public testing::TestWithParam<Wire> {
 protected:
  std::unique_ptr<LinkDevice> connect(const LinkSettings& settings = {}) {
    return make_link_device(hosts_end(GetParam(), controller), clock, settings);
  }

  Clock clock;
  ControllerThread controller{controllers_end(GetParam()), clock};
};

TEST_P(LinkDeviceOn, LearnsWhoIsThereAndDeliversSamplesInOrder) {
  const auto device = connect();
  device->open();
  EXPECT_EQ(device->info().serial, "BENCH-1");
  EXPECT_EQ(device->info().rate_hz, 1000.0);
  ASSERT_EQ(device->info().channels.size(), 2u);
  EXPECT_EQ(device->info().channels[1].index, 6);
  Loop loop(*device, clock);
  ASSERT_TRUE(loop.until([&] { return loop.samples >= 300; }, false));
  EXPECT_EQ(loop.wrong_order, 0u);
  EXPECT_EQ(loop.newest.state, DeviceState::kReady);
  EXPECT_GE(device->statistics().received, 300u);
  EXPECT_EQ(device->statistics().corrupt, 0u);
  EXPECT_EQ(device->statistics().sent, 0u);
}

TEST_P(LinkDeviceOn, TellsTheControllerCalibrationAndLimits) {
  const auto device = connect({.torque_limit = 0.25, .torque_rate = 2.0});
  std::vector<DeviceChannel> channels(2);
  channels[0].gain = 0.5;
  channels[1].offset = -0.25;
  device->set_calibration(channels);
  device->open();
  Loop loop(*device, clock);
  ASSERT_TRUE(loop.until([&] { return loop.newest.state == DeviceState::kReady; }, false));
  const phx_configure told = controller.controller().configure;
  EXPECT_EQ(told.gain[0], 0.5f);
  EXPECT_EQ(told.offset[1], -0.25f);
  EXPECT_EQ(told.torque_limit, 0.25f);
  EXPECT_EQ(told.torque_rate, 2.0f);
}

TEST_P(LinkDeviceOn, CommandsActAndCloseLetsGo) {
  const auto device = connect();
  device->open();
  Loop loop(*device, clock);
  ASSERT_TRUE(loop.until_acting());
  EXPECT_GT(device->statistics().sent, 0u);
  device->close();
  device->close();
  // GOODBYE may still be on its way to the controller's thread.
  for (int i = 0; i < 100 && controller.controller().session; ++i) clock.sleep_until(clock.now() + 1e-3);
  const phx_controller after = controller.controller();
  EXPECT_FALSE(after.session);
  EXPECT_FALSE(after.acting);
  device->open();
  EXPECT_TRUE(loop.until([&] { return loop.newest.state == DeviceState::kReady; }, false));
}

TEST_P(LinkDeviceOn, AfterARestartNothingIsSentUntilResetOpensANewSession) {
  const auto device = connect();
  device->open();
  Loop loop(*device, clock);
  ASSERT_TRUE(loop.until_acting());
  const std::uint32_t first_epoch = controller.controller().epoch;
  controller.restart();
  ASSERT_TRUE(loop.until([&] { return device->connection_fault() == Fault::kControllerRestarted; }));
  const std::uint64_t sent = device->statistics().sent;
  for (int i = 0; i < 50; ++i) {
    loop.command(true);
    clock.sleep_until(clock.now() + 1e-3);
  }
  EXPECT_EQ(device->statistics().sent, sent);
  EXPECT_FALSE(controller.controller().session);
  const std::uint64_t before = loop.samples;
  device->reset();
  ASSERT_TRUE(loop.until([&] { return device->connection_fault() == Fault::kNone; }, false));
  ASSERT_TRUE(loop.until(
      [&] { return loop.samples >= before + 20 && loop.newest.state == DeviceState::kReady; }, false));
  EXPECT_GE(controller.controller().epoch, first_epoch + 1000);
  ASSERT_TRUE(loop.until_acting());
}

TEST_P(LinkDeviceOn, LatchesAndResets) {
  const auto device = connect();
  device->open();
  Loop loop(*device, clock);
  ASSERT_TRUE(loop.until_acting());
  ASSERT_TRUE(loop.until([&] { return loop.newest.state == DeviceState::kLatched; }, false));
  EXPECT_EQ(loop.newest.fault, Fault::kStepTooOld);
  device->reset();
  EXPECT_TRUE(loop.until([&] { return loop.newest.state == DeviceState::kReady; }, false));
  EXPECT_EQ(device->connection_fault(), Fault::kNone);
}

TEST_P(LinkDeviceOn, AsksForItsSchedulingInItsOwnThread) {
  std::atomic<bool> elsewhere{false};
  const std::thread::id here = std::this_thread::get_id();
  const auto device = connect({.on_thread_start = [&] { elsewhere = std::this_thread::get_id() != here; }});
  device->open();
  device->close();
  EXPECT_TRUE(elsewhere);
}

TEST_P(LinkDeviceOn, TheLoopsSideAllocatesNothing) {
  const auto device = connect();
  device->open();
  Loop loop(*device, clock);
  ASSERT_TRUE(loop.until_acting());
  std::array<DeviceSample, 64> out{};
  std::size_t received = 0;
  const std::size_t before = test::allocations();
  for (int i = 0; i < 100; ++i) {
    received += device->receive(clock.now(), out);
    loop.command(true);
    if (i == 50) device->reset();
    (void)device->connection_fault();
    (void)device->statistics();
    clock.sleep_until(clock.now() + 1e-3);
  }
  EXPECT_EQ(test::allocations(), before);  // the link's and the controller's threads included
  EXPECT_GT(received, 0u);
}

INSTANTIATE_TEST_SUITE_P(Wires, LinkDeviceOn, testing::Values(Wire::kUdp, Wire::kPseudoTerminal),
                         [](const auto& wire) {
                           return wire.param == Wire::kUdp ? std::string("Udp")
                                                           : std::string("PseudoTerminal");
                         });

// ---- opening ----

TEST(LinkDevice, SaysThatNobodyAnswers) {
  const Clock clock;
  std::string address;
  {
    const auto reserved = listen_udp("127.0.0.1:0");
    address = reserved->address().substr(4);
  }
  const auto device = make_link_device(connect_udp(address), clock, {.hello_timeout = 0.3});
  EXPECT_THAT(message_of_open(*device), HasSubstr("no controller answers within 0.3 s"));
}

/// A transport without a controller at its other end.
class DeafWire final : public Transport {
 public:
  explicit DeafWire(int& waits) : waits_(waits) {}
  [[nodiscard]] std::size_t receive(std::span<std::uint8_t>, Peer&) noexcept override { return 0; }
  bool send(std::span<const std::uint8_t>, Peer) noexcept override { return true; }
  bool wait(double seconds) noexcept override {
    ++waits_;
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    return false;
  }
  [[nodiscard]] bool lost() const noexcept override { return false; }
  [[nodiscard]] std::uint64_t dropped() const noexcept override { return 0; }
  [[nodiscard]] std::string address() const override { return "deaf"; }

 private:
  int& waits_;
};

// It asks the transport every 5 ms for 0.3 s, and sleeps in between.
TEST(LinkDevice, LooksForAnAnswerEveryFiveMilliseconds) {
  const Clock clock;
  int waits = 0;
  const auto device = make_link_device(std::make_unique<DeafWire>(waits), clock, {.hello_timeout = 0.3});
  EXPECT_THAT(message_of_open(*device), HasSubstr("deaf: no controller answers within 0.3 s"));
  EXPECT_NEAR(waits, 60, 2);
}

TEST(LinkDevice, HasADefaultForEachLimit) {
  const LinkSettings settings;
  EXPECT_EQ(settings.torque_limit, 0.5);
  EXPECT_EQ(settings.torque_rate, 10.0);
  EXPECT_EQ(settings.hello_timeout, 3.0);
}

TEST(LinkDevice, WaitsForAControllerThatComesUpLater) {
  const Clock clock;
  std::string address;
  {
    const auto reserved = listen_udp("127.0.0.1:0");
    address = reserved->address().substr(4);
  }
  const auto device = make_link_device(connect_udp(address), clock, {.hello_timeout = kPatience});
  std::unique_ptr<ControllerThread> controller;
  std::thread later([&] {
    clock.sleep_until(clock.now() + 0.15);
    controller = std::make_unique<ControllerThread>(listen_udp(address), clock);
  });
  EXPECT_EQ(message_of_open(*device), "opened");
  later.join();
}

TEST(LinkDevice, ASecondHostIsRefusedAndTheFirstGoesOn) {
  const Clock clock;
  ControllerThread controller(listen_udp("127.0.0.1:0"), clock);
  const auto first = make_link_device(connect_udp(controller.after_scheme()), clock);
  first->open();
  Loop loop(*first, clock);
  ASSERT_TRUE(loop.until_acting());
  const std::uint32_t epoch = controller.controller().epoch;
  const auto second =
      make_link_device(connect_udp(controller.after_scheme()), clock, {.hello_timeout = kPatience});
  const double began = clock.now();
  EXPECT_THAT(message_of_open(*second), HasSubstr("belongs to another host"));
  EXPECT_GT(clock.now() - began, 1e-6 * PHX_SESSION_US) << "a host that was killed would lose it by then";
  EXPECT_LT(clock.now() - began, 1.3) << "1.25 s, and no longer as for one that is silent";
  EXPECT_EQ(controller.controller().epoch, epoch);
  EXPECT_EQ(first->connection_fault(), Fault::kNone);
  first->close();
  EXPECT_EQ(message_of_open(*second), "opened");
}

TEST(LinkDevice, NamesTheVersionOfAControllerThatSpeaksAnother) {
  const Clock clock;
  const auto wire = listen_udp("127.0.0.1:0");
  const std::string address = wire->address().substr(4);
  std::atomic<bool> stop{false};
  std::thread other([&] {
    std::array<std::uint8_t, PHX_FRAME_MAX> frame{};
    Peer from = 0;
    while (!stop) {
      wire->wait(0.01);
      if (wire->receive(frame, from) == 0) continue;
      const link_test::Bytes bytes = link_test::FrameBytes(PHX_REFUSED, 30, 0, 1).zeros(10).closed();
      link_test::Bytes refused(bytes.begin(), bytes.end() - PHX_CRC_SIZE);
      refused[2] = 9;  // the version
      const std::uint32_t crc = link_test::crc_of(refused);
      for (int i = 0; i < 4; ++i) refused.push_back(static_cast<std::uint8_t>(crc >> (8 * i)));
      wire->send(refused, from);
    }
  });
  const auto device = make_link_device(connect_udp(address), clock, {.hello_timeout = kPatience});
  EXPECT_THAT(message_of_open(*device), HasSubstr("version 9 of the link, this program version 1"));
  stop = true;
  other.join();
}

TEST(LinkDevice, RefusesACalibrationOfAnotherNumberOfChannelsAndLetsGo) {
  const Clock clock;
  ControllerThread controller(listen_udp("127.0.0.1:0"), clock);
  const auto device = make_link_device(connect_udp(controller.after_scheme()), clock);
  device->set_calibration(std::vector<DeviceChannel>(3));
  EXPECT_THAT(message_of_open(*device), HasSubstr("the calibration has 3 channels, device BENCH-1 has 2"));
  device->set_calibration(std::vector<DeviceChannel>(2));
  EXPECT_EQ(message_of_open(*device), "opened");
}

TEST(LinkDevice, AfterAnOpenThatFailedAnotherDeviceMayStandAtTheAddress) {
  const Clock clock;
  auto controller = std::make_unique<ControllerThread>(listen_udp("127.0.0.1:0"), clock);
  const std::string address = controller->after_scheme();
  const auto device = make_link_device(connect_udp(address), clock);
  device->set_calibration(std::vector<DeviceChannel>(3));
  EXPECT_THAT(message_of_open(*device), HasSubstr("device BENCH-1 has 2"));
  controller.reset();
  phx_device other = test::bench_device();
  write_serial("BENCH-2", other.serial);
  controller = std::make_unique<ControllerThread>(listen_udp(address), clock, other);
  device->set_calibration(std::vector<DeviceChannel>(2));
  EXPECT_EQ(message_of_open(*device), "opened");
  EXPECT_EQ(device->info().serial, "BENCH-2");
}

TEST(LinkDevice, IsSimulatedIfItsControllerStatesSo) {
  const Clock clock;
  auto controller = std::make_unique<ControllerThread>(listen_udp("127.0.0.1:0"), clock);
  const std::string address = controller->after_scheme();
  const auto device = make_link_device(connect_udp(address), clock);
  device->open();
  EXPECT_FALSE(device->info().simulated) << "firmware does not state it";
  device->close();
  controller.reset();
  phx_device simulated = test::bench_device();
  simulated.simulated = true;
  controller = std::make_unique<ControllerThread>(listen_udp(address), clock, simulated);
  device->open();
  EXPECT_TRUE(device->info().simulated);
  EXPECT_TRUE(device->info().own_clock) << "its silence counts in seconds, as that of every device on a wire";
  device->close();
}

// Results of a simulated device never join those of a person: a session that a person began ends here.
TEST(LinkDevice, ASimulatedControllerThatTakesTheDevicesPlaceIsAnotherDevice) {
  const Clock clock;
  auto controller = std::make_unique<ControllerThread>(listen_udp("127.0.0.1:0"), clock);
  const std::string address = controller->after_scheme();
  const auto device = make_link_device(connect_udp(address), clock);
  device->open();
  Loop loop(*device, clock);
  ASSERT_TRUE(loop.until([&] { return loop.samples > 10; }));
  controller.reset();
  phx_device simulated = test::bench_device();
  simulated.simulated = true;
  controller = std::make_unique<ControllerThread>(listen_udp(address), clock, simulated);
  EXPECT_TRUE(loop.until([&] {
    const Fault fault = device->connection_fault();
    if (fault != Fault::kNone && fault != Fault::kDeviceLost) device->reset();
    return device->connection_fault() == Fault::kDeviceLost;
  }));
  device->close();
}

TEST(LinkDevice, AnUnpluggedPortIsADeviceLost) {
  const Clock clock;
  ControllerThread controller(open_pseudo_terminal(), clock);
  const auto device = make_link_device(open_serial(controller.after_scheme()), clock);
  device->open();
  Loop loop(*device, clock);
  ASSERT_TRUE(loop.until([&] { return loop.samples > 10; }));
  controller.stop();
  EXPECT_TRUE(loop.until([&] { return device->connection_fault() == Fault::kDeviceLost; }));
  device->close();
  EXPECT_THAT(message_of_open(*device), HasSubstr("is the device plugged in?"));
  EXPECT_EQ(device->connection_fault(), Fault::kNone) << "a device that is not open has no connection fault";
}

}  // namespace
}  // namespace phalanx
