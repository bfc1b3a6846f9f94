// SPDX-License-Identifier: Apache-2.0
#include "station/session_state.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "phalanx/device/posed_device.h"

namespace phalanx {
namespace {

/// Largest numbers of ended stations and of their reports that wait to be fetched; beyond it, the
/// oldest are dropped.
constexpr std::size_t kRetired = 4;
constexpr std::size_t kReports = 16;

/// Finds the joints that the device's channels set, without those that follow other joints.
std::vector<int> sensed_joints(const DeviceInfo& device) {
  std::vector<int> joints;
  for (const DeviceChannel& channel : device.channels) {
    if (channel.kind == ChannelKind::kAngle) joints.push_back(channel.index);
    if (channel.kind == ChannelKind::kSplay) joints.push_back(joint_index(channel.index, 1));
    if (channel.kind != ChannelKind::kCurl) continue;
    for (const int i : {0, 2, 3}) joints.push_back(joint_index(channel.index, i));
  }
  std::sort(joints.begin(), joints.end());
  return joints;
}

}  // namespace

SessionState::SessionState() {
  retired_.reserve(kRetired + 1);
  reports_.reserve(kReports + 1);
}

void SessionState::publish(std::shared_ptr<SessionInfo> next) noexcept {
  std::shared_ptr<const SessionInfo> gone;  // freed after the lock is released
  const std::lock_guard lock(mutex_);
  next->revision = info_->revision + 1;
  gone = std::exchange(info_, std::move(next));
}

std::shared_ptr<const SessionInfo> SessionState::info() const {
  const std::lock_guard lock(mutex_);
  return info_;
}

std::shared_ptr<RunningStation> SessionState::current() const {
  const std::lock_guard lock(mutex_);
  return running_;
}

// ---- requests of users ----

void SessionState::hold() noexcept {
  ++stops_;
  held_.store(true);
}

void SessionState::stop() noexcept {
  const std::lock_guard lock(mutex_);
  hold();
  if (running_) running_->station->stop_torque();
}

bool SessionState::resume(std::uint64_t stops) noexcept {
  const std::lock_guard lock(mutex_);
  if (stops != stops_ || ending_) return false;
  held_.store(false);
  if (running_) running_->station->resume_torque();
  return true;
}

std::uint64_t SessionState::stops() const noexcept {
  const std::lock_guard lock(mutex_);
  return stops_;
}

void SessionState::end() noexcept {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  stop();
}

bool SessionState::set_sliders(const JointArray& angle) noexcept {
  const std::lock_guard lock(mutex_);
  if (!running_ || running_->sliders == nullptr) return false;
  const HandParameters& hand = info_->geometry->hand;
  for (std::size_t j = 0; j < angle.size(); ++j)
    if (std::isfinite(angle[j])) slider_[j] = std::clamp(angle[j], hand.min_angle[j], hand.max_angle[j]);
  running_->sliders->pose(slider_);
  return true;
}

JointArray SessionState::sliders() const {
  const std::lock_guard lock(mutex_);
  return slider_;
}

// ---- the worker's thread ----

void SessionState::begin(std::shared_ptr<RunningStation> next) {
  const DeviceInfo device = next->device->info();
  const std::vector<int> joints = sensed_joints(device);
  change_info([&](SessionInfo& info) {
    info.device = device;
    info.sensed_joints = joints;
    info.running = true;
    info.trouble.clear();
    info.realtime.clear();
    slider_ = info.geometry->hand.open_angle;
    running_ = next;
    // Under the lock and before the first step, so that no stop() or resume() is lost between two stations.
    if (held_.load()) next->station->stop_torque();
  });
  try {
    next->station->start();
  } catch (...) {
    change_info([&](SessionInfo& info) {
      info.running = false;
      running_ = nullptr;
    });
    throw;
  }
}

void SessionState::retire() {
  const std::shared_ptr<RunningStation> old = current();
  if (!old) return;
  // What needs memory comes first. Until the end below, others change nothing but the grant in it.
  const auto next = std::make_shared<SessionInfo>(*info());
  next->running = false;
  old->station->shut_down();  // still published, so that its last steps are shown
  StationView last = old->station->view();
  last.factor = 0.0;
  last.at_rest = true;
  last.sent = {};
  const DeadlineStatistics deadlines = old->station->deadlines();
  keep_report(*old->station);
  std::shared_ptr<const SessionInfo> before;  // both are freed after the lock is released
  std::shared_ptr<RunningStation> gone;
  std::unique_lock lock(mutex_);
  next->revision = info_->revision + 1;
  before = std::exchange(info_, next);
  running_ = nullptr;
  last_view_ = last;
  last_deadlines_ = deadlines;
  ended_.add(deadlines, last);
  // The new station does not know of the fault: torque comes back only after a resume().
  if (last.state == SafetyState::kFault) hold();
  retired_.push_back(old);
  if (retired_.size() <= kRetired) return;
  gone = std::move(retired_.front());
  retired_.erase(retired_.begin());
  ended_.records_lost += gone->station->records_waiting();
  lock.unlock();
  keep_report(*gone->station);
}

void SessionState::set_unavailable(const std::string& why) {
  {
    const std::lock_guard lock(mutex_);
    hold();  // first, because it needs no memory
  }
  change_info([&](SessionInfo& info) { info.trouble = why; });
}

void SessionState::keep_report(Station& station) noexcept {
  const std::lock_guard lock(reports_mutex_);
  try {
    if (auto report = station.take_fault_report()) reports_.push_back(std::move(*report));
  } catch (const std::bad_alloc&) {
    return;
  }
  if (reports_.size() > kReports) reports_.erase(reports_.begin());
}

// ---- what readers see ----

StationView SessionState::view() const {
  if (const auto now = current())
    if (const StationView view = now->station->view(); view.time > 0.0) return view;
  const std::lock_guard lock(mutex_);
  return last_view_;  // also until a new station has made its first step
}

DeadlineStatistics SessionState::deadlines() const {
  if (const auto now = current())
    if (const DeadlineStatistics of_now = now->station->deadlines(); of_now.steps > 0) return of_now;
  const std::lock_guard lock(mutex_);
  return last_deadlines_;
}

SessionStatistics SessionState::statistics() const {
  std::unique_lock lock(mutex_);
  SessionStatistics sum = ended_;
  const std::shared_ptr<RunningStation> now = running_;
  lock.unlock();
  if (now) sum.add(now->station->deadlines(), now->station->view());
  return sum;
}

bool SessionState::next_record(StepRecord& record, std::vector<DeviceSample>& samples) {
  for (;;) {
    std::unique_lock lock(mutex_);
    if (retired_.empty()) {
      // Under the same lock: this station's records come after those of all that were retired.
      const std::shared_ptr<RunningStation> now = running_;
      lock.unlock();
      return now && now->station->next_record(record, samples);
    }
    if (retired_.front()->station->next_record(record, samples)) return true;
    const std::shared_ptr<RunningStation> read = std::move(retired_.front());
    retired_.erase(retired_.begin());
    lock.unlock();
    keep_report(*read->station);
  }
}

void SessionState::keep_change(SessionChange change) {
  const std::lock_guard lock(changes_mutex_);
  changes_.push_back(std::move(change));
}

bool SessionState::next_change(SessionChange& change) {
  const std::lock_guard lock(changes_mutex_);
  if (changes_.empty()) return false;
  change = std::move(changes_.front());
  changes_.pop_front();
  return true;
}

std::optional<FaultReport> SessionState::take_fault_report() {
  const std::lock_guard lock(reports_mutex_);
  if (!reports_.empty()) {
    FaultReport oldest = std::move(reports_.front());
    reports_.erase(reports_.begin());
    return oldest;
  }
  // A station that ended for want of memory may still hold its report. It is copied without the state's lock.
  std::vector<std::shared_ptr<RunningStation>> ended;
  {
    const std::lock_guard state(mutex_);
    ended = retired_;
  }
  for (const auto& station : ended)
    if (auto report = station->station->take_fault_report()) return report;
  const auto now = current();
  return now ? now->station->take_fault_report() : std::nullopt;
}

}  // namespace phalanx
