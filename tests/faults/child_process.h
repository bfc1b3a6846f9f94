// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace phalanx::testing {

/// What a program gets as standard input, output and error.
struct Descriptors {
  int input = -1;
  int output = -1;
  int errors = -1;
  bool session = false;  ///< the input is a terminal: that of a session of its own, hung up with it
};

/// A program that runs beside the test: its standard output and error go to files, its standard input is a
/// pipe; or all three are the test's own. It dies with this object, and with the thread that made it.
class ChildProcess {
 public:
  /// @param command  the program's path and its arguments
  /// @param output   its standard output; standard error goes to output + ".err"
  /// @throws std::runtime_error if it cannot be started
  ChildProcess(const std::vector<std::string>& command, std::filesystem::path output);
  /// @param descriptors  stay open here, too; type(), output() and errors() are of no use then
  ChildProcess(const std::vector<std::string>& command, const Descriptors& descriptors);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Writes a line to its standard input; nothing happens if it has ended.
  void type(const std::string& line) const;
  /// SIGKILL returns when it has ended.
  void signal(int number) const;
  /// Waits for its end. @returns its exit code, 128 + N after signal N; empty: it still ran after `seconds`
  std::optional<int> wait(double seconds);
  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] bool ended() { return wait(0.0).has_value(); }

  /// What it has written so far.
  [[nodiscard]] std::string output() const;
  [[nodiscard]] std::string errors() const;

 private:
  void start(const std::vector<std::string>& command, const Descriptors& descriptors);

  std::filesystem::path output_;
  pid_t pid_ = -1;
  int input_ = -1;
  std::optional<int> exit_;
};

/// Seconds of a clock that only goes forward.
[[nodiscard]] double wall_seconds();
void sleep_seconds(double seconds);

}  // namespace phalanx::testing
