// SPDX-License-Identifier: Apache-2.0
// phalanx: the command line. Each command is in a file of its own; this one only parses, and maps errors
// to exit codes.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>

#include "commands.h"
#include "phalanx/record/made.h"
#include "run/terminate.h"
#include "terminal/error_line.h"
#include "usage.h"

namespace {

int run(int argc, char** argv) {
  using namespace phalanx;
  CLI::App app("Phalanx: haptic rendering for hand exoskeletons, from joint angles to joint torques.",
               "phalanx");
  app.set_version_flag("--version", fmt::format("phalanx {} ({})", PHALANX_VERSION, built_from_commit()));
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 failed, 2 wrong usage or input.\n`phalanx COMMAND --help` explains a command.");
  Job job;
  add_run_command(app, job);
  add_simulate_command(app, job);
  add_experiment_command(app, job);
  add_study_command(app, job);
  add_grasp_command(app, job);
  add_scene_command(app, job);
  add_hand_command(app, job);
  add_mesh_command(app, job);
  add_device_command(app, job);
  add_session_command(app, job);
  add_replay_command(app, job);
  add_exercise_command(app, job);
  add_patient_command(app, job);
  add_account_command(app, job);
  add_completion_command(app, job);
  add_manual_command(app, job);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked) == 0 ? kDone : kFailed;
  } catch (const CLI::ParseError& error) {
    print_error_line(usage_message(app, error));
    return kWrongInput;
  }
  return job();
}

int run_and_report(int argc, char** argv) {
  using namespace phalanx;
  try {
    return run(argc, argv);
  } catch (const std::invalid_argument& error) {
    print_error_line(fmt::format("phalanx: {}", reason(error)));
    return kWrongInput;
  } catch (const std::bad_alloc&) {
    print_error_line("phalanx: out of memory; ask for fewer ticks (--seconds, --rate-hz) or triangles");
    return kFailed;
  } catch (const std::exception& error) {
    // main() reports a failed write to standard output.
    if (std::ferror(stdout) == 0) print_error_line(fmt::format("phalanx: {}", reason(error)));
    return kFailed;
  }
}

}  // namespace

int main(int argc, char** argv) {
  // If a standard stream is closed, another file must not get its number, and then its lines.
  for (int stream = 0; stream <= 2; ++stream)
    if (::fcntl(stream, F_GETFD) < 0) static_cast<void>(::open("/dev/null", O_RDWR));
  std::set_terminate(phalanx::end_at_once);
  std::signal(SIGXFSZ, SIG_IGN);  // at a file size limit, writing fails instead
  const int code = run_and_report(argc, argv);
  if (code == phalanx::kWrongInput) return code;
  // Only here can a write of buffered output fail: a full disk must not look like success.
  int reason = std::ferror(stdout) != 0 ? errno : 0;
  if (std::fflush(stdout) != 0) {
    reason = errno;
  } else if (std::ferror(stdout) == 0) {
    return code;
  }
  phalanx::print_error_line(fmt::format("phalanx: cannot write to standard output: {}",
                                        reason != 0 ? std::strerror(reason) : "some of it was lost"));
  return phalanx::kFailed;
}
