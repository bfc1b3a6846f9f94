// SPDX-License-Identifier: Apache-2.0
// held_clock [--pace N] [--clock FILE] -- COMMAND ... : runs a command under a held clock.
//   --pace N      at most N times as fast as real time; 0, the default: as fast as it can
//   --clock FILE  the clock's file: commands that name the same one share a clock; one of their launchers
//   moves it. FILE.pace, if it is there, holds another N: a test may slow the clock down where it is slow itself
// Interrupt and termination signals go on to the command; its exit status is the launcher's.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>

#include "support/held_clock/held_clock.h"

namespace {

volatile std::sig_atomic_t child = 0;
void pass_on(int number) {
  if (child > 0) ::kill(child, number);
}

/// The pace of the command line, or that of the file once there is one. The file may be written at any time.
class Pace {
 public:
  Pace(double fallback, const std::string& clock)
      : pace_(fallback), file_(clock.empty() ? "" : clock + ".pace") {}
  double operator()() {
    constexpr unsigned kLooksBetween = 16;
    if (file_.empty() || looks_++ % kLooksBetween != 0) return pace_;
    double read = 0.0;
    if (std::ifstream(file_) >> read && read > 0.0) pace_ = read;
    return pace_;
  }

 private:
  double pace_;
  std::string file_;
  unsigned looks_ = 0;
};

int usage() {
  std::fputs("usage: held_clock [--pace N] [--clock FILE] -- COMMAND ...\n", stderr);
  return 2;
}

}  // namespace

int main(int count, char** arguments) {
  double pace = 0.0;
  std::string file;
  int next = 1;
  for (; next + 1 < count && std::strcmp(arguments[next], "--") != 0; next += 2) {
    const std::string option = arguments[next];
    if (option == "--pace")
      pace = std::atof(arguments[next + 1]);
    else if (option == "--clock")
      file = arguments[next + 1];
    else
      return usage();
  }
  if (next + 1 >= count || std::strcmp(arguments[next], "--") != 0) return usage();

  const auto clock = file.empty() ? std::make_unique<phalanx::test::HeldClock>()
                                  : std::make_unique<phalanx::test::HeldClock>(file);
  const auto environment = clock->environment(PHALANX_HELD_CLOCK_LIBRARY);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) std::signal(number, pass_on);
  const pid_t launcher = ::getpid();
  child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != launcher) ::_exit(127);
    for (const std::string& variable : environment) {
      const auto equals = variable.find('=');
      ::setenv(variable.substr(0, equals).c_str(), variable.c_str() + equals + 1, 1);
    }
    ::execvp(arguments[next + 1], arguments + next + 1);
    std::perror(arguments[next + 1]);
    ::_exit(127);
  }
  if (child < 0) return std::perror("held_clock"), 127;

  // One launcher of a file moves its clock; when that one's command has ended, the next one does.
  const int lock = file.empty() ? -1 : ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  bool moves = file.empty();
  int status = 0;
  const auto ended = [&] { return ::waitpid(child, &status, WNOHANG) == child; };
  const auto ended_or_leading = [&] {
    moves = moves || ::flock(lock, LOCK_EX | LOCK_NB) == 0;
    return moves || ended();
  };
  while (!ended_or_leading()) ::usleep(1000);
  if (moves) clock->run(ended, Pace(pace, file));
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}
