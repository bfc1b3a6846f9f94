// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/simulated_device.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "simulation/squeezing_device.h"
#include "support/count_allocations.h"

namespace phalanx::test {
namespace {

/// A host that renders wall_torque() from the newest sample of each call.
class Loop {
 public:
  explicit Loop(double host_rate_hz = 200.0) : Loop(settings_at(host_rate_hz)) {}
  explicit Loop(const SimulatedDeviceSettings& settings)
      : device_(make_simulated_device(settings)), period_(1.0 / settings.host_rate_hz) {
    device_->open();
  }
  ~Loop() { device_->close(); }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  std::size_t receive() {
    now_ += period_;
    const std::size_t count = device_->receive(now_, samples_);
    if (count > 0) newest_ = samples_[count - 1];
    return count;
  }
  void send(bool enable = true) {
    const std::vector<DeviceChannel>& channels = device_->info().channels;
    DeviceCommand command;
    command.tick = ++tick_;
    command.sample_time_us = newest_.time_us;
    command.enable = enable;
    command.torque = wall_torque(channels[0].gain * newest_.raw[0], channels[1].gain * newest_.raw[1]);
    torque_ = command.torque;
    device_->send(command);
  }
  void run(int steps, bool enable = true) {
    for (int i = 0; i < steps; ++i) {
      receive();
      send(enable);
    }
  }

  [[nodiscard]] Device& device() { return *device_; }
  [[nodiscard]] const DeviceSample& newest() const { return newest_; }
  [[nodiscard]] const JointArray& torque() const { return torque_; }

 private:
  static SimulatedDeviceSettings settings_at(double host_rate_hz) {
    SimulatedDeviceSettings settings = squeezing_settings();
    settings.host_rate_hz = host_rate_hz;
    return settings;
  }

