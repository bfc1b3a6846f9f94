// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "phalanx/step/snapshot.h"

namespace phalanx {

/// Values of one tick that a plot needs.
struct TraceTick {
  double time_s = 0.0;
  std::array<double, kSegments> force_raw{};  ///< of the force law, on each segment [N]
  std::array<double, kSegments> force{};      ///< sent, on each segment [N]
  JointArray torque{};                        ///< [Nm]
  JointArray hcp_angle{};                     ///< [rad]
  JointArray gdp_angle{};                     ///< [rad]
};

/// Curves of a run, in the order of its ticks. They grow by 0.8 kB a tick. Not real-time.
using Trace = std::vector<TraceTick>;

/// Copies from a snapshot what a plot needs.
[[nodiscard]] TraceTick trace_tick(const Snapshot& snapshot);

}  // namespace phalanx
