// SPDX-License-Identifier: Apache-2.0
// A host's session and a controller on a wire that loses, doubles, delays and corrupts by a seed. No thread,
// no clock: time is a number, so that every run is the same.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "device/link/link_session.h"
#include "phalanx/device/link/messages.h"

namespace phalanx::test {

using WireBytes = std::vector<std::uint8_t>;

/// Of each frame, each way.
struct WireFaults {
  double drop = 0.0;
  double duplicate = 0.0;
  double corrupt = 0.0;
  double delay = 0.0;  ///< uniform from 0 to this [s]: frames overtake each other
  bool cut_to_host = false;
  bool cut_to_controller = false;
};

/// One direction.
class Wire {
 public:
  explicit Wire(std::uint64_t seed) : random_(seed) {}

  void put(const WireBytes& frame, double now, const WireFaults& faults, bool cut) {
    if (cut || chance(faults.drop)) return;
    const int copies = chance(faults.duplicate) ? 2 : 1;
    for (int i = 0; i < copies; ++i) {
      WireBytes copy = frame;
      if (chance(faults.corrupt))
        copy[random_() % copy.size()] ^= static_cast<std::uint8_t>(1 + random_() % 255);
      const double delay = faults.delay > 0.0 ? uniform() * faults.delay : 0.0;
      on_their_way_.emplace(now + delay, copy);
    }
  }
  [[nodiscard]] bool get(double now, WireBytes& frame) {
    const auto first = on_their_way_.begin();
    if (first == on_their_way_.end() || first->first > now) return false;
    frame = first->second;
    on_their_way_.erase(first);
    return true;
  }

 private:
  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  bool chance(double probability) { return probability > 0.0 && uniform() < probability; }

  std::mt19937_64 random_;
  std::multimap<double, WireBytes> on_their_way_;
};

inline phx_device bench_device() {
  phx_device device{};
  write_serial("BENCH-1", device.serial);
  device.rate_hz = 1000;
  device.channel_count = 2;
  device.channel[0] = {.kind = PHX_CHANNEL_ANGLE,
                       .index = 4,
                       .raw_min = -1000,
                       .raw_max = 1000000,
                       .gain = 1e-3f,
                       .offset = 0.0f};
  device.channel[1] = {.kind = PHX_CHANNEL_ANGLE,
                       .index = 6,
                       .raw_min = -1000,
                       .raw_max = 1000000,
                       .gain = 1e-3f,
                       .offset = 0.0f};
  device.torque_limit = 0.5f;
  device.torque_rate = 100.0f;
  return device;
}

/// Host and controller, both at 1 kHz; the controller's tick comes first.
class SessionBench : public Transport {
 public:
  explicit SessionBench(std::uint64_t seed)
      : to_host_(seed),
        to_controller_(seed + 1),
        shared_(std::make_unique<LinkShared>()),
        session_(*this, LinkSettings{}, 77, *shared_) {
    device_ = bench_device();
    restart(100);
    phx_message configure = configure_message(device_info(welcome()).channels, 0.5, 10.0);
    session_.set_configuration(configure);
  }

  // ---- the transport that the session has ----
  [[nodiscard]] std::size_t receive(std::span<std::uint8_t> out, Peer&) noexcept override {
    WireBytes frame;
    if (!to_host_.get(now_, frame)) return 0;
    std::copy(frame.begin(), frame.end(), out.begin());
    return frame.size();
  }
  bool send(std::span<const std::uint8_t> frame, Peer) noexcept override {
    ++host_frames_[frame[3]];
    to_controller_.put({frame.begin(), frame.end()}, now_, faults, faults.cut_to_controller);
    return true;
  }
  bool wait(double) noexcept override { return false; }
  [[nodiscard]] bool lost() const noexcept override { return unplugged; }
  [[nodiscard]] std::uint64_t dropped() const noexcept override { return 0; }
  [[nodiscard]] std::string address() const override { return "bench"; }

