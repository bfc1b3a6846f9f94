// SPDX-License-Identifier: Apache-2.0
// A controller in memory with a clock of its own, for tests of the conformance test: the reference, or the
// reference with one defect. Time passes only in receive().
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "device/conform/conform_host.h"
#include "device/conform/conform_port.h"
#include "phalanx/device/link/phalanx_link.h"

namespace phalanx::test {

using LinkBytes = std::vector<std::uint8_t>;

inline phx_device conform_device() {
  phx_device device{};
  std::copy_n("FAKE-1", 6, device.serial);
  device.rate_hz = 1000;
  device.channel_count = 3;
  device.channel[0] = {PHX_CHANNEL_ANGLE, 4, 50, 4045, 0.00157F, -0.2F};
  device.channel[1] = {PHX_CHANNEL_ANGLE, 5, 50, 4045, 0.00157F, -0.2F};
  device.channel[2] = {PHX_CHANNEL_TORQUE, 4, -20000, 20000, 1e-4F, 0.0F};
  device.torque_limit = 0.5F;
  device.torque_rate = 10.0F;
  return device;
}

/// Port to a firmware. The hooks are its defects; each may be empty.
class FakeFirmware : public ConformPort {
 public:
  explicit FakeFirmware(bool serial = false, phx_device device = conform_device())
      : serial_(serial), device_(device) {
    phx_controller_init(&controller, &device_, 100);
    phx_receiver_init(&receiver_);
  }

  // ---- the firmware ----

  phx_controller controller{};
  std::function<void(FakeFirmware&, LinkBytes&)> on_frame;     ///< a frame comes; an empty one is dropped
  std::function<void(FakeFirmware&, LinkBytes&)> after_frame;  ///< it was handled
  std::function<void(phx_message&)> on_reply;
  std::function<void(FakeFirmware&)> before_tick;
  std::function<void(phx_message&)> on_sample;
  std::function<double(int)> interval;  ///< of the n-th tick [s]; empty: 1 ms
  double clock_speed = 1.0;
  int frames_per_tick = 1000;
  std::size_t queue = 1000;
  std::vector<double> stalls;  ///< times at which the host stands still for 50 ms, last one first [s]
  /// Serial: it receives nothing for 200 ms after a piece that is no frame.
  bool stops_receiving_after_damage = false;

  [[nodiscard]] std::uint64_t time_us() const {
    return static_cast<std::uint64_t>(std::llround(1e6 * (5.0 + clock_speed * now_)));
  }
  /// Replaces a valid frame's bytes and its CRC.
  static void change(LinkBytes& frame, const std::function<void(LinkBytes&)>& by) {
    phx_message message{};
    const phx_decoded decoded = phx_decode(frame.data(), frame.size(), &message);
    if (decoded == PHX_BAD_CRC || frame.size() < PHX_HEADER_SIZE + PHX_CRC_SIZE) return;
    by(frame);
    ConformHost::seal(frame);
  }
  static bool is(const LinkBytes& frame, std::uint8_t type) { return frame.size() > 16 && frame[3] == type; }

  // ---- the wire ----

  [[nodiscard]] double now() const override { return now_; }
  [[nodiscard]] bool serial() const override { return serial_; }
  [[nodiscard]] double bytes_per_second() const override { return serial_ ? 2e5 : 0.0; }
  void send(std::span<const std::uint8_t> frame, ConformSender sender) override {
    if (!serial_) {
      if (frame.size() <= PHX_FRAME_MAX) put({LinkBytes(frame.begin(), frame.end()), sender});
      return;
    }
    LinkBytes stuffed(frame.size() + frame.size() / 254 + 2);
    stuffed.resize(phx_cobs_encode(frame.data(), frame.size(), stuffed.data(), stuffed.size()));
    send_bytes(stuffed);
  }
  void send_bytes(std::span<const std::uint8_t> bytes) override {
    for (const std::uint8_t byte : bytes) {
      const std::uint32_t dropped = receiver_.dropped;
      const std::size_t size = phx_receiver_take(&receiver_, byte);
      if (receiver_.dropped != dropped && stops_receiving_after_damage) receives_from_ = now_ + 0.2;
      if (size > 0 && now_ >= receives_from_)
        put({LinkBytes(receiver_.frame, receiver_.frame + size), ConformSender::kHost});
    }
  }
  std::size_t receive(double until, std::span<std::uint8_t> out, ConformSender& to) override {
    if (!stalls.empty() && now_ >= stalls.back()) {
      stalls.pop_back();
      for (const double end = now_ + 0.05; next_tick_ <= end;) pass_tick();
    }
    while (true) {
      const bool comes = !to_host_.empty() && to_host_.front().due <= std::min(until, next_tick_);
      if (comes) {
        const Sent sent = std::move(to_host_.front());
        to_host_.pop_front();
        now_ = std::max(now_, sent.due);
        std::copy(sent.frame.begin(), sent.frame.end(), out.begin());
        to = sent.peer;
        return sent.frame.size();
      }
      if (next_tick_ > until) {
        now_ = std::max(now_, until);
        return 0;
      }
      pass_tick();
    }
  }

