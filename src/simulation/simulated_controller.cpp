// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/simulated_controller.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "phalanx/core/random.h"
#include "phalanx/device/link/messages.h"
#include "phalanx/simulation/press_cycle.h"
#include "phalanx/simulation/simulated_channels.h"

namespace phalanx {
namespace {

using RawArray = std::array<std::int32_t, kMaxChannels>;

constexpr double kJump = 50.0 * std::numbers::pi / 180.0;  ///< jump of an angle [rad]
constexpr std::int64_t kBeyond = 1000;  ///< counts beyond its range that an open or shorted sensor reads

std::int32_t saturated(std::int64_t counts) noexcept {
  using Limits = std::numeric_limits<std::int32_t>;
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(counts, Limits::min(), Limits::max()));
}

std::int64_t jump_of(const DeviceChannel& channel) noexcept {
  if (channel.kind == ChannelKind::kAngle) return std::llround(kJump / channel.gain);
  return (static_cast<std::int64_t>(channel.raw_max) - channel.raw_min) / 4;
}

/// @returns the largest torque that the motors can exert on a joint [Nm].
double most_torque(const Exoskeleton& exoskeleton) {
  JointArray most{};
  for (const ExoMotor& motor : exoskeleton.motors)
    for (std::size_t j = 0; j < most.size(); ++j) most[j] += std::abs(motor.arm[j]) * motor.force_limit;
  return *std::max_element(most.begin(), most.end());
}

phx_device link_device(const DeviceInfo& info, const Exoskeleton& exoskeleton) {
  phx_device device{};
  write_serial(info.serial, device.serial);
  device.rate_hz = static_cast<std::uint16_t>(std::lround(info.rate_hz));
  device.channel_count = static_cast<std::uint8_t>(info.channels.size());
  device.simulated = info.simulated;
  for (std::size_t c = 0; c < info.channels.size(); ++c) device.channel[c] = link_channel(info.channels[c]);
  device.torque_limit = static_cast<float>(most_torque(exoskeleton));
  device.torque_rate = static_cast<float>(SimulatedController::kOwnTorqueRate);
  return device;
}

DeviceInfo info_of(const SimulatedDeviceSettings& settings, const std::string& serial) {
  const double rate = settings.exoskeleton.controller.rate_hz;
  const bool carried = rate >= 1.0 && rate <= 65535.0;  // false for NaN, too
  if (!carried)
    throw std::invalid_argument(
        "device '" + settings.exoskeleton.name +
        "': the link carries controller rates of 1 to 65535 Hz; change controller.rate_hz");
  return {.name = settings.exoskeleton.name,
          .serial = serial,
          .rate_hz = rate,
          .channels = simulated_channels(settings.exoskeleton, settings.hand),
          .renders_torque = true,
          .simulated = true,
          .watchdog = 1e-6 * PHX_LATCH_AGE_US};
}

PressCycle cycle_of(const SimulatedDeviceSettings& settings) {
  return {settings.plan,          settings.patient, settings.hand,  settings.wall,
          settings.patient.press, settings.seed,    TrialSchedule{}};
}

}  // namespace

struct SimulatedController::Parts {
  Parts(const SimulatedDeviceSettings& given, const std::string& serial, std::uint32_t first_epoch)
      : settings(given),
        info(info_of(settings, serial)),
        cycle(cycle_of(settings)),
        exoskeleton(settings.exoskeleton, settings.patient, settings.hand.open_angle, cycle.angle(0.0),
                    sensor_seed(settings.seed)),
        noise(settings.seed ^ 0x5eedb40ce0000000ULL),
        device(link_device(info, settings.exoskeleton)) {
    phx_controller_init(&controller, &device, first_epoch);
  }

  [[nodiscard]] std::uint64_t time_us() const noexcept {
    return static_cast<std::uint64_t>(std::llround(1e6 * static_cast<double>(clock) / info.rate_hz));
  }
  [[nodiscard]] bool has(int channel) const noexcept {
    return channel >= 0 && static_cast<std::size_t>(channel) < info.channels.size();
  }
  void advance_clock(const SimulatedBreakage& breakage) noexcept;
  void read_sensors(const SimulatedBreakage& breakage) noexcept;
  void drive_motors(const SimulatedBreakage& breakage) noexcept;
  void advance_plant() noexcept;

  SimulatedDeviceSettings settings;
  DeviceInfo info;
  PressCycle cycle;  ///< refers to the settings
  SimulatedExoskeleton exoskeleton;
  Random noise;
  phx_device device;
  phx_controller controller{};
  phx_output output{};
  RawArray raw{};           ///< of the last tick
  std::uint64_t clock = 0;  ///< time since the start or restart [ticks]
  std::uint64_t ticks = 0;  ///< ticks of the plant
};

