// SPDX-License-Identifier: Apache-2.0
// The station that runs, and what is said of it, among the threads of a StationHost.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "phalanx/station/session_statistics.h"
#include "station/station_build.h"

namespace phalanx {

/// All functions are for any thread, unless they say otherwise. The lock is held for copies only, never while
/// something is built, opened, waited for or freed: stop() gets through at once.
class SharedStation {
 public:
  template <class Change>
  void change_state(Change&& change) {
    std::shared_ptr<const HostState> gone;  // freed after the lock
    const std::lock_guard lock(mutex_);
    auto next = std::make_shared<HostState>(*state_);
    change(*next);
    ++next->revision;
    gone = std::exchange(state_, std::move(next));
  }
  [[nodiscard]] std::shared_ptr<const HostState> state() const;
  [[nodiscard]] std::shared_ptr<RunningStation> current() const;

  // ---- what people say
  void stop() noexcept;
  /// @param stops  what stops() was when it was said; nothing if it is another now. @returns whether
  bool resume(std::uint64_t stops) noexcept;
  [[nodiscard]] std::uint64_t stops() const noexcept;  ///< rises whenever held() is said anew
  /// As stop(), for good: from here on resume() does nothing.
  void end() noexcept;
  [[nodiscard]] bool held() const noexcept { return held_.load(); }
  /// @returns whether there are sliders to move the hand; nothing is done otherwise
  [[nodiscard]] bool set_sliders(const JointArray& angle) noexcept;
  [[nodiscard]] JointArray sliders() const;

  // ---- the worker's thread
  /// Starts the station; what was said until now, it has heard. @throws std::system_error: no thread
  void begin(std::shared_ptr<RunningStation> next);
  /// The station that runs, if there is one, comes to zero torque and ends.
  void retire();
  /// There is no station, and `why` none could be made: whatever brings one back, it begins held.
  void lose(const std::string& why);

  // ---- what it says
  [[nodiscard]] StationView view() const;
  [[nodiscard]] DeadlineStatistics deadlines() const;
  /// Of all stations so far, the one that runs included.
  [[nodiscard]] SessionStatistics session() const;
  /// One thread.
  [[nodiscard]] bool next_record(StepRecord& record);
  [[nodiscard]] std::optional<FaultReport> take_fault_report();

 private:
  [[nodiscard]] std::shared_ptr<RunningStation> oldest_retired() const;
  void forget(const std::shared_ptr<RunningStation>& retired);
  void keep_report(Station& station);
  void hold() noexcept;  ///< with the lock. A resume() of before means something else from here on

  mutable std::mutex mutex_;
  std::shared_ptr<RunningStation> running_;
  std::deque<std::shared_ptr<RunningStation>> retired_;  ///< until their records have been fetched
  std::shared_ptr<const HostState> state_ = std::make_shared<HostState>();
  StationView last_view_;
  DeadlineStatistics last_deadlines_;
  SessionStatistics ended_;  ///< of the stations that have ended
  JointArray slider_{};      ///< [rad]
  std::atomic<bool> held_{false};
  std::uint64_t stops_ = 0;
  bool ending_ = false;

  std::mutex reports_mutex_;         ///< whoever takes a station's report, too
  std::deque<FaultReport> reports_;  ///< of stations that have ended
};

}  // namespace phalanx
