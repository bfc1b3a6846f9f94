// SPDX-License-Identifier: Apache-2.0
// One constant model, its parameters, one preallocated state, one step().
#pragma once

#include <memory>

#include "phalanx/contact/object_model.h"
#include "phalanx/core/status.h"
#include "phalanx/force/haptic_parameters.h"
#include "phalanx/hand/hand_model.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

struct SegmentTrees;

/// Geometry that a step works on: the hand, the objects, and the search trees of both. Constant. Many states
/// can share one model. It can be moved, not copied; a moved-from object may only be assigned to or destroyed.
struct HapticModel {
  /// Makes the trees of the hand. Set-up only.
  HapticModel(HandModel hand_model, ObjectModel object_model);

  HapticModel(HapticModel&&) noexcept;
  HapticModel& operator=(HapticModel&&) noexcept;
  HapticModel(const HapticModel&) = delete;
  HapticModel& operator=(const HapticModel&) = delete;
  ~HapticModel();

  HandModel hand;
  ObjectModel object;

  /// Returns the search trees of the hand, for the contact search. Real-time.
  [[nodiscard]] const SegmentTrees& trees() const noexcept { return *trees_; }

 private:
  std::unique_ptr<const SegmentTrees> trees_;
};

/// State that one step leaves for the next. All its memory is allocated at construction. It can be moved, not
/// copied; a moved-from object may only be assigned to or destroyed.
class HapticState {
 public:
  /// Starts at the open hand, without contact, at zero torque. Set-up only.
  /// @throws std::invalid_argument if the open hand or the palm touches the object, or a parameter is out of
  /// range.
  HapticState(const HapticModel& model, const HapticParameters& parameters);
  HapticState(HapticState&&) noexcept;
  HapticState& operator=(HapticState&&) noexcept;
  HapticState(const HapticState&) = delete;
  HapticState& operator=(const HapticState&) = delete;
  ~HapticState();

  /// Returns the result of the last step.
  [[nodiscard]] const Snapshot& snapshot() const noexcept { return snapshot_; }

  /// Lets the next steps open a digit that started inside the object: OpeningState. For the caller who has shown
  /// a person which digit it is, its way and where to, and got a confirmation.
  /// @returns false, with no effect, unless the digit has no force for this reason and has a contact. Real-time.
  bool confirm_opening(int digit) noexcept;
  /// Takes all confirmations back: the digits have no force from the next step on. Real-time.
  void withdraw_openings() noexcept;

 private:
  friend Status step(const HapticModel& model, const HapticParameters& parameters, const Sample& sample,
                     HapticState& state) noexcept;

  struct Stages;  ///< states of the sample guard, the contact search and the force stage
  std::unique_ptr<Stages> stages_;
  Snapshot snapshot_;
};

/// device sample -> hand -> contact -> force -> device command: one tick of the whole hand.      S1 fig. 2
/// Whatever `sample` holds, the torques in `state.snapshot()` are finite and within the limits; the status
/// says what happened. Same model, parameters and samples, same bits.
/// @pre `state` was made with this `model`: it holds numbers of its triangles. Another model needs a new state
/// @param parameters  in the ranges that HapticState's constructor checks. They may differ from the last
/// step's, but for rate_hz; what that does to the force in contact is for the caller to judge
/// Real-time: no allocation, lock, throw or I/O.
Status step(const HapticModel& model, const HapticParameters& parameters, const Sample& sample,
            HapticState& state) noexcept;

}  // namespace phalanx
