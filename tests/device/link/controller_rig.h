// SPDX-License-Identifier: Apache-2.0
// A controller of 1 kHz on a bench: its clock, its sensors and a host that sends what it is told.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "device/link/frame_bytes.h"

namespace phalanx::link_test {

/// Joint 5 (the index finger's second) has angle channel 1, joint 4 channel 0, the index tip force channel 2.
inline constexpr std::size_t kJoint = 5;
inline constexpr std::uint64_t kPeriod = 1000;  // [us]
inline constexpr std::uint64_t kHost = 11;
inline constexpr float kLimit = 0.5F;  // [Nm]
inline constexpr float kRate = 10.0F;  // [Nm/s]: 0.01 Nm a tick

inline phx_device bench_device() {
  phx_device device{};
  device.serial[0] = 'B';
  device.rate_hz = 1000;
  device.channel_count = 3;
  device.channel[0] = {PHX_CHANNEL_ANGLE, 4, -4000, 4000, 1e-3F, 0.0F};
  device.channel[1] = {PHX_CHANNEL_ANGLE, 5, -4000, 4000, 1e-3F, 0.0F};
  device.channel[2] = {PHX_CHANNEL_FORCE, 1, 0, 4095, 1e-2F, 0.0F};
  device.torque_limit = kLimit;
  device.torque_rate = kRate;
  return device;
}

class Rig {
 public:
  explicit Rig(const phx_device& device = bench_device()) { phx_controller_init(&controller, &device, 100); }

  /// What the controller makes of a frame, at `now`; `reply` is its answer, if any.
  phx_received receive(const Bytes& frame) {
    std::array<std::uint8_t, PHX_FRAME_MAX> answer{};
    std::size_t size = 0;
    const phx_received received =
        phx_controller_receive(&controller, frame.data(), frame.size(), now, answer.data(), &size);
    reply.reset();
    if (size != 0) {
      EXPECT_EQ(phx_decode(answer.data(), size, &reply.emplace()), PHX_OK);
    }
    return received;
  }
  phx_received send(phx_message message) {
    if (message.header.sequence == 0) message.header.sequence = ++sequence_;
    return receive(encoded(message));
  }
  phx_message frame(std::uint8_t type) const {
    phx_message message{};
    message.header.type = type;
    message.header.epoch = epoch;
    return message;
  }
  phx_received hello(std::uint64_t host = kHost) {
    phx_message message = frame(PHX_HELLO);
    message.header.epoch = 0;
    message.as.hello.host_id = host;
    const phx_received received = send(message);
    if (received == PHX_NEW_SESSION && host == kHost) epoch = reply->header.epoch;
    return received;
  }
  phx_received configure(float limit = kLimit, float rate = kRate) {
    phx_message message = frame(PHX_CONFIGURE);
    for (std::size_t i = 0; i < PHX_CHANNELS; ++i) message.as.configure.gain[i] = 1e-3F;
    message.as.configure.torque_limit = limit;
    message.as.configure.torque_rate = rate;
    return send(message);
  }
  /// An enabled command of the next tick from the newest sample, `torque` on kJoint.
  phx_message next_command(float torque) {
    phx_message message = frame(PHX_COMMAND);
    message.as.command.tick = ++host_tick;
    message.as.command.sample_time_us = sample.time_us;
    message.as.command.flags = PHX_COMMAND_ENABLE;
    message.as.command.torque[kJoint] = torque;
    return message;
  }
  phx_received command(float torque) { return send(next_command(torque)); }
  phx_received disable() {
    phx_message message = next_command(0.0F);
    message.as.command.flags = 0;
    return send(message);
  }

  /// One tick, a period later. @returns the torque on kJoint
  float tick(std::uint64_t after = kPeriod) {
    now += after;
    phx_controller_tick(&controller, now, raw.data(), estop, drive_fault, &output);
    phx_message message{};
    has_sample = output.sample_size != 0;
    if (has_sample && phx_decode(output.sample, output.sample_size, &message) == PHX_OK)
      sample = message.as.sample;
    for (const float torque : output.torque) EXPECT_TRUE(std::isfinite(torque));
    return output.torque[kJoint];
  }
  /// Ticks without a frame.
  float silent(int ticks) {
    float torque = 0.0F;
    for (int i = 0; i < ticks; ++i) torque = tick();
    return torque;
  }
  /// Ticks with a fresh enabled command before each.
  float drive(float torque, int ticks) {
    float sent = 0.0F;
    for (int i = 0; i < ticks; ++i) {
      command(torque);
      sent = tick();
    }
    return sent;
  }
  /// Session, configuration and, with it, one tick.
  void open() {
    ASSERT_EQ(hello(), PHX_NEW_SESSION);
    ASSERT_EQ(configure(), PHX_USED);
    tick();
  }
  /// As open(), and the start ramp over: `torque` in full.
  void open_and_act(float torque) {
    open();
    drive(torque, 1001);
    ASSERT_EQ(sample.state, PHX_STATE_ACTIVE);
    ASSERT_FLOAT_EQ(output.torque[kJoint], torque);
  }

  phx_controller controller{};
  phx_output output{};
  phx_sample sample{};  ///< newest
  bool has_sample = false;
  std::optional<phx_message> reply;
  std::array<std::int32_t, PHX_CHANNELS> raw{};
  bool estop = false;
  bool drive_fault = false;
  std::uint64_t now = 1'000'000;  ///< the controller's clock [us]
  std::uint64_t host_tick = 0;
  std::uint32_t epoch = 0;

 private:
  std::uint32_t sequence_ = 0;
};

class LinkController : public testing::Test {
 protected:
  Rig rig;
};

}  // namespace phalanx::link_test
