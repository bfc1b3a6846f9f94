// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/cockpit.pb.h"
#include "phalanx/station/session.h"
#include "phalanx/tick.pb.h"

namespace phalanx {

/// Writes one step in the form of proto/phalanx/tick.proto. `out` is cleared first.
void write_tick(const StationView& view, wire::Tick& out);

/// @returns the sum of the magnitudes on each digit, as asked of the motors [N]
[[nodiscard]] DigitArray digit_forces(const wire::Tick& tick) noexcept;

/// Writes the statistics of the loop's deadlines in the form of proto/phalanx/cockpit.proto.
void write_loop(const DeadlineStatistics& deadlines, wire::Loop& out);

[[nodiscard]] wire::HandSource wire_source(HandSource source) noexcept;

/// @returns the state in the numbers of tick.proto
[[nodiscard]] wire::SafetyState wire_state(SafetyState state) noexcept;

}  // namespace phalanx
