// SPDX-License-Identifier: Apache-2.0
#include "my_device.h"

#include <cmath>
#include <numbers>

using namespace phalanx;

namespace {
constexpr double kGain = std::numbers::pi / 4096.0;  // [rad/count]; value = gain raw + offset
class MyDevice final : public Device {
 public:
  MyDevice() {
    info_.name = "my device";
    info_.serial = "prototype-1";
    info_.rate_hz = 500.0;
    info_.renders_torque = false;
    info_.actuated = false;  // no motors. With motors, state info_.watchdog only if the controller by itself
                             // releases them when no command has come for that time
    for (const int joint : {joint_index(1, 0), joint_index(1, 2)})  // counts beyond: open or shorted sensor
      info_.channels.push_back(
          {.index = joint, .raw_min = 50, .raw_max = 4045, .gain = kGain, .offset = -1000.0 * kGain});
  }
  // Connect, and wait until info() is known. If no device answers, throw DeviceError with a remedy.
  void open() override { next_ = 0; }
  // Command zero torque, then release the device. It may be called at any time, also twice.
  void close() noexcept override {}
  [[nodiscard]] const DeviceInfo& info() const override { return info_; }

  // Return the samples since the last call, oldest first, without waiting. For a device on a wire a thread of
  // yours fills a SampleQueue; this one computes the samples that are due.
  [[nodiscard]] std::size_t receive(double now, std::span<DeviceSample> out) noexcept override {
    if (next_ == 0) start_ = now;
    std::size_t count = 0;
    for (; count < out.size() && next_ <= (now - start_) * info_.rate_hz; ++next_) out[count++] = sample(now);
    return count;
  }
  // The newest command replaces all before it. With motors: release them when none has come for 20 ms.
  void send(const DeviceCommand& command) noexcept override { enabled_ = command.enable && !command.fault; }
  void reset() noexcept override {}  // a person has examined the device and clears a fault

 private:
  [[nodiscard]] DeviceSample sample(double now) const noexcept {  // the finger closes and opens in 2 s
    const double closed = 0.5 - 0.5 * std::cos(std::numbers::pi * next_ / info_.rate_hz);
    DeviceSample sample{.sequence = next_ + 1, .time_us = 1 + 2000ULL * next_, .received = now};
    sample.raw = {counts(0.9 * closed), counts(0.5 * closed)};
    sample.state = enabled_ ? DeviceState::kActive : DeviceState::kReady;
    sample.factor = enabled_ ? 1.0 : 0.0;
    return sample;
  }
  static int counts(double angle) noexcept { return 1000 + static_cast<int>(std::lround(angle / kGain)); }
  DeviceInfo info_;
  bool enabled_ = false;
  double start_ = 0.0;      // the host's clock at the first sample [s]
  std::uint32_t next_ = 0;  // number of the sample that comes next
};
}  // namespace

std::unique_ptr<Device> make_my_device() { return std::make_unique<MyDevice>(); }
