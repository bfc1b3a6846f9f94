// SPDX-License-Identifier: Apache-2.0
// A device that passes everything on to another and writes down what a station did with it.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>
#include <utility>

#include "phalanx/device/device.h"
#include "support/count_allocations.h"

namespace phalanx::test {

class WatchedDevice : public Device {
 public:
  explicit WatchedDevice(std::unique_ptr<Device> device) : device_(std::move(device)) {}

  void open() override { device_->open(); }
  void close() noexcept override { device_->close(); }
  [[nodiscard]] const DeviceInfo& info() const override { return device_->info(); }
  [[nodiscard]] std::size_t receive(double now, std::span<DeviceSample> out) noexcept override {
    note_thread();
    // The first steps of a thread may set up what the system keeps for each thread.
    if (++calls_ == 20) allocations_before_ = allocations_of_this_thread();
    if (calls_ > 20) allocations = allocations_of_this_thread() - allocations_before_;
    if (delay > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(delay.load()));
    if (silent) return 0;
    const std::size_t count = device_->receive(now, out);
    for (std::size_t i = 0; i < count; ++i) out[i].estop = out[i].estop || estop;
    return count;
  }
  void send(const DeviceCommand& command) noexcept override {
    note_thread();
    for (std::size_t j = 0; j < command.torque.size(); ++j) {
      largest_step = std::max(largest_step.load(), std::abs(command.torque[j] - last_[j]));
      largest_torque = std::max(largest_torque.load(), std::abs(command.torque[j]));
    }
    ticks_increase = ticks_increase && command.tick > last_tick_;
    last_tick_ = command.tick;
    last_ = command.torque;
    at_zero = std::all_of(last_.begin(), last_.end(), [](double torque) { return torque == 0.0; });
    device_->send(command);
  }
  void reset() noexcept override {
    note_thread();
    device_->reset();
  }
  [[nodiscard]] LinkStatistics statistics() const noexcept override {
    note_thread();
    return device_->statistics();
  }

  std::atomic<double> delay{0.0};  ///< each receive() takes so long [s]
  std::atomic<bool> silent{false};
  std::atomic<bool> estop{false};
  std::atomic<bool> ticks_increase{true};
  mutable std::atomic<bool> one_thread{true};  ///< calls all of it that is not set-up
  std::atomic<bool> at_zero{true};             ///< the last command asks for no torque
  std::atomic<double> largest_step{0.0};       ///< of a joint's torque from one command to the next [Nm]
  std::atomic<double> largest_torque{0.0};     ///< [Nm]
  std::atomic<std::size_t> allocations{0};     ///< on the loop's thread, after its first 20 steps

 private:
  void note_thread() const noexcept {
    std::thread::id first{};
    const std::thread::id here = std::this_thread::get_id();
    if (!thread_.compare_exchange_strong(first, here) && first != here) one_thread = false;
  }

  std::unique_ptr<Device> device_;
  mutable std::atomic<std::thread::id> thread_{};
  JointArray last_{};
  std::uint64_t last_tick_ = 0;
  int calls_ = 0;
  std::size_t allocations_before_ = 0;
};

}  // namespace phalanx::test
