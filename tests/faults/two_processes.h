// SPDX-License-Identifier: Apache-2.0
// A scenario: `phalanx device simulate` and `phalanx run` as two processes with a wire between them, and what
// happens to them at which time of the controller. Both run under a clock that the test holds.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "faults/child_process.h"
#include "faults/station_logs.h"
#include "faults/udp_middle.h"
#include "record/temporary_folder.h"
#include "support/held_clock/held_clock.h"

namespace phalanx::testing {

class TwoProcesses;

/// What the test does at a time of the controller's process [s].
struct Event {
  double at = 0.0;
  std::function<void(TwoProcesses&)> act = {};
};

struct Scenario {
  std::vector<std::string> controller = {};  ///< further arguments
  std::vector<std::string> host = {};        ///< further arguments
  std::vector<std::string> both = {};        ///< further arguments
  bool pty = false;                          ///< a pseudo-terminal is the wire; else UDP
  std::string glove_watchdog_ms = {};        ///< glove_program stands in the controller's place; empty: no
  bool middle = false;                       ///< UDP with the test in the middle
  bool conform = false;                      ///< `phalanx device conform` stands in the host's place
  std::vector<Event> events = {};            ///< in order
  std::string scene = "grasp_teapot";        ///< of both processes
  double seconds = 4.2;                      ///< then the host is asked to end, then the controller
};

/// Everything that a scenario leaves.
struct Outcome {
  std::string problem;  ///< why there is nothing else; empty: it went to its end
  StationLogs logs;
  std::string controller_output, controller_errors;
  std::string host_output, host_errors;
  std::optional<int> controller_exit, host_exit;
  std::string summary;              ///< JSON of the host
  std::vector<std::string> faults;  ///< named in the host's fault reports, in order of their folders' names
  std::vector<std::string> notes;   ///< what an event wrote down
  std::uint64_t sent_to_controller = 0, sent_to_host = 0;  ///< foreign frames that an event counted
};

class TwoProcesses {
 public:
  /// Starts the controller, waits until it listens, starts the host. @throws std::runtime_error
  explicit TwoProcesses(const Scenario& scenario);

  /// Acts at the events' times, ends both and gathers what they left. @throws std::runtime_error
  [[nodiscard]] Outcome go();

  [[nodiscard]] ChildProcess& host() { return *host_; }
  [[nodiscard]] ChildProcess& controller() { return *controller_; }
  [[nodiscard]] UdpMiddle& middle() { return *middle_; }
  [[nodiscard]] Outcome& outcome() { return outcome_; }
  /// What the host connects to: "udp:127.0.0.1:4810", "serial:/dev/pts/3".
  [[nodiscard]] const std::string& address() const { return address_; }
  [[nodiscard]] std::uint16_t controller_port() const { return controller_port_; }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  /// Lets so much time pass [s].
  void pass(double seconds) { clock_.advance(seconds); }
  /// The host's loop wakes up so much too late from here on [s].
  void delay_loop(double seconds) { clock_.delay_loop(seconds); }
  /// Starts a further program under the same clock. @throws std::runtime_error
  [[nodiscard]] std::unique_ptr<ChildProcess> start(const std::vector<std::string>& command,
                                                    const std::string& output);
  /// Lets time pass until the program has ended. @returns its exit status; nothing: it goes on after a minute
  /// of the clock and, that standing still, four real ones
  std::optional<int> wait_for(ChildProcess& process);

 private:
  [[nodiscard]] std::vector<std::string> device_command() const;
  void start_controller();
  void start_host();
  void gather();
  [[nodiscard]] double now() const;

  const Scenario& scenario_;
  TemporaryFolder folder_;
  test::HeldClock clock_;
  std::unique_ptr<ChildProcess> controller_;
  std::unique_ptr<UdpMiddle> middle_;
  std::unique_ptr<ChildProcess> host_;
  std::string address_;
  std::uint16_t controller_port_ = 0;
  double begin_ = 0.0;
  Outcome outcome_;
};

/// Path of the program under test: PHALANX_PROGRAM of the environment, else the build's own.
[[nodiscard]] std::string program();

}  // namespace phalanx::testing
