// SPDX-License-Identifier: Apache-2.0
// phalanx: the command line. One file a command; this one only parses and maps errors to exit codes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "commands.h"
#include "phalanx/record/made.h"
#include "usage.h"

namespace {

int run(int argc, char** argv) {
  using namespace phalanx;
  CLI::App app("Phalanx: a hand that feels virtual objects, from joint angles to joint torques.", "phalanx");
  app.set_version_flag("--version", fmt::format("phalanx {} ({})", PHALANX_VERSION, built_from_commit()));
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 failed, 2 wrong usage or input.\n`phalanx COMMAND --help` explains a command.");
  Job job;
  add_simulate_command(app, job);
  add_experiment_command(app, job);
  add_scene_command(app, job);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked) == 0 ? kDone : kFailed;
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "{}\n", usage_message(app, error));
    return kWrongInput;
  }
  return job();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "phalanx: {}\n", error.what());
    return phalanx::kWrongInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "phalanx: {}\n", error.what());
    return phalanx::kFailed;
  }
}
