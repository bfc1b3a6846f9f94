// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/station/station_view.h"
#include "phalanx/tick.pb.h"

namespace phalanx {

/// One step as it is streamed and recorded: proto/phalanx/tick.proto.
void write_tick(const StationView& view, wire::Tick& out);

/// A state as the wire names it.
[[nodiscard]] wire::SafetyState wire_state(SafetyState state) noexcept;

}  // namespace phalanx
