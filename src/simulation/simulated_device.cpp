// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/simulated_device.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "phalanx/device/link/messages.h"
#include "phalanx/simulation/simulated_controller.h"

namespace phalanx {
namespace {

constexpr std::uint32_t kFirstEpoch = 1;
constexpr std::uint64_t kHostId = 1;

class SimulatedDevice final : public Device {
 public:
  explicit SimulatedDevice(const SimulatedDeviceSettings& settings)
      : controller_(settings, "simulated", kFirstEpoch),
        ticks_per_call_(settings.exoskeleton.controller.rate_hz / settings.host_rate_hz),
        torque_limit_(settings.torque_limit),
        torque_rate_(settings.torque_rate) {
    if (!(settings.host_rate_hz > 0.0) || !std::isfinite(ticks_per_call_))
      throw std::invalid_argument(
          fmt::format("simulated device: the host's rate {} Hz must be above 0; change the scene's rate_hz",
                      settings.host_rate_hz));
  }

  void open() override {
    phx_message message{};
    message.header.type = PHX_HELLO;
    message.as.hello.host_id = kHostId;
    epoch_ = 0;
    const phx_message answer = ask(message);
    if (answer.header.type != PHX_WELCOME)
      throw DeviceError("simulated device: its controller did not grant the session");
    epoch_ = answer.header.epoch;
    info_ = device_info(answer.as.welcome);
    info_.name = controller_.info().name;
    info_.own_clock = false;  // receive() advances its controller
    newest_ = configure_message(info_.channels, torque_limit_, torque_rate_);
    post(newest_);
  }

  void close() noexcept override {
    if (epoch_ == 0) return;
    post(PHX_GOODBYE);
    epoch_ = 0;
  }

  const DeviceInfo& info() const override { return info_; }

  std::size_t receive(double now, std::span<DeviceSample> out) noexcept override {
    owed_ += ticks_per_call_;
    const double due = std::floor(owed_ + 1e-9);
    owed_ -= due;
    const auto ticks = static_cast<std::uint64_t>(due);
    repeat_newest();
    const std::uint64_t too_many = ticks > out.size() ? ticks - out.size() : 0;
    std::size_t count = 0;
    for (std::uint64_t i = 0; i < ticks; ++i) {
      const phx_output& output = controller_.tick({});
      if (output.sample_size == 0) continue;
      if (phx_decode(output.sample, output.sample_size, &message_) != PHX_OK) {
        ++statistics_.corrupt;
        continue;
      }
      ++statistics_.received;
      note(message_.as.sample);
      if (i < too_many) {
        ++statistics_.overflowed;
        continue;
      }
      out[count++] = read_sample(message_, now);
    }
    return count;
  }

  void send(const DeviceCommand& command) noexcept override {
    if (epoch_ == 0) return;
    write_command(command, newest_);
    post(newest_);
    ++statistics_.sent;
  }

  void reset() noexcept override {
    if (epoch_ != 0) post(PHX_RESET);
  }

  LinkStatistics statistics() const noexcept override { return statistics_; }

 private:
  void note(const phx_sample& sample) noexcept {
    statistics_.device_corrupt = sample.corrupt;
    statistics_.device_refused = sample.refused;
    statistics_.device_outdated = sample.outdated;
  }

  /// Repeats the newest command, as a link's thread does: a host that only listens keeps its session.
  void repeat_newest() noexcept {
    if (epoch_ != 0 && !spoken_) post(newest_);
    spoken_ = false;
  }

  void post(std::uint8_t type) noexcept {
    message_.header.type = type;
    post(message_);
  }

  /// Passes a message to the controller. @returns the size of its reply in reply_
  std::size_t post(phx_message& message) noexcept {
    message.header.epoch = epoch_;
    message.header.sequence = ++sequence_[message.header.type];
    const std::size_t size = phx_encode(&message, frame_.data(), frame_.size());
    std::size_t reply_size = 0;
    controller_.receive({frame_.data(), size}, reply_, reply_size);
    spoken_ = true;
    return reply_size;
  }

  phx_message ask(phx_message& message) {
    const std::size_t size = post(message);
    phx_message answer{};
    if (phx_decode(reply_.data(), size, &answer) != PHX_OK) answer.header.type = 0;
    return answer;
  }

  SimulatedController controller_;
  double ticks_per_call_;
  double torque_limit_;
  double torque_rate_;
  double owed_ = 0.0;  ///< part of a tick by which time is ahead of the controller
  DeviceInfo info_;
  std::uint32_t epoch_ = 0;                             ///< 0: not open
  std::array<std::uint32_t, PHX_PONG + 1> sequence_{};  ///< by type
  bool spoken_ = false;                                 ///< a message was sent since the last receive()
  LinkStatistics statistics_;
  phx_message message_{};
  phx_message newest_{};  ///< newest command, or CONFIGURE before the first command
  std::array<std::uint8_t, PHX_FRAME_MAX> frame_{};
  std::array<std::uint8_t, PHX_FRAME_MAX> reply_{};
};

}  // namespace

std::unique_ptr<Device> make_simulated_device(const SimulatedDeviceSettings& settings) {
  return std::make_unique<SimulatedDevice>(settings);
}

}  // namespace phalanx
