// SPDX-License-Identifier: Apache-2.0
// phalanx device monitor DEVICE: shows its samples as they come. It sends no command.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "commands.h"
#include "device/device_text.h"
#include "phalanx/device/clock.h"
#include "phalanx/record/output_file.h"
#include "phalanx/station/open_device.h"
#include "terminal/end_signals.h"
#include "terminal/error_line.h"
#include "usage.h"

namespace phalanx {
namespace {

constexpr double kLinePeriod = 0.2;    // [s]
constexpr double kFetchPeriod = 0.01;  // [s]

struct MonitorOptions {
  std::string spec;
  std::optional<double> seconds;
  std::string csv;
};

/// File with one row a sample: docs/cli.md.
class SampleCsv {
 public:
  SampleCsv(const std::string& file, const DeviceInfo& info) : out_(file), info_(info) {
    out_.text("received_s,device_us,sequence,state,fault,estop");
    for (std::size_t i = 0; i < info.channels.size(); ++i) out_.text(fmt::format(",raw_{}", i));
    for (std::size_t i = 0; i < info.channels.size(); ++i) {
      const DeviceChannel& channel = info.channels[i];
      std::string name = fmt::format("{}_{}", kind_name(channel.kind), place_name(channel));
      std::replace(name.begin(), name.end(), ' ', '_');
      const std::string_view unit = shown_unit(channel.kind);
      out_.text(unit.empty() ? "," + name : fmt::format(",{}_{}", name, unit));
    }
    out_.text("\n");
  }
  void add(const DeviceSample& sample) {
    out_.number(sample.received);
    out_.text(fmt::format(",{},{},{},{},{}", sample.time_us, sample.sequence, state_name(sample.state),
                          sample.fault == Fault::kNone ? "" : fault_name(sample.fault),
                          sample.estop ? 1 : 0));
    for (std::size_t i = 0; i < info_.channels.size(); ++i) out_.text(fmt::format(",{}", sample.raw[i]));
    for (std::size_t i = 0; i < info_.channels.size(); ++i) {
      out_.text(",");
      out_.number(shown(info_.channels[i], sample.raw[i]));
    }
    out_.text("\n");
  }
  void commit() { out_.commit(); }

 private:
  OutputFile out_;
  const DeviceInfo& info_;
};

void print_channels(const DeviceInfo& info) {
  fmt::print("{}, {:g} Hz. Of each channel: raw (value)\n", info.serial, info.rate_hz);
  for (std::size_t i = 0; i < info.channels.size(); ++i) {
    const DeviceChannel& channel = info.channels[i];
    fmt::print("  {:>2}  {} {} {}\n", i, kind_name(channel.kind), place_name(channel),
               shown_unit(channel.kind));
  }
}

std::string line(double t, double rate, const LinkStatistics& link, const DeviceInfo& info,
                 const std::optional<DeviceSample>& sample) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{:7.2f} s  {:6.1f} Hz  lost {}  late or twice {}  corrupt {}", t, rate, link.lost,
                 link.outdated, link.corrupt);
  if (!sample) {
    fmt::format_to(out, "  no sample yet");
    return fmt::to_string(text);
  }
  fmt::format_to(out, "  {}", state_name(sample->state));
  if (sample->estop) fmt::format_to(out, "  E-STOP");
  if (sample->fault != Fault::kNone) fmt::format_to(out, "  {}", fault_name(sample->fault));
  for (std::size_t i = 0; i < info.channels.size(); ++i) {
    const bool valid = in_range(info.channels[i], sample->raw[i]);
    fmt::format_to(out, " | {} ({:.2f}){}", sample->raw[i], shown(info.channels[i], sample->raw[i]),
                   valid ? "" : "!");
  }
  return fmt::to_string(text);
}

/// Watches until the time is over, Ctrl-C, or the connection fails. @returns the connection's fault.
Fault watch(Device& device, const Clock& clock, const MonitorOptions& options, SampleCsv* csv) {
  std::array<DeviceSample, 512> samples{};
  std::optional<DeviceSample> newest;
  const double begin = clock.now();
  const double end = begin + options.seconds.value_or(std::numeric_limits<double>::infinity());
  double line_at = begin + kLinePeriod;
  double counted_from = begin;
  std::uint64_t counted = device.statistics().received;
  while (clock.now() < end && asked_to_end == 0 && device.connection_fault() == Fault::kNone) {
    clock.sleep_until(clock.now() + kFetchPeriod);
    const std::size_t count = device.receive(clock.now(), samples);
    for (std::size_t i = 0; i < count && csv != nullptr; ++i) csv->add(samples[i]);
    if (count > 0) newest = samples[count - 1];
    const double now = clock.now();
    if (now < line_at) continue;
    const LinkStatistics link = device.statistics();
    const double rate = static_cast<double>(link.received - counted) / (now - counted_from);
    fmt::print("{}\n", line(now - begin, rate, link, device.info(), newest));
    std::fflush(stdout);
    counted = link.received;
    counted_from = now;
    line_at = std::max(line_at + kLinePeriod, now);
  }
  return device.connection_fault();
}

int monitor(const MonitorOptions& options) {
  const Clock clock;
  const auto device = open_device(options.spec, clock);
  device->open();
  end_on_interrupt();
  std::optional<SampleCsv> csv;
  if (!options.csv.empty()) csv.emplace(options.csv, device->info());
  print_channels(device->info());
  const Fault fault = watch(*device, clock, options, csv ? &*csv : nullptr);
  const LinkStatistics link = device->statistics();
  device->close();
  if (csv) csv->commit();
  fmt::print("{} samples, {} lost, {} late or twice, {} corrupt, {} not fetched in time\n", link.received,
             link.lost, link.outdated, link.corrupt, link.overflowed);
  if (fault == Fault::kNone) return kDone;
  print_error_line(fmt::format("phalanx: {}", fault_text(fault)));
  return kFailed;
}

}  // namespace

void add_device_monitor(CLI::App& device, Job& job) {
  auto options = std::make_shared<MonitorOptions>();
  CLI::App* command = device.add_subcommand("monitor", "Watch a device's samples, raw and converted");
  command->footer(
      std::string("DEVICE is one of\n") + kDeviceSpecs +
      "\nValues use the gains and offsets that the device itself states. No command is sent: motors stay "
      "off.\nEnds after --seconds or with Ctrl-C. Exit codes: 0 done, 1 failed, 2 wrong usage.");
  command->add_option("DEVICE", options->spec, "its address")->required()->type_name("");
  command->add_option("--seconds", options->seconds, "end after so long [until Ctrl-C]")
      ->check(CLI::Range(0.0, 1e6))
      ->type_name("N");
  command->add_option("--csv", options->csv, "write every sample into this file")->type_name("FILE");
  command->callback([options, command, &job] {
    refuse_empty_values(*command);
    job = [options] { return monitor(*options); };
  });
}

}  // namespace phalanx
