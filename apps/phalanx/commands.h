// SPDX-License-Identifier: Apache-2.0
// The program's commands. Each adds itself, its options and its help to the command line, and puts what it
// will do into `job`, which main() runs once the whole line has been understood.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace phalanx {

/// Exit codes of every command (docs/cli.md).
enum ExitCode : int {
  kDone = 0,        ///< done
  kFailed = 1,      ///< understood, but it failed: disk full, out of memory
  kWrongInput = 2,  ///< wrong usage or input: nothing was done
};

/// Returns an exit code. std::invalid_argument becomes kWrongInput, any other exception kFailed.
using Job = std::function<int()>;

void add_run_command(CLI::App& app, Job& job);
void add_simulate_command(CLI::App& app, Job& job);
void add_experiment_command(CLI::App& app, Job& job);
void add_study_command(CLI::App& app, Job& job);
void add_scene_command(CLI::App& app, Job& job);
void add_hand_command(CLI::App& app, Job& job);
void add_mesh_command(CLI::App& app, Job& job);
void add_device_command(CLI::App& app, Job& job);

}  // namespace phalanx
