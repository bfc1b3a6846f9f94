// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/pad.h"

#include "phalanx/core/index.h"

namespace phalanx {
namespace {

constexpr int kDistal = kSegmentsPerDigit - 1;  // number of the distal segment within a digit

}  // namespace

Vec3 pad_in_segment(const HandParameters& hand, int digit) noexcept {
  const SegmentShape& shape = hand.segments[idx(segment_index(digit, kDistal))];
  return {0.0, -0.5 * (shape.radius_base + shape.radius_tip), -0.5 * shape.length};
}

Vec3 pad_in_world(const HandParameters& hand, int digit, const Pose& X_WS) noexcept {
  return X_WS * pad_in_segment(hand, digit);
}

Vec3 pad_at(const HandModel& hand, int digit, const DigitAngles& angle) noexcept {
  DigitPose pose;
  hand.digit_pose(digit, angle, pose);
  return pad_in_world(hand.parameters(), digit, pose.segment[idx(kDistal)]);
}

}  // namespace phalanx
