// SPDX-License-Identifier: Apache-2.0
// The reference controller on a real wire, in a thread of its own.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "device/link/session_bench.h"
#include "phalanx/device/clock.h"
#include "phalanx/device/link/transport.h"

namespace phalanx::test {

/// 1 kHz of `clock`. Every raw value counts the controller's ticks since it was made, until hold().
class ControllerThread {
 public:
  ControllerThread(std::unique_ptr<Transport> transport, const Clock& clock,
                   const phx_device& device = bench_device())
      : transport_(std::move(transport)), clock_(clock), address_(transport_->address()), device_(device) {
    boot(1000);
    thread_ = std::thread([this] { run(); });
  }
  ~ControllerThread() { stop(); }
  ControllerThread(const ControllerThread&) = delete;
  ControllerThread& operator=(const ControllerThread&) = delete;

  void stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    transport_.reset();
  }
  void restart() { restart_ = true; }
  /// From here its two sensors read this.
  void hold(std::array<std::int32_t, 2> raw) {
    const std::lock_guard lock(mutex_);
    held_ = raw;
  }
  [[nodiscard]] const std::string& address() const { return address_; }
  [[nodiscard]] std::string after_scheme() const { return address_.substr(address_.find(':') + 1); }

  /// As of its last tick.
  [[nodiscard]] phx_controller controller() {
    const std::lock_guard lock(mutex_);
    return shown_;
  }

 private:
  void boot(std::uint32_t first_epoch) {
    phx_controller_init(&controller_, &device_, first_epoch);
    booted_ = clock_.now();
    shown_ = controller_;
  }
  [[nodiscard]] std::uint64_t time_us() const {
    return static_cast<std::uint64_t>((clock_.now() - booted_) * 1e6) + 1;
  }

  void take_frames() {
    std::array<std::uint8_t, PHX_FRAME_MAX> frame{}, reply{};
    Peer from = 0;
    while (const std::size_t size = transport_->receive(frame, from)) {
      std::size_t reply_size = 0;
      const auto received =
          phx_controller_receive(&controller_, frame.data(), size, time_us(), reply.data(), &reply_size);
      if (received == PHX_NEW_SESSION) host_ = from;
      if (reply_size > 0) transport_->send({reply.data(), reply_size}, from);
    }
  }
  void run() {
    double next = clock_.now();
    while (!stop_) {
      if (restart_.exchange(false)) boot(controller_.epoch + 1000);
      take_frames();
      ++ticks_;
      std::array<std::int32_t, PHX_CHANNELS> raw{};
      raw[0] = raw[1] = ticks_;
      {
        const std::lock_guard lock(mutex_);
        if (held_) std::copy(held_->begin(), held_->end(), raw.begin());
      }
      phx_output output{};
      phx_controller_tick(&controller_, time_us(), raw.data(), false, false, &output);
      {  // before the sample leaves: who has it may look at the controller that sent it
        const std::lock_guard lock(mutex_);
        shown_ = controller_;
      }
      if (output.sample_size > 0) transport_->send({output.sample, output.sample_size}, host_);
      next = std::max(next + 1e-3, clock_.now());
      clock_.sleep_until(next);
    }
  }

  std::unique_ptr<Transport> transport_;
  const Clock& clock_;
  std::string address_;
  phx_device device_;
  phx_controller controller_{};
  phx_controller shown_{};
  double booted_ = 0.0;
  Peer host_ = 0;
  std::int32_t ticks_ = 0;
  std::atomic<bool> stop_{false};
  std::atomic<bool> restart_{false};
  std::optional<std::array<std::int32_t, 2>> held_;
  std::mutex mutex_;  ///< of shown_ and held_
  std::thread thread_;
};

}  // namespace phalanx::test
