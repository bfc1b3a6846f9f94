// SPDX-License-Identifier: Apache-2.0
// The running station and the published information, shared among the threads of a Session.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "phalanx/station/session_statistics.h"
#include "station/station_build.h"

namespace phalanx {

/// State shared by the worker, the owner and readers of a Session. All functions are for any thread, unless
/// stated otherwise. The lock is held for copies only, never while something is built, opened, waited for or
/// freed: stop() never waits for these.
class SessionState {
 public:
  SessionState();

  /// Publishes a changed copy of the information.
  /// @param change  called with the copy, under the lock
  /// @throws std::bad_alloc or what `change` throws; nothing is then published
  template <class Change>
  void change_info(Change&& change) {
    std::shared_ptr<const SessionInfo> gone;  // freed after the lock is released
    const std::lock_guard lock(mutex_);
    auto next = std::make_shared<SessionInfo>(*info_);
    change(*next);
    ++next->revision;
    gone = std::exchange(info_, std::move(next));
  }
  /// Publishes information that was prepared from a copy of info(). Allocates nothing. The worker's thread.
  /// Meanwhile others change nothing but SessionInfo::realtime, which Session::poll() then publishes again.
  void publish(std::shared_ptr<SessionInfo> next) noexcept;
  [[nodiscard]] std::shared_ptr<const SessionInfo> info() const;
  [[nodiscard]] std::shared_ptr<RunningStation> current() const;

  // ---- requests of users
  void stop() noexcept;
  /// Ends the hold that began with stop number `stops`. It does nothing if stops() differs by now.
  /// @returns true if the hold was ended
  bool resume(std::uint64_t stops) noexcept;
  [[nodiscard]] std::uint64_t stops() const noexcept;  ///< rises with every stop and every other hold
  /// Stops for good: from here on resume() does nothing.
  void end() noexcept;
  [[nodiscard]] bool held() const noexcept { return held_.load(); }
  /// Sets the angles of the sliders.
  /// @returns false, with no effect, if sliders do not move the hand of the running station
  [[nodiscard]] bool set_sliders(const JointArray& angle) noexcept;
  [[nodiscard]] JointArray sliders() const;

  // ---- for the worker's thread
  /// Keeps a change for next_change(). @throws std::bad_alloc
  void keep_change(SessionChange change);
  /// Starts the station. If held() is true, its torque is stopped before its first step.
  /// @throws std::system_error if no thread can be made
  void begin(std::shared_ptr<RunningStation> next);
  /// Ramps the running station, if there is one, to zero torque and ends it.
  /// @throws std::bad_alloc; the station then runs on
  void retire();
  /// Records that there is no station and why none could be made. The next station begins held.
  /// @throws std::bad_alloc; the next station begins held, but the reason is not published
  void set_unavailable(const std::string& why);

  // ---- what readers see
  [[nodiscard]] StationView view() const;
  [[nodiscard]] DeadlineStatistics deadlines() const;
  /// @returns sums over all stations so far, the running one included.
  [[nodiscard]] SessionStatistics statistics() const;
  /// Fetches the next step's record. For one thread.
  [[nodiscard]] bool next_record(StepRecord& record, std::vector<DeviceSample>& samples);
  /// Fetches the next change that was kept. @returns true if there was one
  [[nodiscard]] bool next_change(SessionChange& change);
  [[nodiscard]] std::optional<FaultReport> take_fault_report();

 private:
  void keep_report(Station& station) noexcept;  ///< without memory, the station keeps it
  void hold() noexcept;  ///< call it with the lock; makes earlier resume() numbers invalid

  mutable std::mutex mutex_;
  std::shared_ptr<RunningStation> running_;
  std::vector<std::shared_ptr<RunningStation>> retired_;  ///< kept until their records have been fetched
  std::shared_ptr<const SessionInfo> info_ = std::make_shared<SessionInfo>();
  StationView last_view_;
  DeadlineStatistics last_deadlines_;
  SessionStatistics ended_;  ///< sums over the stations that have ended
  JointArray slider_{};      ///< [rad]
  std::atomic<bool> held_{false};
  std::uint64_t stops_ = 0;
  bool ending_ = false;

  std::mutex changes_mutex_;
  std::deque<SessionChange> changes_;

  std::mutex reports_mutex_;          ///< also held while a station's report is taken
  std::vector<FaultReport> reports_;  ///< of stations that have ended
};

}  // namespace phalanx
