// SPDX-License-Identifier: Apache-2.0
#include "station/shared_station.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "phalanx/device/posed_device.h"

namespace phalanx {
namespace {

/// Should nobody fetch what they have left, older ones go.
constexpr std::size_t kRetired = 4;
constexpr std::size_t kReports = 16;

/// Joints that the device's channels set; those that follow others are not among them.
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

std::shared_ptr<const HostState> SharedStation::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

std::shared_ptr<RunningStation> SharedStation::current() const {
  const std::lock_guard lock(mutex_);
  return running_;
}

// ---- what people say ----

void SharedStation::hold() noexcept {
  ++stops_;
  held_.store(true);
}

void SharedStation::stop() noexcept {
  const std::lock_guard lock(mutex_);
  hold();
  if (running_) running_->station->stop_torque();
}

bool SharedStation::resume(std::uint64_t stops) noexcept {
  const std::lock_guard lock(mutex_);
  if (stops != stops_ || ending_) return false;
  held_.store(false);
  if (running_) running_->station->resume_torque();
  return true;
}

std::uint64_t SharedStation::stops() const noexcept {
  const std::lock_guard lock(mutex_);
  return stops_;
}

void SharedStation::end() noexcept {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  stop();
}

bool SharedStation::set_sliders(const JointArray& angle) noexcept {
  const std::lock_guard lock(mutex_);
  auto* posed = running_ ? dynamic_cast<PosedDevice*>(running_->device.get()) : nullptr;
  if (posed == nullptr) return false;
  const HandParameters& hand = state_->geometry->hand;
  for (std::size_t j = 0; j < angle.size(); ++j)
    if (std::isfinite(angle[j])) slider_[j] = std::clamp(angle[j], hand.min_angle[j], hand.max_angle[j]);
  posed->pose(slider_);
  return true;
}

JointArray SharedStation::sliders() const {
  const std::lock_guard lock(mutex_);
  return slider_;
}

// ---- the worker's thread ----

void SharedStation::begin(std::shared_ptr<RunningStation> next) {
  const DeviceInfo device = next->device->info();
  const std::vector<int> joints = sensed_joints(device);
  change_state([&](HostState& s) {
    s.device = device;
    s.sensed_joints = joints;
    s.running = true;
    s.trouble.clear();
    s.realtime.clear();
    slider_ = s.geometry->hand.open_angle;
    running_ = next;
    // Before its first step, and under the lock: no stop() falls between two stations, no resume() either.
    if (held_.load()) next->station->stop_torque();
  });
  try {
    next->station->start();
  } catch (...) {
    change_state([&](HostState& s) {
      s.running = false;
      running_ = nullptr;
    });
    throw;
  }
}

void SharedStation::retire() {
  const std::shared_ptr<RunningStation> old = current();
  if (!old) return;
  old->station->shut_down();  // still in sight: its last steps are shown, too
  StationView last = old->station->view();
  last.factor = 0.0;
  last.at_rest = true;
  last.sent = {};
  const DeadlineStatistics deadlines = old->station->deadlines();
  keep_report(*old->station);
  std::shared_ptr<RunningStation> gone;  // freed after the lock
  change_state([&](HostState& s) {
    s.running = false;
    running_ = nullptr;
    last_view_ = last;
    last_deadlines_ = deadlines;
    ended_.add(deadlines, last);
    // A new station knows nothing of the fault: torque comes back by somebody's word only.
    if (last.state == SafetyState::kFault) hold();
    retired_.push_back(old);
    if (retired_.size() <= kRetired) return;
    gone = std::move(retired_.front());
    retired_.pop_front();
  });
}

void SharedStation::lose(const std::string& why) {
  change_state([&](HostState& s) {
    s.trouble = why;
    hold();
  });
}

void SharedStation::keep_report(Station& station) {
  const std::lock_guard lock(reports_mutex_);
  if (auto report = station.take_fault_report()) reports_.push_back(std::move(*report));
  if (reports_.size() > kReports) reports_.pop_front();
}

// ---- what it says ----

StationView SharedStation::view() const {
  if (const auto now = current())
    if (const StationView view = now->station->view(); view.time > 0.0) return view;
  const std::lock_guard lock(mutex_);
  return last_view_;  // also until a new one has made its first step
}

DeadlineStatistics SharedStation::deadlines() const {
  if (const auto now = current())
    if (const DeadlineStatistics of_now = now->station->deadlines(); of_now.steps > 0) return of_now;
  const std::lock_guard lock(mutex_);
  return last_deadlines_;
}

SessionStatistics SharedStation::session() const {
  std::unique_lock lock(mutex_);
  SessionStatistics sum = ended_;
  const std::shared_ptr<RunningStation> now = running_;
  lock.unlock();
  if (now) sum.add(now->station->deadlines(), now->station->view());
  return sum;
}

std::shared_ptr<RunningStation> SharedStation::oldest_retired() const {
  const std::lock_guard lock(mutex_);
  return retired_.empty() ? nullptr : retired_.front();
}

void SharedStation::forget(const std::shared_ptr<RunningStation>& retired) {
  const std::lock_guard lock(mutex_);
  if (!retired_.empty() && retired_.front() == retired) retired_.pop_front();
}

bool SharedStation::next_record(StepRecord& record) {
  while (const auto old = oldest_retired()) {  // ours to free, after the lock
    if (old->station->next_record(record)) return true;
    forget(old);
  }
  const auto now = current();
  return now && now->station->next_record(record);
}

std::optional<FaultReport> SharedStation::take_fault_report() {
  const std::lock_guard lock(reports_mutex_);
  if (!reports_.empty()) {
    FaultReport oldest = std::move(reports_.front());
    reports_.pop_front();
    return oldest;
  }
  const auto now = current();
  return now ? now->station->take_fault_report() : std::nullopt;
}

}  // namespace phalanx
