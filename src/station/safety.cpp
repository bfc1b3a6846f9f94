// SPDX-License-Identifier: Apache-2.0
#include "station/safety.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "phalanx/core/index.h"

namespace phalanx {
namespace {

/// Longest time that a device may take to become ready after a start or a reset; later, its latch is
/// a fault [s].
constexpr double kDeviceAnswers = 0.5;
/// Longest time that a device may be ready and not act on enabled commands [s]: more than 100
/// repetitions of each.
constexpr double kObeys = 0.2;
/// The step keeps the fingertip limit. A force beyond this multiple of it is an error of the step [-].
constexpr double kForceTolerance = 1.1;
/// An oscillation within this time after the torque began to return from an earlier one is a fault [s].
constexpr double kComesBack = 10.0;
/// Tolerance for sums of periods, which are not exact: far below any period [s].
constexpr double kClock = 1e-9;
/// Change of the force that counts as a swing of an oscillation [N].
constexpr double kSwing = OscillationParameters{}.swing;

/// @returns the sample timeout [s]. A glove without motors may be slower: five of its periods are allowed.
double timeout_of(const SafetySettings& settings, const DeviceInfo& device) {
  return device.renders_torque ? settings.sample_timeout
                               : std::max(settings.sample_timeout, 5.0 / device.rate_hz);
}

/// @returns the cause of a device's latch: kDrive if the device does not name one.
Fault latch_of(const DeviceSample& sample) noexcept {
  return sample.fault == Fault::kNone ? Fault::kDrive : sample.fault;
}

}  // namespace

Safety::Safety(const SafetySettings& settings, const ChannelMap& map, const DeviceInfo& device,
               const HandParameters& hand, std::vector<MotorWitness> witnesses, double period)
    : settings_(settings),
      watch_(settings, map, hand, std::move(witnesses)),
      rate_watch_(settings, device.rate_hz),
      min_(hand.min_angle),
      max_(hand.max_angle),
      period_(period),
      timeout_(timeout_of(settings, device)),
      obeys_within_(device.renders_torque ? kObeys : std::max(kObeys, 5.0 / device.rate_hz)),
      in_step_(device.simulated && !device.own_clock),
      judges_rate_(device.renders_torque && !in_step_),
      may_oscillate_(in_step_ || !device.renders_torque) {
  for (std::size_t j = 0; j < settings.range.size(); ++j) {
    if (!settings.range[j]) continue;
    min_[j] = std::max(min_[j], settings.range[j]->min);
    max_[j] = std::min(max_[j], settings.range[j]->max);
  }
}

// ---- judging ----

void Safety::trip(Fault fault, int channel, double now, bool from_device) noexcept {
  if (fault == Fault::kNone || state_ == SafetyState::kFault) return;
  fault_ = {.fault = fault, .channel = channel, .time = now, .tick = tick_, .from_device = from_device};
  if (fault == Fault::kSampleRate) fault_.rates = rate_watch_.rates();
  state_ = SafetyState::kFault;
  sent_at_fault_ = sent_;
  fault_left_ = 1.0;
  factor_ = 0.0;
}

void Safety::judge_sample(const DeviceSample& sample, double now) noexcept {
  const SensorFinding finding = watch_.judge(sample, sent_, sent_force_);
  heard_ = true;
  last_ = sample;
  if (sample.estop) trip(Fault::kEmergencyStop, -1, now, true);
  trip(finding.fault, finding.channel, now);
  if (judges_rate_) rate_watch_.take(sample);
  if (!rate_watch_.good()) trip(Fault::kSampleRate, -1, now);
  // Right after a reset, the device's samples still show the latch that is being cleared.
  if (sample.state == DeviceState::kLatched && now >= answers_until_)
    trip(latch_of(sample), sample.fault_channel, now, true);
}

void Safety::observe(std::span<const DeviceSample> samples, Fault connection, bool late,
                     double now) noexcept {
  ++tick_;
  if (waiting_since_ < 0.0) {
    waiting_since_ = now;
    answers_until_ = now + kDeviceAnswers;
  }
  // Right after a reset the connection may still be mending.
  if (now >= answers_until_) trip(connection, -1, now);
  for (const DeviceSample& sample : samples) judge_sample(sample, now);
  silence_ = samples.empty() ? silence_ + period_ : 0.0;
  const double patience = heard_ ? timeout_ : std::max(timeout_, kDeviceAnswers);
  if (silent_for(now) >= patience - kClock) trip(Fault::kNoSample, -1, now);
  late_in_a_row_ = late ? late_in_a_row_ + 1 : 0;
  if (late_in_a_row_ >= settings_.overruns) trip(Fault::kOverload, -1, now);
}

/// @returns the time since the newest sample, or since waiting for the first one began [s].
double Safety::silent_for(double now) const noexcept {
  if (in_step_) return silence_;
  return now - (heard_ ? last_.received : waiting_since_);
}

/// Checks the step's result for errors. The negated comparison also catches NaN.
void Safety::judge_step(const Snapshot& snapshot, double now) noexcept {
  const double most = std::min(kForceNever, kForceTolerance * settings_.fingertip_force);
  if (has(snapshot.status, Status::kCommandNotFinite)) trip(Fault::kCommandNotFinite, -1, now);
  for (int digit = 0; digit < kDigits; ++digit) {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const SegmentSnapshot& segment = snapshot.segment[idx(segment_index(digit, k))];
      sum += segment.force * segment.normal;
      if (!(std::abs(segment.force) <= most)) trip(Fault::kForceCeiling, -1, now);
    }
    sent_force_[idx(digit)] = factor_ * sum.norm();
    if (!(sum.norm() <= most)) trip(Fault::kForceCeiling, -1, now);
  }
  for (const double torque : snapshot.torque)
    if (!std::isfinite(torque)) trip(Fault::kCommandNotFinite, -1, now);
}

