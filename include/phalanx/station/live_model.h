// SPDX-License-Identifier: Apache-2.0
// A model that changes while the loop runs: without a jump of the force where that is possible, at zero
// torque where it is not.
#pragma once

#include <memory>
#include <string>

#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// Whether a scene's key may change in contact: the stiffness and what else only scales forces, and the
/// bounds of the smoothing. Everything else needs zero torque, or a new station: change_kind() in assemble.h.
[[nodiscard]] bool changes_in_contact(const std::string& key);

/// The numbers of those keys.
struct BlendedParameters {
  double stiffness = 0.0;  ///< [N/m]
  double damping = 0.0;    ///< [N s/m]
  bool smoothing = true;
  double min_rate = 0.0;  ///< [N/s] < 0, -infinity: rise-only
  double max_rate = 0.0;  ///< [N/s]
};
[[nodiscard]] BlendedParameters blended_of(const HapticModel& model) noexcept;

/// A model, its state, and a change on its way. Owned by the loop's thread.
class LiveModel {
 public:
  static constexpr double kBlend = 0.2;  ///< [s]

  /// Makes the state. @throws as HapticState. Set-up only.
  explicit LiveModel(std::unique_ptr<HapticModel> model);

  /// One step, after any change on its way went on by one period. Real-time.
  Status advance(const Sample& sample) noexcept;

  /// From here the parameters go to `target` over kBlend: stiffness and damping in a straight line, bounds in
  /// equal ratios (the effect of a bound is felt in ratios); smoothing comes and goes as a bound that begins
  /// or ends at kUnbounded. A new target starts from where the last change has come to. Real-time.
  void blend_to(const BlendedParameters& target) noexcept;
  [[nodiscard]] bool blending() const noexcept { return left_ > 0.0; }

  /// Takes the other's model and state, and gives it one's own: real-time, nothing is made or freed.
  void swap(LiveModel& other) noexcept;

  [[nodiscard]] const HapticModel& model() const noexcept { return *model_; }
  [[nodiscard]] const Snapshot& snapshot() const noexcept { return state_->snapshot(); }

  static constexpr double kUnbounded = 1e4;  ///< so fast a bound never acts [N/s]

 private:
  void apply(double part) noexcept;

  std::unique_ptr<HapticModel> model_;
  std::unique_ptr<HapticState> state_;
  BlendedParameters from_;
  BlendedParameters to_;
  double left_ = 0.0;  ///< of the change on its way [s]
};

}  // namespace phalanx
