// SPDX-License-Identifier: Apache-2.0
#include "phalanx/step/sample_guard.h"

#include <algorithm>
#include <cmath>

namespace phalanx {

Status SampleGuard::accept(const Sample& sample, const HandParameters& hand, const LimitParameters& limits,
                           double period) noexcept {
  if (!std::isfinite(sample.time_s) || (started_ && sample.time_s <= time_s_))
    return Status::kTimeNotIncreasing;
  started_ = true;
  time_s_ = sample.time_s;

  Status status = Status::kOk;
  const double longest = limits.joint_speed * period;
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
  return status;
}

}  // namespace phalanx
