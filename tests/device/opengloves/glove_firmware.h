// SPDX-License-Identifier: Apache-2.0
// A glove without a glove: a thread that behaves as LucidGloves' firmware does, at its end of a
// pseudo-terminal.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace phalanx::test {

/// Loop of the firmware with force feedback: sends its line, then waits for a line of the host before it goes
/// on. While it says nothing, it only listens.
class GloveFirmware {
 public:
  /// @param line  what it sends at every loop, without the line end; empty: nothing
  explicit GloveFirmware(std::string line);
  GloveFirmware(const GloveFirmware&) = delete;
  GloveFirmware& operator=(const GloveFirmware&) = delete;
  ~GloveFirmware();

  /// The host's end: a name to open, or a descriptor of the caller's own.
  [[nodiscard]] const std::string& port() const { return port_; }
  [[nodiscard]] int host_descriptor() const;

  /// What it sends from the next loop on.
  void say(std::string line);
  /// Goes out once before the next line, as it is; no answer is waited for.
  void blurt(std::string bytes);
  /// Its cable is pulled: the end of this firmware.
  void unplug();

  [[nodiscard]] int lines_sent() const { return lines_sent_; }
  /// Host's lines that were not empty, in order.
  [[nodiscard]] std::vector<std::string> answers() const;
  [[nodiscard]] std::string last_answer() const;
  /// Host's lines that were empty.
  [[nodiscard]] std::size_t newlines() const;
  /// Waits until the host has sent so many more of these; false: it did not within 5 minutes.
  [[nodiscard]] bool wait_for_answers(std::size_t more);
  [[nodiscard]] bool wait_for_newlines(std::size_t more);
  /// Waits until an answer is this one.
  [[nodiscard]] bool wait_for_answer(const std::string& answer);

 private:
  void run();
  void listen(bool until_a_line);
  void write_all(const std::string& bytes);
  template <class Condition>
  bool wait_until(Condition condition);

  int master_ = -1;
  int slave_ = -1;  ///< held open, so that the terminal lives while no host is there
  std::string port_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::string line_;
  std::string blurted_;
  std::vector<std::string> answers_;
  std::size_t newlines_ = 0;
  std::string heard_;  ///< of a host's line that has not ended
  std::atomic<int> lines_sent_{0};
  std::atomic<bool> quit_{false};
  std::thread thread_;
};

}  // namespace phalanx::test
