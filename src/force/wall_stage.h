// SPDX-License-Identifier: Apache-2.0
// Conversion of one digit's contacts into walls for the device's controller.
#pragma once

#include "phalanx/force/force_stage.h"

namespace phalanx {

/// Fills the digit's walls from the forces that digit_forces() has just computed. A contact that has let go
/// stays a wall of force 0 while the finger is within 10 mm above and 3 mm beside it. It stays for 0.25 s at
/// most. Real-time: O(1), no allocation.
void make_walls(const HapticParameters& parameters, const GdpState& contacts, const HandPoses& hcp, int digit,
                bool stale, ForceState& state) noexcept;

/// @returns true if a contact of the digit that has let go is still kept. Real-time.
[[nodiscard]] bool remembers_walls(int digit, const ForceState& state) noexcept;

/// Removes the digit's walls of this tick, but keeps the remembered ones. Real-time.
void withhold_walls(int digit, ForceState& state) noexcept;

/// Removes the digit's walls and the remembered ones. Real-time.
void clear_walls(int digit, ForceState& state) noexcept;

}  // namespace phalanx