  // ---- time ----
  void controller_tick() {
    std::array<std::uint8_t, PHX_FRAME_MAX> reply{};
    WireBytes frame;
    while (to_controller_.get(now_, frame)) {
      phx_message message{};
      if (phx_decode(frame.data(), frame.size(), &message) == PHX_OK) controller_got.push_back(message);
      std::size_t size = 0;
      phx_controller_receive(&controller, frame.data(), frame.size(), time_us(), reply.data(), &size);
      if (size > 0) to_host(reply.data(), size);
    }
    std::array<std::int32_t, PHX_CHANNELS> raw{};
    raw[0] = raw[1] = ++raw_;
    phx_controller_tick(&controller, time_us(), raw.data(), estop, false, &output_);
    if (output_.sample_size > 0) to_host(output_.sample, output_.sample_size);
  }
  /// One millisecond. `between`: what the host's loop does in it.
  template <class Loop>
  void tick(const Loop& loop) {
    now_ += 1e-3;
    WireBytes unheard;
    if (!controller_off) controller_tick();
    while (controller_off && to_controller_.get(now_, unheard)) {
    }
    if (host_stopped) return;
    session_.receive(now_);
    loop(*this);
    session_.send_due(now_);
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) tick([](SessionBench&) {});
  }
  /// As a host that steps at 200 Hz.
  void run_commanding(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      tick([this](SessionBench&) {
        take_samples();
        if (++loop_ % 5 == 0) command(true);
      });
    }
  }

  // ---- the loop's side ----
  void take_samples() {
    std::array<DeviceSample, 64> out{};
    const auto taken = shared_->samples.take(out);
    samples.insert(samples.end(), out.begin(), out.begin() + static_cast<std::ptrdiff_t>(taken.count));
  }
  void command(bool enable) {
    DeviceCommand command;
    command.tick = ++step_;
    command.enable = enable;
    command.torque[4] = 0.1;
    if (!samples.empty()) command.sample_time_us = samples.back().time_us;
    shared_->command.write({.command = command, .at = now_});
  }
  void reset() { ++shared_->resets; }
  [[nodiscard]] LinkShared& shared() { return *shared_; }
  [[nodiscard]] Fault fault() const { return shared_->fault.load(); }
  [[nodiscard]] const LinkCounters& counters() const { return shared_->counters; }

  // ---- the controller's side ----
  void restart(std::uint32_t first_epoch) {
    phx_controller_init(&controller, &device_, first_epoch);
    booted_ = now_;
  }
  [[nodiscard]] std::uint64_t time_us() const {
    return static_cast<std::uint64_t>((now_ - booted_) * 1e6 + 0.5);
  }
  [[nodiscard]] const phx_output& output() const { return output_; }
  [[nodiscard]] int sent(phx_type type) const {
    const auto found = host_frames_.find(static_cast<std::uint8_t>(type));
    return found == host_frames_.end() ? 0 : found->second;
  }
  void open() {
    session_.ask(now_);
    for (int i = 0; i < 2000 && !(session_.phase() == LinkSession::Phase::kRunning && controller.configured);
         ++i)
      run(1);
    ASSERT_EQ(session_.phase(), LinkSession::Phase::kRunning);
    ASSERT_TRUE(controller.configured);
  }
  void to_host(const std::uint8_t* frame, std::size_t size) {
    to_host_.put({frame, frame + size}, now_, faults, faults.cut_to_host);
  }
  [[nodiscard]] LinkSession& session() { return session_; }
  [[nodiscard]] double now() const { return now_; }

  WireFaults faults;
  bool controller_off = false;
  bool host_stopped = false;
  bool estop = false;
  bool unplugged = false;
  phx_controller controller{};
  phx_device device_{};
  std::vector<phx_message> controller_got;
  std::vector<DeviceSample> samples;

 private:
  [[nodiscard]] phx_welcome welcome() const {
    phx_welcome welcome{};
    welcome.channel_count = device_.channel_count;
    std::copy(std::begin(device_.channel), std::end(device_.channel), std::begin(welcome.channel));
    return welcome;
  }

  Wire to_host_;
  Wire to_controller_;
  std::unique_ptr<LinkShared> shared_;
  LinkSession session_;
  std::map<std::uint8_t, int> host_frames_;
  phx_output output_{};
  double now_ = 1.0;
  double booted_ = 0.0;
  std::int32_t raw_ = 0;
  std::uint64_t step_ = 0;
  int loop_ = 0;
};

}  // namespace phalanx::test
