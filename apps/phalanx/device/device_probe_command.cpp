// SPDX-License-Identifier: Apache-2.0
// phalanx device probe DEVICE: the identity of a device, and the readings of its sensors.
#include <fmt/format.h>

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "commands.h"
#include "device/device_text.h"
#include "phalanx/device/clock.h"
#include "phalanx/station/open_device.h"
#include "usage.h"

namespace phalanx {
namespace {

constexpr double kPatience = 1.0;  // longest wait for the first sample [s]

/// @returns the newest sample once the device is ready; the newest one at all if it does not become ready.
std::optional<DeviceSample> first_sample(Device& device, const Clock& clock) {
  std::optional<DeviceSample> newest;
  std::array<DeviceSample, 64> samples{};
  const double end = clock.now() + kPatience;
  while (clock.now() < end && (!newest || newest->state == DeviceState::kConnecting)) {
    clock.sleep_until(clock.now() + 0.005);
    const std::size_t count = device.receive(clock.now(), samples);
    if (count > 0) newest = samples[count - 1];
  }
  return newest;
}

void print_channel(std::size_t number, const DeviceChannel& channel,
                   const std::optional<DeviceSample>& sample) {
  const std::string_view unit = shown_unit(channel.kind);
  const double low = shown(channel, channel.gain < 0.0 ? channel.raw_max : channel.raw_min);
  const double high = shown(channel, channel.gain < 0.0 ? channel.raw_min : channel.raw_max);
  fmt::print("  {:>2}  {:<6}  {:<24} {:>10} ..{:>10}  {:>9.2f} .. {:>8.2f} {:<3}", number,
             kind_name(channel.kind), place_name(channel), channel.raw_min, channel.raw_max, low, high, unit);
  if (sample) {
    const std::int32_t raw = sample->raw[number];
    fmt::print("  {:>10}  {:>8.2f} {}{}", raw, shown(channel, raw), unit,
               in_range(channel, raw) ? "" : "  OUT OF RANGE: open or shorted?");
  }
  fmt::print("\n");
}

void print_device(const std::string& spec, const DeviceInfo& info,
                  const std::optional<DeviceSample>& sample) {
  fmt::print("{}\n", spec);
  if (info.name != info.serial) fmt::print("  name      {}\n", info.name);
  fmt::print("  serial    {}\n  rate      {:g} Hz\n", info.serial.empty() ? "(none)" : info.serial,
             info.rate_hz);
  fmt::print("  renders   {}\n", info.renders_torque ? "joint torques" : "stops of digits only");
  fmt::print("  watchdog  {}\n",
             info.watchdog
                 ? fmt::format("ends its forces {:g} ms after the host's last message", 1e3 * *info.watchdog)
                 : "not known: with force it is for trying out, not for a patient's session");
  if (!sample) {
    fmt::print("  state     it answers, but no sample came within {:g} s\n", kPatience);
  } else {
    fmt::print("  state     {}\n  fault     {}", state_name(sample->state), fault_text(sample->fault));
    if (sample->fault_channel >= 0) fmt::print(" (channel {})", sample->fault_channel);
    fmt::print("\n  e-stop    {}\n", sample->estop ? "PRESSED" : "released");
  }
  fmt::print("  session   granted to this program, given back now\n  channels  {}\n", info.channels.size());
  if (info.channels.empty()) return;
  fmt::print("  {:>2}  {:<6}  {:<24} {:>24}  {:>25}  {:>10}  {:>8}\n", "no", "kind", "of", "valid counts",
             "valid values", "raw now", "value");
  for (std::size_t i = 0; i < info.channels.size(); ++i) print_channel(i, info.channels[i], sample);
}

int probe(const std::string& spec, double timeout) {
  const Clock clock;
  LinkSettings settings;
  settings.hello_timeout = timeout;
  const auto device = open_device(spec, clock, settings);
  device->open();
  const std::optional<DeviceSample> sample = first_sample(*device, clock);
  device->close();
  print_device(spec, device->info(), sample);
  return sample ? kDone : kFailed;
}

}  // namespace

void add_device_probe(CLI::App& device, Job& job) {
  struct Options {
    std::string spec;
    double timeout = 3.0;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      device.add_subcommand("probe", "Who is there: serial number, rate, channels, first values");
  command->footer(
      std::string("DEVICE is one of\n") + kDeviceSpecs +
      "\nMotors stay off. Exit codes: 0 done, 1 no device answers, or it refuses, 2 wrong usage.");
  command->add_option("DEVICE", options->spec, "its address")->required()->type_name("");
  command->add_option("--timeout", options->timeout, "give up after so long [3]")
      ->check(CLI::Range(0.1, 3600.0))
      ->type_name("S");
  command->callback([options, command, &job] {
    refuse_empty_values(*command);
    job = [options] { return probe(options->spec, options->timeout); };
  });
}

}  // namespace phalanx