/// Checks that the device acts on enabled commands. If it stays at rest, it rejects them as old or
/// as another host's.
void Safety::judge_obedience(double now) noexcept {
  const bool asked = state_ == SafetyState::kStarting || state_ == SafetyState::kRunning;
  const bool acts = last_.state == DeviceState::kStarting || last_.state == DeviceState::kActive ||
                    last_.state == DeviceState::kFading;
  ignored_for_ = asked && !acts ? ignored_for_ + period_ : 0.0;
  if (ignored_for_ >= obeys_within_) trip(Fault::kNotActing, -1, now);
}

/// Reacts to an oscillation, which feeds energy into the hand. The first one fades the torque as stop() does.
/// The torque returns over the start ramp once the observers are quiet. Another one soon after that
/// is a fault.
void Safety::judge_oscillation(const Snapshot& snapshot, double now) noexcept {
  if (may_oscillate_) return;
  oscillates_ = false;
  for (std::size_t s = 0; s < kSegments; ++s) {
    observer_[s].watch(factor_ * snapshot.segment[s].force, kSwing, period_);
    oscillates_ = oscillates_ || observer_[s].oscillating();
  }
  if (!oscillates_ || (state_ != SafetyState::kStarting && state_ != SafetyState::kRunning)) return;
  after_oscillation_ = true;
  if (now - returned_ <= kComesBack) return trip(Fault::kOscillation, -1, now);
  state_ = SafetyState::kStopping;
}

// ---- ramps ----

void Safety::advance(double now) noexcept {
  const bool ready = heard_ && last_.state != DeviceState::kConnecting &&
                     last_.state != DeviceState::kLatched && watch_.all_good() && !oscillates_;
  if (state_ == SafetyState::kWaiting && ready) {
    state_ = held_ ? SafetyState::kStopped : SafetyState::kStarting;
    if (!held_ && std::exchange(after_oscillation_, false)) returned_ = now;
  }
  if (state_ == SafetyState::kStarting) {
    factor_ = std::min(1.0, factor_ + period_ / settings_.start_ramp);
    if (factor_ >= 1.0) state_ = SafetyState::kRunning;
  }
  if (state_ == SafetyState::kStopping) {
    factor_ = std::max(0.0, factor_ - period_ / settings_.stop_ramp);
    if (factor_ <= 0.0 && at_rest_) state_ = held_ ? SafetyState::kStopped : SafetyState::kWaiting;
  }
  if (state_ == SafetyState::kFault) ramp_to_zero_after_fault(now);
}

/// Lowers the torque after a fault. If steps come late, the clock counts: a slow loop does not
/// lengthen the ramp.
void Safety::ramp_to_zero_after_fault(double now) noexcept {
  const double nominal = fault_left_ - period_ / settings_.fault_ramp;
  const double by_clock = 1.0 - (now - fault_.time) / settings_.fault_ramp;
  const double left = std::min(nominal, by_clock);
  fault_left_ = left > kClock ? left : 0.0;
}

/// @returns the factor on a torque that pushes the joint outward: 1 inside the patient's range of motion,
/// falling to 0 at its end and beyond.
double Safety::outward_factor(std::size_t joint, double angle, double torque) const noexcept {
  const double left = torque > 0.0 ? max_[joint] - angle : angle - min_[joint];
  return std::clamp(left / settings_.range_taper, 0.0, 1.0);
}

