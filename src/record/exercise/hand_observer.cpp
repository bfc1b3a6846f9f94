// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/hand_observer.h"

#include <algorithm>
#include <cmath>

#include "phalanx/core/index.h"

namespace phalanx {
namespace {

constexpr double kMicrosecond = 1e-6;   ///< [s]
constexpr double kMostIntervals = 2.5;  ///< between samples, for a step that is scored
constexpr std::uint32_t kMostCounted =
    1'000;  ///< samples between two steps; a larger number is another count

bool all_finite(const Observation& o) noexcept {
  const auto finite = [](double value) { return std::isfinite(value); };
  return std::isfinite(o.time) && std::isfinite(o.factor) && std::isfinite(o.stiffness) &&
         std::all_of(o.angle.begin(), o.angle.end(), finite) &&
         std::all_of(o.force.begin(), o.force.end(), finite);
}

bool sends_torque(SafetyState state) noexcept {
  return state == SafetyState::kStarting || state == SafetyState::kRunning || state == SafetyState::kStopping;
}

}  // namespace

Observation HandObserver::observe(const StepRecord& record) noexcept {
  const double now = record.input.time;
  if (first_) begin_ = now;
  if (record.station != station_) {
    heard_ = false;
    intervals_ = 0;
    most_age_ = kMostAge;
    sample_time_ = std::numeric_limits<double>::quiet_NaN();
  }
  if (record.samples > 0) hear(record, now - begin_);
  Observation out;
  out.sample_time = sample_time_;
  out.time = now - begin_;
  out.tick = record.command.tick;
  out.factor = record.factor;
  out.torque_on = sends_torque(record.state) && record.factor > 0.0;
  out.angle = record.angle;
  out.angle_origin = record.angle_origin;
  out.stiffness = record.stiffness;
  out.measured_force = record.measured_force;
  out.touching = record.touching;
  out.slips = record.slips;
  out.sent_stiffness = record.sent_stiffness;
  out.depth = record.depth;
  for (int digit = 0; digit < kDigits; ++digit) {
    const auto& pad = record.pad[idx(digit)];
    out.pad[idx(digit)] = Vec3(pad[0], pad[1], pad[2]);
    out.force[idx(digit)] = record.force[idx(digit)] * record.sent_share[idx(digit)];
  }
  out.fault = fault_of(record, out);
  first_ = false;
  gap_ = false;
  station_ = record.station;
  tick_ = record.command.tick;
  time_ = out.time;
  return out;
}

/// Takes in a step with new samples, of which it knows the newest.
void HandObserver::hear(const StepRecord& record, double time) noexcept {
  if (!heard_) {
    first_us_ = record.sample_time_us;
    first_heard_ = time;
  } else if (record.sample_time_us > newest_us_) {
    // Lost samples count: the sequence numbers have them. A device that restarts begins to count again.
    const std::uint32_t counted = record.sample_sequence - sequence_;
    const std::uint32_t number = counted > 0 && counted < kMostCounted ? counted : record.samples;
    note_interval(kMicrosecond * static_cast<double>(record.sample_time_us - newest_us_) / number);
  }
  heard_ = true;
  heard_at_ = record.input.time;
  newest_us_ = record.sample_time_us;
  sequence_ = record.sample_sequence;
  sample_time_ =
      first_heard_ + kMicrosecond * static_cast<double>(static_cast<std::int64_t>(newest_us_ - first_us_));
}

void HandObserver::note_interval(double interval) noexcept {
  interval_[intervals_++ % interval_.size()] = interval;
  if (intervals_ < interval_.size()) return;
  auto sorted = interval_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  most_age_ = std::clamp(kMostIntervals * *middle, kLeastLimit, kMostAge);
}

ObservationFault HandObserver::fault_of(const StepRecord& record, const Observation& out) const noexcept {
  if (!all_finite(out)) return ObservationFault::kNotFinite;
  const bool same_station = record.station == station_;
  if (gap_ || (!first_ && same_station && record.command.tick != tick_ + 1)) return ObservationFault::kGap;
  if (!first_ && !(out.time > time_)) return ObservationFault::kGap;
  if (record.state == SafetyState::kFault) return ObservationFault::kFault;
  if (!heard_ || record.input.time - heard_at_ > most_age_) return ObservationFault::kNoSample;
  return ObservationFault::kNone;
}

}  // namespace phalanx
