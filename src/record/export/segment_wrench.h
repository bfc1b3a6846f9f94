// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "phalanx/core/math.h"
#include "phalanx/hand/joints.h"
#include "phalanx/tick.pb.h"

namespace phalanx {

/// Force and moment on a segment.
struct SegmentWrench {
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 moment = Vec3::Zero();  ///< about the segment's origin [Nm]
};

using SegmentPoses = std::array<Pose, kSegments>;
using SegmentWrenches = std::array<SegmentWrench, kSegments>;

/// @returns X_WS of each shown segment; none if the step has no poses
[[nodiscard]] std::optional<SegmentPoses> shown_poses(const wire::Tick& tick);

/// @returns the force that was asked of the motors for each segment, which acts at the contact's point, in the world frame
[[nodiscard]] SegmentWrenches segment_wrenches(const wire::Tick& tick, const SegmentPoses& X_WS);

}  // namespace phalanx
