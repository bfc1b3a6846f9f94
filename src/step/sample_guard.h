// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "phalanx/core/status.h"
#include "phalanx/force/force_parameters.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// Filter of measured samples that gives feasible joint angles: finite, inside the range of motion, and not
/// faster than a hand moves. The device may send any values.
class SampleGuard {
 public:
  /// @param open  angles until the first good sample [rad]
  explicit SampleGuard(const JointArray& open) noexcept : angle_(open) {}

  /// Takes the angles of one sample. The following rules hold for each angle:
  /// - A NaN or infinite angle keeps its last good value.
  /// - An angle out of range is clamped.
  /// - If an angle moved faster than limits.joint_speed since the last used sample, it is slewed at that
  ///   speed. The first sample is not slewed.
  /// If the sample's time is not later than the last one's, all angles stay. After 5 such samples in a row,
  /// whose times increase among themselves, the device's clock has restarted. From then on its samples are
  /// used again, slewed.
  /// @param period  nominal period of a step [s]
  /// @returns the status bits of the rules that applied
  /// Real-time: O(1), no allocation, lock, throw or I/O.
  Status accept(const Sample& sample, const HandParameters& hand, const LimitParameters& limits,
                double period) noexcept;

  /// @returns true if no wholly good sample has come for 50 ms. The angles then no longer describe the hand,
  /// and forces must decay.
  [[nodiscard]] bool stale() const noexcept { return bad_for_ > kStaleAfter; }

  /// Returns for each digit whether all its joints have had a good sample.
  [[nodiscard]] std::array<bool, kDigits> measured() const noexcept;

  /// Returns the time of the last used sample [s].
  [[nodiscard]] double time_s() const noexcept { return time_s_; }

  /// Returns the accepted angles [rad].
  [[nodiscard]] const JointArray& angle() const noexcept { return angle_; }

 private:
  JointArray angle_;
  std::array<bool, kJoints> seen_{};  ///< the joint has had a good sample
  static constexpr double kStaleAfter = 0.05;
  static constexpr int kRestartedAfter = 5;

  [[nodiscard]] bool takes_time(double time_s) noexcept;

  double time_s_ = 0.0;
  double refused_time_s_ = 0.0;
  int refused_ = 0;       ///< refused samples in a row whose times increased among themselves
  double bad_for_ = 0.0;  ///< nominal time since the last wholly good sample [s]
  bool started_ = false;
};

/// Copies the optional channels and the angles' origins of a sample to the snapshot. A channel becomes NaN if
/// the sample has none, if its value is not finite, or if the sample's time was refused (kTimeNotIncreasing).
/// Real-time: O(1), no allocation, lock, throw or I/O.
void pass_measured(const Sample& sample, Status accepted, Snapshot& snapshot) noexcept;

}  // namespace phalanx
