// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/measured_range.h"

#include <fmt/format.h>

#include <algorithm>

#include "phalanx/core/index.h"
#include "phalanx/device/calibration.h"

namespace phalanx {

void check_range(const MeasuredRange& range, const DeviceInfo& device, const std::string& calibration) {
  if (range.device != device.name || range.serial != device.serial)
    throw CalibrationError(fmt::format(
        "the patient's range was measured on {} {}, this is {} {}; measure it on this device (phalanx device "
        "range)",
        range.device, range.serial, device.name, device.serial));
  if (range.calibration != calibration)
    throw CalibrationError(fmt::format(
        "the patient's range was measured with the calibration of {}, in use is {}; measure the range again",
        range.calibration, calibration.empty() ? "none" : "that of " + calibration));
}

JointRanges with_followers(JointRanges ranges, std::span<const CoupledJoint> coupled) {
  for (const CoupledJoint& follower : coupled) {
    std::optional<AngleRange>& own = ranges[idx(follower.joint)];
    const std::optional<AngleRange>& of = ranges[idx(follower.of)];
    if (own || !of) continue;
    const double a = follower.ratio * of->min + follower.offset;
    const double b = follower.ratio * of->max + follower.offset;
    own = AngleRange{.min = std::min(a, b), .max = std::max(a, b)};
  }
  return ranges;
}

}  // namespace phalanx
