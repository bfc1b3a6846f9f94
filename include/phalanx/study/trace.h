// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "phalanx/step/snapshot.h"

namespace phalanx {

/// What a plot needs of every tick.
struct TraceTick {
  double time_s = 0.0;
  std::array<double, kSegments> force_raw{};  ///< [N]
  std::array<double, kSegments> force{};      ///< [N]
  JointArray torque{};                        ///< [Nm]
  JointArray hcp_angle{};                     ///< [rad]
  JointArray gdp_angle{};                     ///< [rad]
};

/// A run's curves, in the order of its ticks. Grows by 0.8 kB a tick; not real-time.
using Trace = std::vector<TraceTick>;

[[nodiscard]] TraceTick trace_tick(const Snapshot& snapshot);

}  // namespace phalanx
