// SPDX-License-Identifier: Apache-2.0
// `phalanx run` under a clock that the test holds, with a terminal, pipes or files at its ends.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "faults/child_process.h"
#include "record/temporary_folder.h"
#include "support/held_clock/held_clock.h"

namespace phalanx::testing {

/// A descriptor, closed at its end or before.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(other.number_) { other.number_ = -1; }
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }

  [[nodiscard]] int number() const { return number_; }
  void close();

 private:
  int number_ = -1;
};

/// A pipe, or a pseudo-terminal: what is written into one end comes out of the other.
struct Ends {
  Descriptor ours;
  Descriptor theirs;
};
[[nodiscard]] Ends make_terminal(unsigned short columns = 80);
[[nodiscard]] Ends pipe_to_program();
[[nodiscard]] Ends pipe_from_program();

/// A row of `--log`.
struct LoggedStep {
  double time = 0.0;
  std::string state;
  std::string fault;
  double stiffness = 0.0;       ///< [N/m]
  double largest_torque = 0.0;  ///< [Nm]
};
/// @throws std::runtime_error: a row is not whole
[[nodiscard]] std::vector<LoggedStep> read_steps(const std::filesystem::path& log);

/// grasp_teapot, which pushes from its second second on, at 200 Hz; its log is x.csv and its summary x.json.
class RunningStation {
 public:
  static constexpr double kRate = 200.0;

  /// @param folder  of its files. @param arguments  further ones
  /// @param script  of a shell that starts it: "$@"; empty: no shell
  RunningStation(const TemporaryFolder& folder, const Descriptors& descriptors,
                 const std::vector<std::string>& arguments, const std::string& script = {});

  /// Lets so much time pass [s].
  void pass(double seconds) { clock_.advance(seconds); }
  /// Its loop wakes up so much too late from here on [s].
  void delay_loop(double seconds) { clock_.delay_loop(seconds); }
  void signal(int number) { process_->signal(number); }
  [[nodiscard]] bool runs() { return !process_->ended(); }
  /// Lets time pass until it has ended. @returns its exit code, 128 + N after signal N; nothing: it goes on
  std::optional<int> wait();

 private:
  test::HeldClock clock_;
  std::unique_ptr<ChildProcess> process_;
};

/// What has come out of a descriptor and waits there.
[[nodiscard]] std::string read_waiting(const Descriptor& descriptor);
void write_text(const Descriptor& descriptor, const std::string& text);

}  // namespace phalanx::testing
