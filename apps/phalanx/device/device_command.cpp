// SPDX-License-Identifier: Apache-2.0
// phalanx device: commands that test a device, and one that simulates it. Each has a file
// device_*_command.cpp. `device calibrate` and `device range` lead a dialogue, `device test-link` counts round
// trips, and `device conform` tests firmware against the rules of the link. `device simulate` serves a
// controller behind a wire that can have faults.
#include "commands.h"

namespace phalanx {

void add_device_command(CLI::App& app, Job& job) {
  CLI::App* device =
      app.add_subcommand("device", "Look at a device, test its link, calibrate or simulate one");
  device->require_subcommand(1);
  device->footer("`phalanx device COMMAND --help` explains each. What a device must do: docs/device.md.");
  add_device_calibrate(*device, job);
  add_device_range(*device, job);
  add_device_probe(*device, job);
  add_device_monitor(*device, job);
  add_device_test_link(*device, job);
  add_device_conform(*device, job);
  add_device_simulate(*device, job);
}

}  // namespace phalanx
