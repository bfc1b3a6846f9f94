// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "phalanx/station/station_view.h"
#include "phalanx/tick.pb.h"

namespace phalanx {

/// Replaces the poses of the GDP by those of the hand that is drawn (DisplayedHand), and moves the points of contacts and
/// forces along with their segments. Directions and sizes stay. Where no object keeps a digit from where it is
/// measured, its measured poses are replaced, too: the measured hand is drawn only where an object is in its way.
void draw_at(const std::array<Pose, kSegments>& displayed, Snapshot& snapshot) noexcept;

/// Writes one step in the form of proto/phalanx/tick.proto. `out` is cleared first.
void write_tick(const StationView& view, wire::Tick& out);

/// @returns the state in the numbers of tick.proto
[[nodiscard]] wire::SafetyState wire_state(SafetyState state) noexcept;

}  // namespace phalanx
