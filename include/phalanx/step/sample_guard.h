// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "phalanx/core/status.h"
#include "phalanx/force/force_parameters.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// Turns whatever the device says into angles that a hand can have: finite, inside the range of motion, and
/// not faster than a hand moves.
class SampleGuard {
 public:
  /// @param open  angles held until a first good sample [rad]
  explicit SampleGuard(const JointArray& open) noexcept : angle_(open) {}

  /// A NaN or infinite angle keeps its last good value; an angle out of range is clamped; one that moved
  /// faster than limits.joint_speed is slewed at that speed; a sample whose time is not later than the last
  /// one's keeps all angles. The first sample is not slewed.
  /// @param period  nominal period of a step [s]
  /// @returns what had to be done
  /// Real-time: O(1), no allocation, lock, throw or I/O.
  Status accept(const Sample& sample, const HandParameters& hand, const LimitParameters& limits,
                double period) noexcept;

  /// The accepted angles [rad].
  [[nodiscard]] const JointArray& angle() const noexcept { return angle_; }

 private:
  JointArray angle_;
  std::array<bool, kJoints> seen_{};  ///< the joint has had a good sample
  double time_s_ = 0.0;
  bool started_ = false;
};

}  // namespace phalanx
