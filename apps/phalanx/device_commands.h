// SPDX-License-Identifier: Apache-2.0
// The subcommands of `phalanx device`; each is in a file of its name.
#pragma once

#include "commands.h"

namespace phalanx {

void add_device_probe(CLI::App& device, Job& job);
void add_device_monitor(CLI::App& device, Job& job);
void add_device_test_link(CLI::App& device, Job& job);
void add_device_simulate(CLI::App& device, Job& job);
void add_device_calibrate(CLI::App& device, Job& job);

}  // namespace phalanx
