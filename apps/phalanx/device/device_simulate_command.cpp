// SPDX-License-Identifier: Apache-2.0
// phalanx device simulate [SCENE]: the simulated exoskeleton's controller as a process of its own.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "device/controller_faults.h"
#include "device/controller_log.h"
#include "device/faulty_wire.h"
#include "device/served_controller.h"
#include "phalanx/device/link/transport.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene_file.h"
#include "phalanx/station/resolved_station.h"
#include "terminal/end_signals.h"
#include "usage.h"

namespace phalanx {
namespace {

struct DeviceSimulateOptions {
  std::string scene = "grasp_teapot";
  std::vector<std::string> set;
  std::string udp = "127.0.0.1:4810";
  bool pty = false;
  std::string serial_number = "simulated";
  std::optional<double> seconds;
  std::string log;
  std::optional<std::uint64_t> seed;
  double slow_motion = 1.0;
  std::vector<std::string> faults;
};

SimulatedDeviceSettings settings_of(const DeviceSimulateOptions& options) {
  Overrides overrides;
  for (const std::string& text : options.set) overrides.push_back(parse_override(text));
  const ResolvedScene scene =
      resolve(SceneFile(options.scene).scene(overrides), {.device = true, .motion = true});
  const auto model = std::make_unique<HapticModel>(build_model(scene));
  SimulatedDeviceSettings settings = simulated_settings(scene, *model);
  settings.seed = options.seed.value_or(scene.description.seed);
  return settings;
}

void check_serial_number(const std::string& serial) {
  const bool printable =
      std::all_of(serial.begin(), serial.end(), [](char c) { return c > ' ' && c <= '~'; });
  if (serial.size() > PHX_SERIAL_SIZE || !printable)
    throw std::invalid_argument(fmt::format(
        "--serial-number {}: the link carries up to {} printable ASCII characters without spaces; shorten it",
        serial, PHX_SERIAL_SIZE));
}

std::vector<ControllerFault> faults_of(const DeviceSimulateOptions& options) {
  std::vector<ControllerFault> faults;
  for (const std::string& text : options.faults) faults.push_back(parse_controller_fault(text));
  return faults;
}

void report(const ServedStatistics& served, const SimulatedController& controller,
            const Transport& transport) {
  const phx_controller& c = controller.controller();
  fmt::print("ended after {:.3f} s: {} ticks, {} late and left out, {} restarts\n", served.seconds,
             served.ticks, served.late, served.restarts);
  fmt::print("frames dropped: {} no frame of the wire, {} corrupt, {} of another session, {} outdated\n",
             transport.dropped(), c.corrupt, c.refused, c.outdated);
}

int simulate_device(const DeviceSimulateOptions& options) {
  for (const std::string& text : options.faults) {
    if (text != "list") continue;
    fmt::print("{}", controller_fault_list());
    return kDone;
  }
  check_serial_number(options.serial_number);
  std::vector<ControllerFault> faults = faults_of(options);
  const SimulatedDeviceSettings settings = settings_of(options);
  SimulatedController controller(settings, options.serial_number, ServedController::new_epoch());
  ControllerFaultPlan plan(std::move(faults), controller.info().channels.size(),
                           settings.exoskeleton.motors.size());
  const std::unique_ptr<Transport> transport = options.pty ? open_pseudo_terminal() : listen_udp(options.udp);
  std::unique_ptr<ControllerLog> log;
  if (!options.log.empty()) log = std::make_unique<ControllerLog>(options.log, controller);
  FaultyWire wire(*transport, settings.seed);
  ServedController served(controller, wire, plan, log.get());

  end_on_signal();
  fmt::print("listening on {}\n", transport->address());
  std::fflush(stdout);
  const Clock clock(options.slow_motion);
  const ServedStatistics statistics = served.serve(clock, *transport, options.seconds, asked_to_end);
  report(statistics, controller, *transport);
  if (log) log->finish();
  if (transport->lost()) throw std::runtime_error("the wire is gone; start the simulated device again");
  return kDone;
}

}  // namespace

void add_device_simulate(CLI::App& device, Job& job) {
  auto options = std::make_shared<DeviceSimulateOptions>();
  CLI::App* command = device.add_subcommand(
      "simulate", "Be the controller of an exoskeleton with a patient who squeezes: link, plant, faults");
  command->footer(
      "Its first line says where it listens; `phalanx run --device ADDRESS` connects to it. It runs until\n"
      "Ctrl-C. Ticks that this computer had no time for are left out and counted.\n"
      "Faults: NAME[=VALUE][@START[+LENGTH]], in seconds since it began; `--fault list` names them.\n"
      "Exit codes: 0 done, 1 failed, 2 wrong usage or input.");
  command->add_option("SCENE", options->scene,
                      "where device, patient and object are from: a name in scenes/ or a .toml file "
                      "[grasp_teapot]");
  CLI::Option* udp = command->add_option("--udp", options->udp, "listen here; port 0 takes any free one")
                         ->type_name("ADDRESS:PORT")
                         ->capture_default_str();
  command->add_flag("--pty", options->pty, "be a serial port: a new pseudo-terminal")->excludes(udp);
  command->add_option("--serial-number", options->serial_number, "of the device, up to 16 characters")
      ->type_name("S")
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "end after so long, on the slowed clock [until Ctrl-C]")
      ->type_name("S")
      ->check(positive());
  command->add_option("--log", options->log, "write a row a tick into this file")->type_name("FILE.csv");
  command->add_option("--seed", options->seed, "of patient, sensors and faults [the scene's]")
      ->type_name("N");
  command
      ->add_option("--slow-motion", options->slow_motion,
                   "let all time pass so many times more slowly, time limits included")
      ->type_name("N")
      ->check(CLI::Range(1.0, 1000.0));
  command->add_option("--fault", options->faults, "break something; repeatable; `list` names what")
      ->type_name("SPEC")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      ->add_option("--set", options->set,
                   "override a scene key, e.g. device.controller.rate_hz=500; repeatable")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->callback([options, command, &job] {
    refuse_empty_values(*command);
    job = [options] { return simulate_device(*options); };
  });
}

}  // namespace phalanx
