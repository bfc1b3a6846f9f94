// SPDX-License-Identifier: Apache-2.0
// One constant model, one preallocated state, one step().
#pragma once

#include <utility>

#include "phalanx/contact/contact_parameters.h"
#include "phalanx/contact/gdp.h"
#include "phalanx/contact/object_model.h"
#include "phalanx/force/force_parameters.h"
#include "phalanx/force/force_stage.h"
#include "phalanx/hand/hand_model.h"
#include "phalanx/step/sample_guard.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// Everything that does not change from tick to tick.
struct HapticModel {
  /// Default parameters; set what differs.
  HapticModel(HandModel hand_model, ObjectModel object_model)
      : hand(std::move(hand_model)), object(std::move(object_model)), trees(make_segment_trees(hand)) {}

  HandModel hand;
  ObjectModel object;
  SegmentTrees trees;
  ContactParameters contact;
  ForceLawParameters force;
  SmoothingParameters smoothing;
  StabiliserParameters stabiliser;  ///< the default is S2's smoothing, with the bounds of `smoothing`
  OscillationParameters oscillation;
  LimitParameters limits;
  double rate_hz = 200.0;  ///< nominal rate of step() [Hz]
};

/// Everything that does. Sized at construction; step() allocates nothing.
class HapticState {
 public:
  /// The open hand, no contact, zero torque.
  /// @throws std::invalid_argument if the open hand or the palm touches the object, or a parameter is out of
  /// range.
  explicit HapticState(const HapticModel& model);

  /// The result of the last step.
  [[nodiscard]] const Snapshot& snapshot() const noexcept { return snapshot_; }

 private:
  friend Status step(const HapticModel&, const Sample&, HapticState&) noexcept;

  SampleGuard guard_;
  HandPoses hcp_;
  GdpState gdp_;
  ForceState force_;
  Snapshot snapshot_;
};

/// device sample -> hand -> contact -> force -> device command: one tick of the whole hand.      S1 fig. 2
/// Whatever `sample` holds, the torques in `state.snapshot()` are finite and within the limits; the status
/// says what happened. Same model and samples, same bits. Real-time: no allocation, lock, throw or I/O.
Status step(const HapticModel& model, const Sample& sample, HapticState& state) noexcept;

}  // namespace phalanx