void SimulatedController::Parts::advance_clock(const SimulatedBreakage& breakage) noexcept {
  if (!breakage.clock_backwards) {
    ++clock;
  } else if (clock > 0) {
    --clock;
  }
}

void SimulatedController::Parts::read_sensors(const SimulatedBreakage& breakage) noexcept {
  const RawArray before = raw;
  exoskeleton.measure_tick();
  read_raw(exoskeleton, info.channels, raw);
  const auto set = [this](int channel, auto value) {
    if (!has(channel)) return;
    const auto c = static_cast<std::size_t>(channel);
    raw[c] = saturated(value(info.channels[c], std::int64_t{raw[c]}));
  };
  set(breakage.noise_channel, [&](const DeviceChannel&, std::int64_t now) {
    return now + std::llround(breakage.noise_counts * noise.normal());
  });
  set(breakage.jump_channel,
      [](const DeviceChannel& channel, std::int64_t now) { return now + jump_of(channel); });
  set(breakage.open_channel,
      [](const DeviceChannel& channel, std::int64_t) { return channel.raw_max + kBeyond; });
  set(breakage.shorted_channel,
      [](const DeviceChannel& channel, std::int64_t) { return channel.raw_min - kBeyond; });
  if (ticks > 0 && has(breakage.stuck_channel)) {
    const auto c = static_cast<std::size_t>(breakage.stuck_channel);
    raw[c] = before[c];
  }
}

void SimulatedController::Parts::drive_motors(const SimulatedBreakage& breakage) noexcept {
  JointArray torque{};
  std::transform(std::begin(output.torque), std::end(output.torque), torque.begin(),
                 [](float x) { return static_cast<double>(x); });
  exoskeleton.drive(torque);
  if (breakage.dead_motor >= 0 &&
      static_cast<std::size_t>(breakage.dead_motor) < settings.exoskeleton.motors.size())
    exoskeleton.fail_motor(static_cast<std::size_t>(breakage.dead_motor));
}

void SimulatedController::Parts::advance_plant() noexcept {
  const double period = exoskeleton.period();
  const double t = static_cast<double>(ticks) * period;
  exoskeleton.end_tick({.from = cycle.angle(t),
                        .to = cycle.angle(static_cast<double>(ticks + 1) * period),
                        .push = cycle.push(t)});
  ++ticks;
}

SimulatedController::SimulatedController(const SimulatedDeviceSettings& settings, const std::string& serial,
                                         std::uint32_t first_epoch)
    : parts_(std::make_unique<Parts>(settings, serial, first_epoch)) {}
SimulatedController::SimulatedController(SimulatedController&&) noexcept = default;
SimulatedController::~SimulatedController() = default;

phx_received SimulatedController::receive(std::span<const std::uint8_t> frame,
                                          std::array<std::uint8_t, PHX_FRAME_MAX>& reply,
                                          std::size_t& reply_size) noexcept {
  return phx_controller_receive(&parts_->controller, frame.data(), frame.size(), time_us(), reply.data(),
                                &reply_size);
}

const phx_output& SimulatedController::tick(const SimulatedBreakage& breakage) noexcept {
  Parts& p = *parts_;
  p.advance_clock(breakage);
  p.read_sensors(breakage);
  phx_controller_tick(&p.controller, p.time_us(), p.raw.data(), breakage.estop, breakage.drive_fault,
                      &p.output);
  p.drive_motors(breakage);
  p.advance_plant();
  return p.output;
}

void SimulatedController::skip(std::uint64_t ticks) noexcept { parts_->clock += ticks; }

void SimulatedController::restart(std::uint32_t first_epoch) noexcept {
  phx_controller_init(&parts_->controller, &parts_->device, first_epoch);
  parts_->output = {};
  parts_->clock = 0;
}

const phx_controller& SimulatedController::controller() const noexcept { return parts_->controller; }
const phx_output& SimulatedController::output() const noexcept { return parts_->output; }
const SimulatedExoskeleton& SimulatedController::exoskeleton() const noexcept { return parts_->exoskeleton; }
const DeviceInfo& SimulatedController::info() const noexcept { return parts_->info; }
std::uint64_t SimulatedController::ticks() const noexcept { return parts_->ticks; }
std::uint64_t SimulatedController::time_us() const noexcept { return parts_->time_us(); }
double SimulatedController::period() const noexcept { return parts_->exoskeleton.period(); }

}  // namespace phalanx
