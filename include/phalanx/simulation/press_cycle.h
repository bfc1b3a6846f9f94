// SPDX-License-Identifier: Apache-2.0
// A patient who presses, lets go and presses again, for as long as a station runs.
#pragma once

#include <cstdint>

#include "phalanx/simulation/press_intent.h"

namespace phalanx {

/// PressIntent repeated, one squeeze after another. At the end of a squeeze each digit is back where it
/// began. In the last 0.25 s the tremor is blended to the start of the next squeeze, so that the intent does
/// not jump. Real-time except for the constructor.
class PressCycle {
 public:
  /// Makes the cycle, with the parameters of PressIntent; plan and patient must outlive it. `schedule.end` is
  /// the length of a squeeze [s].
  /// @throws std::invalid_argument naming the joint if one is not back at its start 0.25 s before that.
  PressCycle(const PressPlan& plan, const PatientParameters& patient, const HandParameters& hand, double wall,
             double press, std::uint64_t seed, const TrialSchedule& schedule);
  [[nodiscard]] JointArray angle(double t) const noexcept;  ///< [rad]
  [[nodiscard]] JointArray push(double t) const noexcept;   ///< [Nm]

 private:
  [[nodiscard]] double within(double t) const noexcept;  ///< time since the present squeeze began [s]

  PressIntent intent_;
  double length_;
  JointArray gap_{};  ///< from the start of the next squeeze to the end of this one [rad]
};

}  // namespace phalanx
