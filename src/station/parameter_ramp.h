// SPDX-License-Identifier: Apache-2.0
// Parameters that change while a finger presses, without a jump of the force.
#pragma once

#include "phalanx/force/haptic_parameters.h"

namespace phalanx {

/// @returns true if the method can change from one to the other in contact: both are the same, or each is
/// kNone, kSmoothing or kRiseOnly
[[nodiscard]] bool goes_over_in_contact(Stabiliser from, Stabiliser to) noexcept;

/// Ramp of the parameters of each step. Stiffness, damping, the bounds on the force's change and the methods
/// of goes_over_in_contact() change to others in kSeconds; all others are constant. Real-time: O(1), no
/// allocation, lock, throw or I/O.
class ParameterRamp {
 public:
  static constexpr double kSeconds = 0.2;    ///< [s]
  static constexpr double kUnbounded = 1e4;  ///< a bound that never acts [N/s]

  explicit ParameterRamp(const HapticParameters& parameters) noexcept : now_(parameters) {}

  /// Begins a change to `target` from the parameters in force. Stiffness and damping change linearly, bounds
  /// in equal ratios (a hand feels the ratio of a bound). If the method changes, a bound that only one of the
  /// methods has begins or ends at kUnbounded; meanwhile the method has the bounds of both. At the end
  /// these are exactly the target's. All other parameters stay as they are, and so does the method if
  /// goes_over_in_contact() does not allow the change.
  void go_to(const HapticParameters& target) noexcept;

  /// Advances by one period.
  void advance() noexcept;

  /// @returns the parameters of this step.
  [[nodiscard]] const HapticParameters& parameters() const noexcept { return now_; }
  [[nodiscard]] bool moving() const noexcept { return left_ > 0.0; }

 private:
  HapticParameters now_;
  HapticParameters from_;     ///< in force when the change began; missing bounds are unbounded
  StabiliserParameters way_;  ///< method during the change, and its final bounds
  HapticParameters to_;
  double left_ = 0.0;  ///< time left of the change [s]
};

}  // namespace phalanx
