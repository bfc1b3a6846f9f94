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
  /// faster than limits.joint_speed since the last sample that was used is slewed at that speed; a sample
  /// whose time is not later than the last one's keeps all angles. The first sample is not slewed.
  /// @param period  nominal period of a step [s]
  /// After 5 refused samples in a row whose times increase among themselves the device's clock has restarted:
  /// its samples are used again, slewed.
  /// @returns what had to be done
  /// Real-time: O(1), no allocation, lock, throw or I/O.
  Status accept(const Sample& sample, const HandParameters& hand, const LimitParameters& limits,
                double period) noexcept;

  /// No sample in which everything was good has come for 50 ms: what is held is no longer what the hand does,
  /// and forces must go.
  [[nodiscard]] bool stale() const noexcept { return bad_for_ > kStaleAfter; }

  /// For each digit, whether all its joints have had a good sample.
  [[nodiscard]] std::array<bool, kDigits> measured() const noexcept;

  /// Time of the last sample that was used [s].
  [[nodiscard]] double time_s() const noexcept { return time_s_; }

  /// The accepted angles [rad].
  [[nodiscard]] const JointArray& angle() const noexcept { return angle_; }

 private:
  JointArray angle_;
  std::array<bool, kJoints> seen_{};  ///< the joint has had a good sample
  static constexpr double kStaleAfter = 0.05;
  static constexpr int kRestartedAfter = 5;

  [[nodiscard]] bool takes_time(double time_s) noexcept;

  double time_s_ = 0.0;
  double refused_time_s_ = 0.0;
  int refused_ = 0;       ///< samples refused in a row whose times increased among themselves
  double bad_for_ = 0.0;  ///< nominal time since the last sample in which everything was good [s]
  bool started_ = false;
};

/// The optional channels of a sample, into the snapshot: finite, or NaN where the sample has none, or none
/// that is finite, or its time was refused (kTimeNotIncreasing). Real-time: O(1), no allocation, lock, throw
/// or I/O.
void pass_measured(const Sample& sample, Status accepted, Snapshot& snapshot) noexcept;

}  // namespace phalanx
