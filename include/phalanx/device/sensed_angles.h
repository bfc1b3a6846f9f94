// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/device/exoskeleton.h"

namespace phalanx {

/// What the host is told of a hand at `angle`: the device's own joints as they are, coupled joints and copied
/// digits by those that they follow, all others at the open hand [rad]. Real-time: O(joints), no allocation.
[[nodiscard]] inline JointArray sensed_angles(const Exoskeleton& exoskeleton, const JointArray& open,
                                              const JointArray& angle) noexcept {
  const auto idx = [](int i) { return static_cast<std::size_t>(i); };
  JointArray sensed = open;
  for (const ExoJoint& joint : exoskeleton.joints) sensed[idx(joint.joint)] = angle[idx(joint.joint)];
  for (const CoupledJoint& joint : exoskeleton.coupled)
    sensed[idx(joint.joint)] = joint.ratio * sensed[idx(joint.of)] + joint.offset;
  for (int digit = 0; digit < kDigits; ++digit) {
    const DigitCopy& copy = exoskeleton.controller.copy[idx(digit)];
    if (copy.of < 0) continue;
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const auto from = idx(joint_index(copy.of, i));
      const auto to = idx(joint_index(digit, i));
      sensed[to] = open[to] + copy.gain * (sensed[from] - open[from]);
    }
  }
  return sensed;
}

}  // namespace phalanx
