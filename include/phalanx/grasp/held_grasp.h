// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "phalanx/grasp/plan_grasp.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// Grasp of a hand that holds an object, at one tick.
struct HeldGrasp {
  std::vector<PlannedContact> contact;  ///< of the segments that press, and of the palm if it is near
  /// As PlannedGrasp::wrench_ball, of these contacts; 0: they have no force closure [-].
  double closure_margin = 0.0;
};

/// Returns the grasp of a snapshot, with one contact point a segment. The palm, which has no contact of its own, counts
/// if it is as near as a planned grasp needs it.
/// @param snapshot  of the model, static or sliding. Set-up only.
[[nodiscard]] HeldGrasp held_grasp(const HapticModel& model, const HapticParameters& parameters,
                                   const Snapshot& snapshot);

}  // namespace phalanx
