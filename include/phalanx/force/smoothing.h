// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "phalanx/force/force_parameters.h"

namespace phalanx {

/// S2 eq. (3)-(4), on the magnitude of one contact's force:  F_sent = F' + clamp(F - F', dF_min, dF_max).
/// @param target    F, the force of this step [N] >= 0
/// @param previous  F', the force sent at the last step [N] >= 0
/// @param period    of one step [s]; the bounds are rates, dF = rate x period
/// @returns [N] >= 0 and finite for finite arguments; with min_rate = -infinity only the rise is limited
/// Real-time: O(1).
[[nodiscard]] inline double smoothed_force(const SmoothingParameters& smoothing, double target,
                                           double previous, double period) noexcept {
  if (!smoothing.enabled) return target;
  return previous + std::clamp(target - previous, smoothing.min_rate * period, smoothing.max_rate * period);
}

}  // namespace phalanx
