// SPDX-License-Identifier: Apache-2.0
// The pad of a digit: the palmar side of its distal segment.
#pragma once

#include "phalanx/core/math.h"
#include "phalanx/hand/hand_model.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// Returns the middle of a digit's pad in the frame S of its distal segment (WebXR: -Z along the bone, +Y out
/// of the back):
///   p_S = (0, -(r_base + r_tip) / 2, -length / 2)
/// with the tapered capsule of HandParameters::segments. It lies on the capsule's palmar line, half way
/// along the bone. It is the same for a right and a left hand. [m] Real-time: O(1), no allocation, lock,
/// throw or I/O.
[[nodiscard]] Vec3 pad_in_segment(const HandParameters& hand, int digit) noexcept;

/// Returns the middle of a digit's pad in the world [m].
/// @param X_WS  pose of the digit's distal segment, segment_index(digit, 2)
/// Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] Vec3 pad_in_world(const HandParameters& hand, int digit, const Pose& X_WS) noexcept;

/// Returns the middle of a digit's pad in the world at the digit's joint angles [rad], by forward kinematics.
/// [m] Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] Vec3 pad_at(const HandModel& hand, int digit, const DigitAngles& angle) noexcept;

}  // namespace phalanx
