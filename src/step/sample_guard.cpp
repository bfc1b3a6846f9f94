// SPDX-License-Identifier: Apache-2.0
#include "step/sample_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace phalanx {
namespace {

/// Copies a channel with everything that is not finite turned to NaN; `keep` false: all of it.
template <class Array>
void finite_or_nan(const Array& from, bool keep, Array& to) noexcept {
  for (std::size_t i = 0; i < from.size(); ++i) {
    const bool good = keep && std::isfinite(from[i]);
    to[i] = good ? from[i] + 0.0 : std::numeric_limits<double>::quiet_NaN();  // -0 becomes 0
  }
}

}  // namespace

bool SampleGuard::takes_time(double time_s) noexcept {
  const bool later = std::isfinite(time_s) && (!started_ || time_s > time_s_);
  if (!later) {
    const bool in_order = std::isfinite(time_s) && (refused_ == 0 || time_s > refused_time_s_);
    refused_ = in_order ? refused_ + 1 : 0;
    refused_time_s_ = time_s;
    if (refused_ < kRestartedAfter) return false;
  }
  refused_ = 0;
  started_ = true;
  time_s_ = time_s;
  return true;
}

std::array<bool, kDigits> SampleGuard::measured() const noexcept {
  std::array<bool, kDigits> out{};
  for (std::size_t d = 0; d < kDigits; ++d) {
    out[d] = std::all_of(seen_.begin() + d * kJointsPerDigit, seen_.begin() + (d + 1) * kJointsPerDigit,
                         [](bool seen) { return seen; });
  }
  return out;
}

Status SampleGuard::accept(const Sample& sample, const HandParameters& hand, const LimitParameters& limits,
                           double period) noexcept {
  Status status = Status::kOk;
  bad_for_ += period;
  const double since =
      started_ ? sample.time_s - time_s_ : period;  // NaN and the past become one period below
  if (!takes_time(sample.time_s))
    return Status::kTimeNotIncreasing | (stale() ? Status::kSampleStale : Status::kOk);

  const double longest = limits.joint_speed * std::max(period, std::min(since, kStaleAfter));
  for (std::size_t j = 0; j < kJoints; ++j) {
    const double measured = sample.angle[j];
    if (!std::isfinite(measured)) {
      status |= Status::kSampleNotFinite;
      continue;
    }
    double angle = std::clamp(measured, hand.min_angle[j], hand.max_angle[j]);
    if (angle != measured) status |= Status::kSampleOutOfRange;
    if (seen_[j]) {
      const double slewed = std::clamp(angle, angle_[j] - longest, angle_[j] + longest);
      if (slewed != angle) status |= Status::kSampleJump;
      angle = slewed;
    }
    seen_[j] = true;
    angle_[j] = angle;
  }
  if (!has(status, Status::kSampleNotFinite)) bad_for_ = 0.0;
  if (stale()) status |= Status::kSampleStale;
  return status;
}

void pass_measured(const Sample& sample, Status accepted, Snapshot& snapshot) noexcept {
  const bool keep = !has(accepted, Status::kTimeNotIncreasing);
  finite_or_nan(sample.measured_torque, keep, snapshot.measured_torque);
  finite_or_nan(sample.measured_force, keep, snapshot.measured_force);
  snapshot.angle_origin = sample.angle_origin;
}

}  // namespace phalanx
