// SPDX-License-Identifier: Apache-2.0
// Programs under one clock that the test holds, so that something can happen to them at a chosen time.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "faults/child_process.h"
#include "support/held_clock/held_clock.h"

namespace phalanx::testing {

/// Programs that run beside the test. Time passes only while the test lets it.
class HeldPrograms {
 public:
  /// @param folder       working folder of the programs, and the folder of what they write
  /// @param environment  further "NAME=VALUE"
  HeldPrograms(std::filesystem::path folder, std::vector<std::string> environment);

  /// Starts a program, and waits until it is under the clock.
  /// @param command  the program and its arguments
  /// @param output   file of its standard output
  /// @throws std::runtime_error if it does not begin
  [[nodiscard]] std::unique_ptr<ChildProcess> start(const std::vector<std::string>& command,
                                                    const std::string& output);
  /// Starts `phalanx device simulate` on a port of its own choice, or on a given one.
  /// @param port  "0": any
  /// @throws std::runtime_error if it does not listen
  [[nodiscard]] std::unique_ptr<ChildProcess> start_device(const std::string& output,
                                                           const std::string& port = "0",
                                                           const std::vector<std::string>& more = {});
  /// @returns where the newest device listens: "udp:127.0.0.1:4810"
  [[nodiscard]] const std::string& address() const { return address_; }
  /// @returns its port
  [[nodiscard]] std::string port() const { return address_.substr(address_.rfind(':') + 1); }

  /// @returns the time since the first program began [s]
  [[nodiscard]] double now() const { return clock_.now(); }
  void pass(double seconds) { clock_.advance(seconds); }
  /// Lets time pass until a condition holds. @returns false: it did not within so many seconds of the clock
  [[nodiscard]] bool pass_until(const std::function<bool()>& holds, double seconds);
  /// Lets time pass until the program has written a text, or has ended. @returns whether it has written it
  [[nodiscard]] bool says(ChildProcess& process, const std::string& text, double seconds);
  /// Lets time pass until the program has ended. @returns its exit code, 128 + N after signal N; nothing:
  /// it goes on
  [[nodiscard]] std::optional<int> wait(ChildProcess& process, double seconds);

 private:
  std::filesystem::path folder_;
  std::vector<std::string> environment_;
  test::HeldClock clock_;
  std::string address_;
};

}  // namespace phalanx::testing