/// @returns the smaller of both directions' factors.
double Safety::outward_room(const Snapshot& snapshot, std::size_t joint) const noexcept {
  const double angle = snapshot.hcp_angle[joint];
  return std::min(outward_factor(joint, angle, 1.0), outward_factor(joint, angle, -1.0));
}

/// @returns the step's torque, tapered at the end of the range, limited, times the ramp's factor [Nm].
double Safety::wanted(const Snapshot& snapshot, std::size_t joint) const noexcept {
  const double torque = snapshot.torque[joint];
  const double inside = torque * outward_factor(joint, snapshot.hcp_angle[joint], torque);
  return factor_ * std::clamp(inside, -settings_.joint_torque, settings_.joint_torque);
}

void Safety::command(const Snapshot& snapshot, const DeviceSample& used, double now,
                     DeviceCommand& out) noexcept {
  judge_step(snapshot, now);
  judge_obedience(now);
  judge_oscillation(snapshot, now);
  advance(now);
  at_rest_ = true;
  const double change = settings_.torque_rate * period_;
  for (std::size_t j = 0; j < sent_.size(); ++j) {
    double torque = 0.0;
    if (state_ == SafetyState::kFault) {
      torque = fault_left_ * sent_at_fault_[j];
    } else {
      torque = std::clamp(wanted(snapshot, j), sent_[j] - change, sent_[j] + change);
    }
    sent_[j] = std::isfinite(torque) ? torque : 0.0;
    at_rest_ = at_rest_ && sent_[j] == 0.0;
  }
  const bool moving = state_ == SafetyState::kStarting || state_ == SafetyState::kRunning ||
                      state_ == SafetyState::kStopping || (state_ == SafetyState::kFault && !at_rest_);
  out.tick = tick_;
  out.sample_time_us = used.time_us;
  out.enable = moving;
  out.fault = state_ == SafetyState::kFault;
  out.torque = sent_;
  out.hcp_angle = snapshot.hcp_angle;
  out.gdp_angle = snapshot.gdp_angle;
  for (int digit = 0; digit < kDigits; ++digit) {
    bool stopped = false;
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      stopped = stopped || snapshot.segment[idx(segment_index(digit, k))].contact;
    out.stopped[idx(digit)] = stopped && moving && state_ != SafetyState::kFault;
  }
  choose_walls(snapshot, out);
}

/// Passes the local walls on. A wall is a force that the gate does not see. It is sent only in kRunning, and
/// only if the gate has not changed a torque.
void Safety::choose_walls(const Snapshot& snapshot, DeviceCommand& out) const noexcept {
  out.wall_valid_for = state_ == SafetyState::kRunning ? snapshot.wall_valid_for : 0.0;
  if (out.wall_valid_for <= 0.0) return;
  out.wall = snapshot.wall;
  for (std::size_t j = 0; j < sent_.size(); ++j) {
    if (sent_[j] == snapshot.torque[j] && outward_room(snapshot, j) >= 1.0) continue;
    const int digit = digit_of_joint(static_cast<int>(j));
    for (int k = 0; k < kSegmentsPerDigit; ++k) out.wall[idx(segment_index(digit, k))].active = false;
  }
}

// ---- requests ----

void Safety::start() noexcept {
  held_ = false;
  if (state_ == SafetyState::kStopping && oscillates_) return;  // the fade ends first
  if (state_ == SafetyState::kStopping && factor_ > 0.0) {
    state_ = SafetyState::kStarting;
  } else if (state_ == SafetyState::kStopping || state_ == SafetyState::kStopped) {
    state_ = SafetyState::kWaiting;
  }
}

void Safety::stop() noexcept {
  held_ = true;
  if (state_ != SafetyState::kFault && state_ != SafetyState::kStopped) state_ = SafetyState::kStopping;
}

bool Safety::cause_gone(double now) const noexcept {
  return heard_ && silent_for(now) <= timeout_ && watch_.all_good() && rate_watch_.good() && !last_.estop;
}

bool Safety::reset(Fault connection, double now) noexcept {
  if (state_ != SafetyState::kFault || !at_rest_) return false;
  // Without a connection there are no samples to judge: connect again, and wait.
  const bool no_samples = connection != Fault::kNone || fault_.fault == Fault::kNoSample;
  if (!no_samples && !cause_gone(now)) return false;
  state_ = SafetyState::kWaiting;
  waiting_since_ = now;
  answers_until_ = now + kDeviceAnswers;
  fault_ = {};
  factor_ = 0.0;
  late_in_a_row_ = 0;
  heard_ = false;
  ignored_for_ = 0.0;
  silence_ = 0.0;
  watch_.forget();
  rate_watch_.forget();
  return true;
}

}  // namespace phalanx
