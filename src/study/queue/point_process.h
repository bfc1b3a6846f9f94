// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "device/descriptor.h"
#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// Answer of a process: a point's result, or why its trial threw.
struct PointAnswer {
  int index = 0;
  double seconds = 0.0;  ///< time that it took [s]
  bool failed = false;
  bool inputs_changed = false;  ///< why it failed (InputsChanged): the process must measure no further point
  std::string text;             ///< result_line() without its end, or the reason
};

/// A forked process that measures points, one after the other, on one thread. If a trial crashes, that process ends
/// and this one goes on. It ends with this object, and with the process that made it.
class PointProcess {
 public:
  /// @throws std::system_error if the system has no process or descriptor left
  PointProcess(const Study& study, const TrialFunction& trial);
  ~PointProcess();
  PointProcess(const PointProcess&) = delete;
  PointProcess& operator=(const PointProcess&) = delete;

  /// Gives it a further point. A process that has ended takes it, too: read() reports the end.
  void give(int index);
  /// @returns points without an answer, in order; it measures the first one.
  [[nodiscard]] const std::deque<int>& pending() const noexcept { return pending_; }

  /// Counts `passed_s` [s] as time of pending().front(), and ends the process if that is above `limit_s` [s]. read()
  /// reports the end.
  void pass(double passed_s, double limit_s);
  /// @returns true if pass() ended the process, and the point that took too long has an answer all the same: no
  /// point failed. @pre ended()
  [[nodiscard]] bool ended_for_nothing() const noexcept {
    return too_long_ && (pending_.empty() || pending_.front() != *too_long_);
  }

  /// @returns the answers so far; never waits.
  [[nodiscard]] std::vector<PointAnswer> read();
  /// @returns whether read() has seen the end of the process.
  [[nodiscard]] bool ended() const noexcept { return ended_; }
  /// Describes the end: signal or exit code, and the last that it wrote while it measured pending().front().
  /// @pre ended()
  [[nodiscard]] std::string how_it_ended();

  /// Descriptors to wait for.
  [[nodiscard]] int answers() const noexcept { return answers_.value(); }
  [[nodiscard]] int log() const noexcept { return log_.value(); }

 private:
  [[noreturn]] static void serve(const Study& study, const TrialFunction& trial, int requests,
                                 int log) noexcept;
  void read_log();
  void reap() noexcept;

  Descriptor answers_;
  Descriptor log_;
  pid_t process_ = -1;
  int status_ = 0;
  bool ended_ = false;
  std::deque<int> pending_;
  double front_s_ = 0.0;         ///< time of pending_.front() [s]
  std::optional<int> too_long_;  ///< point for which pass() ended the process
  double limit_s_ = 0.0;         ///< that it exceeded [s]
  std::string received_;
  std::string log_text_;
};

}  // namespace phalanx
