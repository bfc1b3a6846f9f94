// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/station/station_view.h"
#include "phalanx/tick.pb.h"

namespace phalanx {

/// Writes one step in the form of proto/phalanx/tick.proto. `out` is cleared first.
void write_tick(const StationView& view, wire::Tick& out);

/// @returns the state in the numbers of tick.proto
[[nodiscard]] wire::SafetyState wire_state(SafetyState state) noexcept;

}  // namespace phalanx
