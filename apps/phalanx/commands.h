// SPDX-License-Identifier: Apache-2.0
// The program's commands. Each function adds a command with its options and its help to the command line. The
// command stores its work in `job`, which main() runs once the whole line has been parsed.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace phalanx {

/// Exit codes of every command (docs/cli.md).
enum ExitCode : int {
  kDone = 0,        ///< the command did its work
  kFailed = 1,      ///< the input was valid, but the work failed: disk full, out of memory
  kWrongInput = 2,  ///< wrong usage or input: nothing was done
};

/// Work of a command; returns an exit code. main() turns std::invalid_argument into kWrongInput, and any
/// other exception into kFailed.
using Job = std::function<int()>;

void add_run_command(CLI::App& app, Job& job);
void add_simulate_command(CLI::App& app, Job& job);
void add_experiment_command(CLI::App& app, Job& job);
void add_study_command(CLI::App& app, Job& job);
void add_scene_command(CLI::App& app, Job& job);
void add_grasp_command(CLI::App& app, Job& job);
void add_hand_command(CLI::App& app, Job& job);
void add_mesh_command(CLI::App& app, Job& job);
void add_device_command(CLI::App& app, Job& job);
void add_session_command(CLI::App& app, Job& job);
void add_replay_command(CLI::App& app, Job& job);
void add_patient_command(CLI::App& app, Job& job);
void add_account_command(CLI::App& app, Job& job);
void add_exercise_command(CLI::App& app, Job& job);
void add_completion_command(CLI::App& app, Job& job);
void add_manual_command(CLI::App& app, Job& job);

// The commands of `phalanx device`.
void add_device_calibrate(CLI::App& device, Job& job);
void add_device_range(CLI::App& device, Job& job);
void add_device_probe(CLI::App& device, Job& job);
void add_device_monitor(CLI::App& device, Job& job);
void add_device_test_link(CLI::App& device, Job& job);
void add_device_simulate(CLI::App& device, Job& job);
void add_device_conform(CLI::App& device, Job& job);

}  // namespace phalanx
