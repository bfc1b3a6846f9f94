// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/trace.h"

namespace phalanx {

TraceTick trace_tick(const Snapshot& snapshot) {
  TraceTick tick{.time_s = snapshot.time_s,
                 .torque = snapshot.torque,
                 .hcp_angle = snapshot.hcp_angle,
                 .gdp_angle = snapshot.gdp_angle};
  for (std::size_t s = 0; s < snapshot.segment.size(); ++s) {
    tick.force_raw[s] = snapshot.segment[s].force_raw;
    tick.force[s] = snapshot.segment[s].force;
  }
  return tick;
}

}  // namespace phalanx
