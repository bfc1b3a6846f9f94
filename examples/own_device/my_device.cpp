// SPDX-License-Identifier: Apache-2.0
#include "my_device.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace {

using namespace phalanx;

constexpr double kRate = 500.0;                      // samples a second
constexpr double kGain = std::numbers::pi / 4096.0;  // half a turn over 12 bits [rad/count]
constexpr double kPeriod = 2.0;                      // of the finger's motion [s]

class MyDevice final : public Device {
 public:
  MyDevice() {
    info_.name = "my device";
    info_.serial = "prototype-1";
    info_.rate_hz = kRate;
    info_.renders_torque = false;
    info_.watchdog = 0.020;  // its controller releases by itself 20 ms after the host's last message
    // Each channel states the joint, the valid counts, and value = gain raw + offset.
    for (const int joint : {joint_index(1, 0), joint_index(1, 2)}) {
      info_.channels.push_back({.kind = ChannelKind::kAngle,
                                .index = joint,
                                .raw_min = 0,
                                .raw_max = 4095,
                                .gain = kGain,
                                .offset = -1000.0 * kGain});
    }
  }

  // Set-up: connect here, and wait until info() is known. If no device answers, throw DeviceError with a
  // remedy.
  void open() override {
    begun_ = false;
    next_ = 0;
  }

  // Command zero torque, then release the device. It may be called at any time, also twice.
  void close() noexcept override {}

  [[nodiscard]] const DeviceInfo& info() const override { return info_; }

  // The loop calls this once a step. Return the samples since the last call, oldest first, without waiting.
  // A device on a wire has a thread that fills a SampleQueue; this one computes the samples that are due.
  [[nodiscard]] std::size_t receive(double now, std::span<DeviceSample> out) noexcept override {
    if (!begun_) start_ = now;
    begun_ = true;
    const auto due = static_cast<std::uint32_t>((now - start_) * kRate) + 1;
    if (due - next_ > out.size()) next_ = due - static_cast<std::uint32_t>(out.size());
    std::size_t count = 0;
    while (next_ < due) out[count++] = measure(next_++, now);
    return count;
  }

  // The newest command replaces all before it. A thread of your own gets it through a Latest<>, and releases
  // the motors when no command has come for 20 ms.
  void send(const DeviceCommand& command) noexcept override { enabled_ = command.enable && !command.fault; }

  // A person has examined the device and clears a fault.
  void reset() noexcept override {}

 private:
  [[nodiscard]] DeviceSample measure(std::uint32_t number, double now) const noexcept {
    const double time = number / kRate;
    const double closed = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * time / kPeriod);
    DeviceSample sample;
    sample.sequence = number + 1;
    sample.time_us = static_cast<std::uint64_t>(std::llround(1e6 * time)) + 1;
    sample.received = now;
    sample.raw[0] = 1000 + static_cast<std::int32_t>(std::lround(0.9 * closed / kGain));
    sample.raw[1] = 1000 + static_cast<std::int32_t>(std::lround(0.5 * closed / kGain));
    sample.state = enabled_ ? DeviceState::kActive : DeviceState::kReady;
    sample.factor = enabled_ ? 1.0 : 0.0;
    return sample;
  }

  DeviceInfo info_;
  bool begun_ = false;
  bool enabled_ = false;
  double start_ = 0.0;      // the host's clock at the first sample [s]
  std::uint32_t next_ = 0;  // number of the sample that comes next
};

}  // namespace

std::unique_ptr<phalanx::Device> make_my_device() { return std::make_unique<MyDevice>(); }
