// SPDX-License-Identifier: Apache-2.0
#include "faults/child_process.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

#include "record/temporary_folder.h"

namespace phalanx::testing {
namespace {

int create_file(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0) throw std::runtime_error(path.string() + ": " + std::strerror(errno));
  return file;
}

/// In the child, between fork and exec: only calls that are safe there.
[[noreturn]] void become(char* const* arguments, const Descriptors& descriptors) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (descriptors.session) {
    ::setsid();
    ::ioctl(descriptors.input, TIOCSCTTY, 0);
  }
  ::dup2(descriptors.input, STDIN_FILENO);
  ::dup2(descriptors.output, STDOUT_FILENO);
  ::dup2(descriptors.errors, STDERR_FILENO);
  ::execv(arguments[0], arguments);
  ::_exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, std::filesystem::path output)
    : output_(std::move(output)) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe for a child process");
  const int out = create_file(output_);
  const int errors = create_file(output_.string() + ".err");
  input_ = pipe[1];
  start(command, {.input = pipe[0], .output = out, .errors = errors, .session = false});
  ::close(pipe[0]);
  ::close(out);
  ::close(errors);
}

ChildProcess::ChildProcess(const std::vector<std::string>& command, const Descriptors& descriptors) {
  start(command, descriptors);
}

void ChildProcess::start(const std::vector<std::string>& command, const Descriptors& descriptors) {
  std::vector<std::string> copy = command;
  std::vector<char*> arguments;
  for (std::string& text : copy) arguments.push_back(text.data());
  arguments.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ == 0) become(arguments.data(), descriptors);
  if (pid_ < 0) throw std::runtime_error("cannot start a child process");
}

ChildProcess::~ChildProcess() {
  if (!ended()) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  if (input_ >= 0) ::close(input_);
}

void ChildProcess::type(const std::string& line) const {
  const std::string text = line + "\n";
  const ssize_t written = ::write(input_, text.data(), text.size());
  static_cast<void>(written);  // it may have ended; the test sees that by its exit code
}

void ChildProcess::signal(int number) const {
  if (exit_) return;
  ::kill(pid_, number);
  if (number != SIGKILL) return;
  // A thread that sleeps under a held clock counts as asleep while it dies, with its files still open.
  siginfo_t ended{};
  while (::waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOWAIT) != 0 && errno == EINTR) {
  }
}

std::optional<int> ChildProcess::wait(double seconds) {
  const double until = wall_seconds() + seconds;
  while (!exit_) {
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) == pid_) {
      exit_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    } else if (wall_seconds() >= until) {
      break;
    } else {
      sleep_seconds(0.005);
    }
  }
  return exit_;
}

std::string ChildProcess::output() const { return read_file(output_); }
std::string ChildProcess::errors() const { return read_file(output_.string() + ".err"); }

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void sleep_seconds(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

}  // namespace phalanx::testing
