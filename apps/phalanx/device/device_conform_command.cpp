// SPDX-License-Identifier: Apache-2.0
// phalanx device conform DEVICE: tests a controller's firmware against the rules of the link, with no hand in
// the device.
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>

#include "commands.h"
#include "device/conform/conform_report.h"
#include "device/conform/transport_conform_port.h"
#include "phalanx/record/made.h"
#include "phalanx/record/output_file.h"
#include "phalanx/station/open_device.h"
#include "terminal/emphasis.h"
#include "terminal/end_signals.h"
#include "usage.h"

namespace phalanx {
namespace {

constexpr double kMostTorque = 0.1;  // [Nm]

struct DeviceConformOptions {
  std::string spec;
  bool no_hand = false;
  bool list = false;
  ConformSettings settings;
  std::string out;
};

void print_result(const ConformResult& result) {
  const bool colour = takes_colour(STDOUT_FILENO);
  const std::string name(conform_outcome_name(result.finding.outcome));
  const std::string padded = fmt::format("{:<14}", name);
  fmt::print(
      "{} {:<16} {}\n",
      result.finding.outcome == ConformOutcome::kFail ? emphasised(Emphasis::kError, padded, colour) : padded,
      result.row->id, result.finding.observed);
  if (result.finding.outcome == ConformOutcome::kFail)
    fmt::print("{:<14}   requirement: {}\n{:<14}   expected: {}\n", "", result.row->requirement, "",
               result.row->expected);
  std::fflush(stdout);
}

void write_reports(const std::filesystem::path& folder, const ConformReport& report) {
  std::filesystem::create_directories(folder);
  for (const auto& [name, text] :
       {std::pair{"conform.md", conform_markdown(report)}, std::pair{"conform.html", conform_html(report)},
        std::pair{"conform.json", conform_json(report)}}) {
    OutputFile file(folder / name);
    file.text(text);
    file.commit();
    fmt::print("wrote {}\n", (folder / name).string());
  }
}

int conform(DeviceConformOptions& options) {
  if (options.list) {
    fmt::print("{}", conform_table());
    return kDone;
  }
  if (options.spec.empty()) throw std::invalid_argument("device conform: no DEVICE; give its address");
  if (!options.no_hand)
    throw std::invalid_argument(
        "device conform: this test enables the motors and sends damaged commands. Take the hand out of the "
        "device, keep the emergency stop in reach, and state --no-hand-in-device");
  end_on_interrupt();
  std::random_device random;
  options.settings.host_id = (std::uint64_t{random()} << 32U) | (random() & ~1U) | 2U;
  const Clock clock;
  const auto port = open_conform_port(options.spec, open_transport, clock);
  port->interrupted = [] { return asked_to_end != 0; };
  fmt::print("{}: no hand in the device; torques up to {:g} Nm\n", options.spec, options.settings.torque);
  ConformReport report = run_conformance(*port, options.settings, print_result);
  report.address = options.spec;
  report.program = fmt::format("phalanx {} ({})", PHALANX_VERSION, built_from_commit());
  report.date = fmt::format("{:%Y-%m-%d %H:%M}", fmt::localtime(std::time(nullptr)));
  const bool colour = takes_colour(STDOUT_FILENO);
  fmt::print("{}\n",
             emphasised(report.conforms() ? Emphasis::kStrong : Emphasis::kError, report.verdict(), colour));
  if (!options.out.empty()) write_reports(options.out, report);
  return report.conforms() ? kDone : kFailed;
}

}  // namespace

void add_device_conform(CLI::App& device, Job& job) {
  auto options = std::make_shared<DeviceConformOptions>();
  CLI::App* command = device.add_subcommand(
      "conform", "Test a controller's firmware against the link's rules, no hand in the device");
  command->footer(
      "DEVICE is udp:HOST:PORT or serial:PORT[:BAUD]. The motors are enabled, with small torques. The rows "
      "are in\n"
      "docs/conform.md. The session is given up at the end, and at Ctrl-C.\n"
      "Exit codes: 0 the device conforms; 1 it does not, or the test failed; 2 wrong usage.");
  command->add_option("DEVICE", options->spec, "its address")->type_name("");
  command->add_flag("--no-hand-in-device", options->no_hand,
                    "state that no hand is in the device, and that the emergency stop is in reach");
  command->add_option("--torque-nm", options->settings.torque, "largest torque that is commanded")
      ->check(CLI::Range(0.001, kMostTorque))
      ->type_name("T")
      ->capture_default_str();
  command
      ->add_option("--torque-tolerance-nm", options->settings.tolerance,
                   "of a torque that the device measures")
      ->check(CLI::Range(0.0, kMostTorque))
      ->type_name("T")
      ->capture_default_str();
  command
      ->add_option("--out", options->out, "write conform.md, conform.html and conform.json into this folder")
      ->type_name("FOLDER");
  command->add_flag("--list", options->list, "print the rows as a table in Markdown, and end");
  command->callback([options, command, &job] {
    refuse_empty_values(*command);
    job = [options] { return conform(*options); };
  });
}

}  // namespace phalanx