 protected:
  virtual phx_received take_frame(const LinkBytes& frame, std::array<std::uint8_t, PHX_FRAME_MAX>& reply,
                                  std::size_t& size) {
    return phx_controller_receive(&controller, frame.data(), frame.size(), time_us(), reply.data(), &size);
  }
  virtual const phx_output& make_tick() {
    std::array<std::int32_t, PHX_CHANNELS> raw{};
    raw[0] = raw[1] = 2000;
    raw[2] = static_cast<std::int32_t>(std::lround(output_.torque[4] / 1e-4F));
    phx_controller_tick(&controller, time_us(), raw.data(), false, false, &output_);
    return output_;
  }

 private:
  static constexpr double kLatency = 0.2e-3;  ///< from a tick to the host [s]
  struct Received {
    LinkBytes frame;
    ConformSender peer;
  };
  struct Sent {
    LinkBytes frame;
    ConformSender peer;
    double due;
  };

  void put(Received received) {
    if (to_firmware_.size() < queue) to_firmware_.push_back(std::move(received));
  }
  void answer(const phx_message& message, ConformSender peer) {
    LinkBytes frame(PHX_FRAME_MAX);
    frame.resize(phx_encode(&message, frame.data(), frame.size()));
    to_host_.push_back({std::move(frame), serial_ ? ConformSender::kHost : peer, now_ + kLatency});
  }
  void handle(Received received) {
    if (on_frame) on_frame(*this, received.frame);
    if (received.frame.empty()) return;
    std::array<std::uint8_t, PHX_FRAME_MAX> reply{};
    std::size_t size = 0;
    const phx_received result = take_frame(received.frame, reply, size);
    if (after_frame) after_frame(*this, received.frame);
    if (result == PHX_NEW_SESSION) host_ = received.peer;
    phx_message message{};
    if (size == 0 || phx_decode(reply.data(), size, &message) != PHX_OK) return;
    if (on_reply) on_reply(message);
    answer(message, received.peer);
  }
  void pass_tick() {
    now_ = next_tick_;
    next_tick_ += interval ? interval(ticks_) : 1e-3;
    tick();
  }
  void tick() {
    ++ticks_;
    for (int i = 0; i < frames_per_tick && !to_firmware_.empty(); ++i) {
      Received received = std::move(to_firmware_.front());
      to_firmware_.pop_front();
      handle(std::move(received));
    }
    if (before_tick) before_tick(*this);
    const phx_output& output = make_tick();
    for (const float torque : output.torque)
      EXPECT_LE(std::abs(torque), 0.0501F) << "more than the test may command";
    phx_message message{};
    if (output.sample_size == 0 || phx_decode(output.sample, output.sample_size, &message) != PHX_OK) return;
    if (on_sample) on_sample(message);
    answer(message, host_);
  }

  bool serial_;
  phx_device device_;
  phx_receiver receiver_{};
  phx_output output_{};
  double now_ = 0.0;
  double next_tick_ = 1e-3;
  double receives_from_ = 0.0;
  int ticks_ = 0;
  ConformSender host_ = ConformSender::kHost;
  std::deque<Received> to_firmware_;
  std::deque<Sent> to_host_;
};

}  // namespace phalanx::test