  std::unique_ptr<Device> device_;
  double period_;
  double now_ = 0.0;
  std::uint64_t tick_ = 0;
  std::array<DeviceSample, 64> samples_{};
  DeviceSample newest_{};
  JointArray torque_{};
};

TEST(SimulatedDevice, SaysWhoItIs) {
  Loop loop;
  const DeviceInfo& info = loop.device().info();
  EXPECT_TRUE(info.simulated);
  EXPECT_TRUE(info.renders_torque);
  EXPECT_EQ(info.name, "two joints");
  EXPECT_EQ(info.rate_hz, 1000.0);
  EXPECT_EQ(info.channels.size(), 6U);
}

TEST(SimulatedDevice, EachCallGivesTheSamplesOfOnePeriodOfTheHost) {
  Loop loop(200.0);
  for (int i = 1; i <= 10; ++i) {
    EXPECT_EQ(loop.receive(), 5U);
    EXPECT_EQ(loop.newest().sequence, static_cast<std::uint32_t>(5 * i));
    EXPECT_EQ(loop.newest().time_us, static_cast<std::uint64_t>(5000 * i));
    EXPECT_DOUBLE_EQ(loop.newest().received, 0.005 * i);
  }
}

TEST(SimulatedDevice, TimeKeepsStepWithAnyRateOfTheHost) {
  for (const double rate : {300.0, 700.0, 1000.0, 2000.0}) {
    Loop loop(rate);
    std::size_t samples = 0;
    std::size_t most = 0;
    for (int i = 0; i < static_cast<int>(rate); ++i) {
      const std::size_t count = loop.receive();
      samples += count;
      most = std::max(most, count);
    }
    EXPECT_EQ(samples, 1000U) << rate;
    EXPECT_EQ(most, static_cast<std::size_t>(std::ceil(1000.0 / rate))) << rate;
  }
}

TEST(SimulatedDevice, WhatDoesNotFitIsDroppedOldestFirst) {
  const auto device = make_simulated_device(squeezing_settings());
  device->open();
  std::array<DeviceSample, 2> room{};
  ASSERT_EQ(device->receive(0.005, room), 2U);
  EXPECT_EQ(room[0].sequence, 4U);
  EXPECT_EQ(room[1].sequence, 5U);
  EXPECT_EQ(device->statistics().overflowed, 3U);
  EXPECT_EQ(device->receive(0.010, {}), 0U);
  EXPECT_EQ(device->statistics().overflowed, 8U);
  EXPECT_EQ(device->statistics().received, 10U);
}

// As ASqueezeIsFeltAtTheJoints of the controller: 3 N at rest.
TEST(SimulatedDevice, ASqueezeIsFeltThroughTheInterface) {
  Loop loop;
  loop.run(2);
  EXPECT_EQ(loop.newest().state, DeviceState::kStarting);
  loop.run(798);  // 4 s
  EXPECT_EQ(loop.newest().state, DeviceState::kActive);
  EXPECT_EQ(loop.newest().factor, 1.0);
  EXPECT_EQ(loop.newest().acted_tick, 799U) << "the last command acts from the next tick on";
  EXPECT_EQ(loop.device().statistics().sent, 800U);
  EXPECT_NEAR(loop.torque()[idx(kMcp)], -0.15, 0.0015);
  EXPECT_NEAR(1e-4 * loop.newest().raw[kTorqueChannel], -0.15, 0.0015) << "measured";
  EXPECT_EQ(loop.device().connection_fault(), Fault::kNone);
}

// The wall asks for more than 0.15 Nm there, of which 0.05 Nm are granted.
TEST(SimulatedDevice, NoTorqueGoesAboveTheLimitThatTheHostConfigures) {
  SimulatedDeviceSettings settings = squeezing_settings();
  settings.torque_limit = 0.05;
  Loop loop(settings);
  loop.run(800);
  EXPECT_LT(loop.torque()[idx(kMcp)], -0.15);
  EXPECT_NEAR(1e-4 * loop.newest().raw[kTorqueChannel], -0.05, 0.001) << "measured";
}

TEST(SimulatedDevice, AHostThatFallsSilentIsLatchedAndResumesAfterReset) {
  Loop loop;
  loop.run(800);
  const std::uint64_t acted_on = loop.newest().time_us;
  for (int i = 0; i < 4; ++i) loop.receive();
  EXPECT_EQ(loop.newest().state, DeviceState::kLatched);
  EXPECT_EQ(loop.newest().fault, Fault::kStepTooOld);
  EXPECT_EQ(loop.newest().fault_channel, -1);
  EXPECT_EQ(loop.newest().factor, 0.0);
  EXPECT_EQ(loop.newest().time_us, acted_on + 20000U);
  loop.run(20);
  EXPECT_EQ(loop.newest().state, DeviceState::kLatched);
  loop.device().reset();
  loop.run(3);
  EXPECT_EQ(loop.newest().state, DeviceState::kStarting);
  EXPECT_EQ(loop.newest().fault, Fault::kNone);
  EXPECT_LT(loop.newest().factor, 0.1) << "a fresh ramp";
}

TEST(SimulatedDevice, ADisabledHostIsReadyAndNoFault) {
  Loop loop;
  loop.run(100, false);
  EXPECT_EQ(loop.newest().state, DeviceState::kReady);
  loop.run(100);
  EXPECT_EQ(loop.newest().state, DeviceState::kStarting);
  loop.run(100, false);
  EXPECT_EQ(loop.newest().state, DeviceState::kReady);
  EXPECT_EQ(loop.newest().fault, Fault::kNone);
}

TEST(SimulatedDevice, AHostThatOnlyListensKeepsItsSession) {
  Loop loop;
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(loop.receive(), 5U) << "after " << 5 * i << " ms";
  EXPECT_EQ(loop.newest().state, DeviceState::kReady);
}

TEST(SimulatedDevice, ClosedItGivesNothingAndOpensAgain) {
  Loop loop;
  loop.run(300);
  loop.device().close();
  loop.device().close();
  EXPECT_EQ(loop.receive(), 0U);
  loop.device().reset();
  loop.send();
  EXPECT_EQ(loop.receive(), 0U);
  loop.device().open();
  EXPECT_EQ(loop.receive(), 5U);
  EXPECT_EQ(loop.newest().state, DeviceState::kReady);
}

/// The torque sensor's reading in the last of the five samples after a command of no torque but this wall.
double measured_with_wall(const LocalWall& wall, double valid_for) {
  Loop loop;
  loop.run(400);  // past the start-up ramp, near the object
  DeviceCommand command;
  command.enable = true;
  command.wall[idx(segment_index(kIndex, 2))] = wall;
  for (int i = 0; i < 40; ++i) {
    command.tick = 1000U + static_cast<std::uint64_t>(i);
    command.sample_time_us = loop.newest().time_us;
    command.wall_valid_for = valid_for;
    for (std::size_t c = 0; c < 2; ++c) {
      const DeviceChannel& channel = loop.device().info().channels[c];
      command.hcp_angle[idx(channel.index)] = channel.gain * loop.newest().raw[c];
    }
    loop.device().send(command);
    loop.receive();
  }
  return 1e-4 * loop.newest().raw[kTorqueChannel];
}

// 1000 N/m at a depth of 2 mm is 2 N: with g = -0.05 m on the MCP -0.1 Nm.
TEST(SimulatedDevice, TheControllerRendersTheCommandsWalls) {
  LocalWall wall{.active = true, .g = {-0.05, 0.0, 0.0, 0.0}, .d_ref = 2e-3, .stiffness = 1000.0};
  wall.force_max = 5.0;
  EXPECT_NEAR(measured_with_wall(wall, 0.02), -0.1, 0.005);
  EXPECT_NEAR(measured_with_wall(wall, 0.0), 0.0, 0.005) << "valid for no time";
  wall.active = false;
  EXPECT_NEAR(measured_with_wall(wall, 0.02), 0.0, 0.005);
}

TEST(SimulatedDevice, TheLoopsCallsAllocateNothing) {
  Loop loop;
  loop.run(10);
  const std::size_t before = allocations_of_this_thread();
  loop.run(400);
  loop.device().reset();
  loop.run(10);
  EXPECT_EQ(allocations_of_this_thread(), before);
}

TEST(SimulatedDevice, AHostWithoutARateIsRefused) {
  SimulatedDeviceSettings settings = squeezing_settings();
  for (const double rate : {0.0, -200.0, std::nan("")}) {
    settings.host_rate_hz = rate;
    EXPECT_THROW(static_cast<void>(make_simulated_device(settings)), std::invalid_argument) << rate;
  }
}

}  // namespace
}  // namespace phalanx::test
