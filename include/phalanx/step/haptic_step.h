// SPDX-License-Identifier: Apache-2.0
// One constant model, its parameters, one preallocated state, one step().
#pragma once

#include <utility>

#include "phalanx/contact/gdp.h"
#include "phalanx/contact/object_model.h"
#include "phalanx/force/force_stage.h"
#include "phalanx/force/haptic_parameters.h"
#include "phalanx/hand/hand_model.h"
#include "phalanx/step/sample_guard.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// The geometry that a step works on: the hand, what it meets, and the search trees of the hand. Constant,
/// and shared by all who step it: it can be moved, but not copied.
struct HapticModel {
  /// Makes the trees. Set-up only.
  HapticModel(HandModel hand_model, ObjectModel object_model)
      : hand(std::move(hand_model)), object(std::move(object_model)), trees(make_segment_trees(hand)) {}

  HapticModel(HapticModel&&) noexcept = default;
  HapticModel& operator=(HapticModel&&) noexcept = default;
  HapticModel(const HapticModel&) = delete;
  HapticModel& operator=(const HapticModel&) = delete;
  ~HapticModel() = default;

  HandModel hand;
  ObjectModel object;
  SegmentTrees trees;
};

/// What a step remembers for the next one. Sized at construction; step() allocates nothing.
class HapticState {
 public:
  /// The open hand, no contact, zero torque.
  /// @throws std::invalid_argument if the open hand or the palm touches the object, or a parameter is out of
  /// range.
  HapticState(const HapticModel& model, const HapticParameters& parameters);

  /// The result of the last step.
  [[nodiscard]] const Snapshot& snapshot() const noexcept { return snapshot_; }

 private:
  friend Status step(const HapticModel&, const HapticParameters&, const Sample&, HapticState&) noexcept;

  SampleGuard guard_;
  HandPoses hcp_;
  GdpState gdp_;
  ForceState force_;
  Snapshot snapshot_;
};

/// device sample -> hand -> contact -> force -> device command: one tick of the whole hand.      S1 fig. 2
/// Whatever `sample` holds, the torques in `state.snapshot()` are finite and within the limits; the status
/// says what happened. Same model, parameters and samples, same bits.
/// @param parameters  in the ranges that HapticState's constructor checks. They may differ from the last
/// step's, but for rate_hz; what that does to the force in contact is for the caller to judge
/// Real-time: no allocation, lock, throw or I/O.
Status step(const HapticModel& model, const HapticParameters& parameters, const Sample& sample,
            HapticState& state) noexcept;

}  // namespace phalanx
