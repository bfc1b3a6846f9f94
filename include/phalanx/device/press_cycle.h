// SPDX-License-Identifier: Apache-2.0
// A patient who presses, lets go and presses again, for as long as a station runs.
#pragma once

#include <cstdint>

#include "phalanx/device/press_intent.h"

namespace phalanx {

/// PressIntent over and over, one squeeze after another; at the end of a squeeze each digit is back where it
/// began. In the last quarter of a second the tremor is led to where the next squeeze begins it, so that the
/// intent does not jump. Real-time but for the constructor.
class PressCycle {
 public:
  /// As PressIntent; plan and patient must outlive it. `schedule.end` is the length of a squeeze [s].
  /// @throws std::invalid_argument naming the joint if one is not back at its start 0.25 s before that.
  PressCycle(const PressPlan& plan, const PatientParameters& patient, const HandParameters& hand, double wall,
             double press, std::uint64_t seed, const TrialSchedule& schedule);
  [[nodiscard]] JointArray angle(double t) const noexcept;  ///< [rad]
  [[nodiscard]] JointArray push(double t) const noexcept;   ///< [Nm]

 private:
  [[nodiscard]] double within(double t) const noexcept;  ///< time since its squeeze began [s]

  PressIntent intent_;
  double length_;
  JointArray gap_{};  ///< between the end of a squeeze and the beginning of the next [rad]
};

}  // namespace phalanx
